"""The C interface (burnish.h) by ctypes. ctypes releases the interpreter's lock during calls."""

import array
import contextlib
import ctypes
import ctypes.util
import functools
import os
import pathlib
import signal
import sys
import textwrap
import threading

from . import _dlpack, _show

API_VERSION = 3
USAGE, STOPPED = 2, 130  # exit codes of the program
POLL = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)
PROGRESS = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_char_p, ctypes.c_double)

CALLS = {1: "load()", 2: "meshes()", 4: "set_environment()", 8: "render()", 16: "reference()"}  # bits of burnish_option_calls
MACHINES = {3: "x86", 40: "Arm", 62: "x86-64", 183: "AArch64", 243: "RISC-V"}  # e_machine of ELF files

_loaded = None


class Error(Exception):
    """A failure. `code`: exit code of the program burnish for it."""

    def __init__(self, code, text):
        super().__init__(text)
        self.code = code

    def __reduce__(self):
        return Error, (self.code, str(self))


class MeshStruct(ctypes.Structure):
    _fields_ = [("size", ctypes.c_size_t), ("positions", ctypes.POINTER(ctypes.c_float)), ("normals", ctypes.POINTER(ctypes.c_float)),
                ("coordinates", ctypes.POINTER(ctypes.c_float)), ("triangles", ctypes.POINTER(ctypes.c_uint32)),
                ("vertex_count", ctypes.c_size_t), ("triangle_count", ctypes.c_size_t), ("transform", ctypes.POINTER(ctypes.c_float)),
                ("material", ctypes.c_void_p)]


class ComparisonStruct(ctypes.Structure):
    _fields_ = [("size", ctypes.c_size_t), *((name, ctypes.c_double) for name in
                ("flip_mean", "flip_p99", "flip_max", "mse", "rel_mse", "max_abs", "differing_fraction"))]


def _candidates():
    """Where the library may be: BURNISH_LIBRARY, beside this package, else where the system finds it."""
    if "BURNISH_LIBRARY" in os.environ:
        return [os.environ["BURNISH_LIBRARY"]]
    beside = sorted(str(p) for p in pathlib.Path(__file__).resolve().parent.glob("libburnish.so*"))
    found = ctypes.util.find_library("burnish")
    return beside + ([found] if found else [])


def _machine_of(name):
    """Returns (word size, machine) of an ELF file, or None. Raises OSError where it cannot be read."""
    with open(name, "rb") as file:
        head = file.read(20)
    return (head[4], int.from_bytes(head[18:20], "big" if head[5] == 2 else "little")) if len(head) == 20 and head[:4] == b"\x7fELF" else None


def _fault_of(name, reason):
    """Returns why a library cannot be loaded, in one line. reason: the loader's words."""
    if not os.path.exists(name):
        return f"libburnish.so is not found; BURNISH_LIBRARY may name it; {reason}"
    try:
        machine, own = _machine_of(name), _machine_of(sys.executable)
    except OSError as error:
        return f"libburnish.so cannot be loaded; {error}"
    if machine is None and own:
        return f"libburnish.so cannot be loaded; {name}: is no shared library"
    if own and machine != own:
        its, ours = (MACHINES.get(number, f"number {number}") for _, number in (machine, own))
        return f"libburnish.so cannot be loaded; {name}: is for another machine, {its} in place of {ours}"
    return f"libburnish.so cannot be loaded; {reason}"


def _opened():
    """Returns the first library that loads. Raises ImportError."""
    faults = []
    for name in _candidates():
        try:
            lib = ctypes.CDLL(name)
            lib.burnish_api_version
            return lib
        except OSError as error:
            faults.append(_fault_of(name, str(error)))
        except AttributeError:
            faults.append(f"libburnish.so cannot be loaded; {name}: is another library")
    raise ImportError(faults[0] if faults else "libburnish.so is not found; BURNISH_LIBRARY may name it") from None


def library():
    """The loaded library. Raises ImportError where it is not found or has another interface."""
    global _loaded
    if _loaded:
        return _loaded
    lib = _opened()
    if lib.burnish_api_version() < API_VERSION:
        raise ImportError(f"libburnish.so has version {lib.burnish_api_version()} of its interface, {API_VERSION} is needed")
    text, pointer, whole, size = ctypes.c_char_p, ctypes.c_void_p, ctypes.c_int, ctypes.c_size_t
    for name, result, arguments in (
            ("burnish_version", text, []), ("burnish_error", text, []), ("burnish_option_name", text, [whole]),
            ("burnish_option_help", text, [whole]), ("burnish_option_values", text, [whole]), ("burnish_option_default", text, [whole]),
            ("burnish_option_calls", ctypes.c_uint, [whole]), ("burnish_material_name", text, [whole]), ("burnish_technique_name", text, [whole]),
            ("burnish_light_name", text, [whole]), ("burnish_technique_help", text, [whole]), ("burnish_options_make", whole, [pointer]),
            ("burnish_options_set", whole, [pointer, text, text]), ("burnish_options_free", None, [pointer]),
            ("burnish_options_progress", whole, [pointer, PROGRESS, pointer]),
            ("burnish_options_environment", whole, [pointer, pointer, whole, whole]),
            ("burnish_find_node", whole, [pointer, text]), ("burnish_find_material", whole, [pointer, text]), ("burnish_find_light", whole, [pointer, text]),
            ("burnish_scene_node", text, [pointer, whole]), ("burnish_scene_material", text, [pointer, whole]),
            ("burnish_scene_light", text, [pointer, whole]), ("burnish_scene_variant", text, [pointer, whole]), ("burnish_warning", text, [pointer, whole]),
            ("burnish_set_node", whole, [pointer, whole, ctypes.POINTER(ctypes.c_float)]),
            ("burnish_set_material", whole, [pointer, whole, pointer]), ("burnish_set_light", whole, [pointer, whole, pointer]),
            ("burnish_set_primitive_material", whole, [pointer, whole, whole]),
            ("burnish_set_environment", whole, [pointer, text, pointer]),
            ("burnish_open", whole, [text, text, pointer, pointer]),
            ("burnish_open_meshes", whole, [ctypes.POINTER(MeshStruct), size, text, pointer, pointer]), ("burnish_close", None, [pointer]),
            ("burnish_render", whole, [pointer, pointer, pointer]), ("burnish_reference", whole, [pointer, pointer, POLL, pointer, pointer]),
            ("burnish_frame_width", whole, [pointer]), ("burnish_frame_height", whole, [pointer]), ("burnish_frame_pixels", pointer, [pointer]),
            ("burnish_frame_variance", pointer, [pointer]), ("burnish_frame_layer", pointer, [pointer, text, pointer]),
            ("burnish_frame_hash", ctypes.c_uint64, [pointer]), ("burnish_frame_tonemap", whole, [pointer, text]),
            ("burnish_frame_png_told", whole, [pointer, ctypes.c_float, pointer, pointer, pointer]),
            ("burnish_write_told", whole, [pointer, text, ctypes.c_float, pointer]), ("burnish_frame_free", None, [pointer]),
            ("burnish_compare_told", whole, [pointer, pointer, whole, whole, pointer, ctypes.POINTER(ComparisonStruct)])):
        try:
            function = getattr(lib, name)
        except AttributeError:
            raise ImportError(f"libburnish.so has no {name}: it is older than this package") from None
        function.restype, function.argtypes = result, arguments
    _loaded = lib
    return lib


def check(code):
    if code != 0:
        raise Error(code, library().burnish_error().decode("utf-8", "replace"))


def call(name, *arguments):
    check(getattr(library(), name)(*arguments))


def texts(name, *arguments):
    """Returns the texts of a list function, which takes an index last."""
    found = []
    while (text := getattr(library(), name)(*arguments, len(found))) is not None:
        found.append(text.decode("utf-8", "replace"))
    return found


def listed(names, helps):
    """{name: help} of two list functions."""
    found, index = {}, 0
    while (name := getattr(library(), names)(index)) is not None:
        found[name.decode()] = getattr(library(), helps)(index).decode()
        index += 1
    return found


@functools.lru_cache(None)
def calls():
    """Returns {name: [call, ...]} of all options and of the factors of materials and lights."""
    found = {}
    for index, name in enumerate(listed("burnish_option_name", "burnish_option_help")):
        bits = library().burnish_option_calls(index)
        found[name] = [call for bit, call in CALLS.items() if bits & bit]
    for name in texts("burnish_material_name"):
        found.setdefault(name, []).extend(("Mesh()", "set_material()"))
    for name in texts("burnish_light_name"):
        found.setdefault(name, []).append("set_light()")
    return found


def known():
    """Returns the names of all options and of the factors of materials and lights."""
    return set(calls())


def check_call(name, call):
    """Refuses a keyword that is unknown, or that another call takes."""
    takers = calls().get(name)
    if takers is None:
        raise Error(USAGE, f"{name}: is no option")
    if call not in takers:
        raise Error(USAGE, f"{name}: belongs to {', '.join(takers[:-1])}{' and ' if takers[1:] else ''}{takers[-1]}")


def shown_default(text):
    """Returns a default of the library as Python writes it."""
    if text in ("true", "false"):
        return text.capitalize()
    try:
        float(text.replace(",", "0"))
    except ValueError:
        return f'"{text}"' if text else "None"
    return f"({text.replace(',', ', ')})" if "," in text else text


def keyword_lines(call, indent, **defaults):
    """Returns a docstring's lines: each keyword of a call with its values, default and meaning. defaults: those that the call replaces."""
    lines = []
    for index, (name, meaning) in enumerate(listed("burnish_option_name", "burnish_option_help").items()):
        if call in calls()[name]:
            values, default = (getattr(library(), "burnish_option_" + part)(index).decode() for part in ("values", "default"))
            text = f"{name}: {values}; default {defaults.get(name, shown_default(default))}. {meaning.rstrip('. ')}."
            lines += textwrap.wrap(text, 140, initial_indent=indent, subsequent_indent=indent + "    ", break_on_hyphens=False)
    return "\n".join(lines)


def path(of):
    name = os.fsencode(of)
    if b"\0" in name:
        raise ValueError("a path holds a zero byte")
    return name


def text_of(value):
    """An option's value as the library reads it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return value
    if isinstance(value, (list, tuple)) or hasattr(value, "tolist"):
        items = value.tolist() if hasattr(value, "tolist") else value
        return ",".join(map(text_of, items)) if isinstance(items, (list, tuple)) else text_of(items)
    return repr(float(value)) if isinstance(value, float) else str(value)


class Options:
    """The library's options of a call's keywords, within a `with` block. None and empty lists leave a keyword's default."""

    def __init__(self, keywords, call_name):
        self.handle = ctypes.c_void_p()
        call("burnish_options_make", ctypes.byref(self.handle))
        try:
            for name, value in keywords.items():
                check_call(name, call_name)
                if value is None or (isinstance(value, (list, tuple)) and not value):
                    continue
                if name == "light" and not isinstance(value, str):
                    if not isinstance(value, (list, tuple)) or not all(isinstance(one, str) for one in value):
                        raise ValueError(f"light: {value!r} is neither a text nor a list of texts")
                    value = ";".join(value)
                text = text_of(value)
                if "\0" in name + text:
                    raise ValueError(f"{name}: holds a zero character")
                call("burnish_options_set", self.handle, name.encode(), text.encode())
        except BaseException:
            self.__exit__()
            raise

    def __enter__(self):
        return self.handle

    def __exit__(self, *_):
        handle, self.handle = self.handle, ctypes.c_void_p()  # Ctrl-C between the lines loses some bytes, and frees nothing twice
        if handle:
            library().burnish_options_free(handle)

    def __del__(self):
        self.__exit__()


@contextlib.contextmanager
def _noted_interrupts(raised):
    """Notes Ctrl-C in the list instead of raising: an exception at a callback's first line would be lost. Leaves a script's own handler."""
    mine = threading.current_thread() is threading.main_thread() and signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if mine:
        signal.signal(signal.SIGINT, lambda *_: raised.append(KeyboardInterrupt()))
    try:
        yield
    finally:
        if mine:
            signal.signal(signal.SIGINT, signal.default_int_handler)


class Alone:
    """What one thread at a time uses."""

    def __init__(self):
        self._lock, self._owner = threading.Lock(), None

    @contextlib.contextmanager
    def _alone(self):
        """Keeps other threads out. Refuses a progress function, which would wait for itself."""
        if self._owner == threading.get_ident():
            raise RuntimeError(f"this {type(self).__name__.lower()} is at work: a progress function cannot use it")
        with self._lock:
            self._owner = threading.get_ident()
            try:
                yield
            finally:
                self._owner = None


def call_told(name, given, progress, *arguments, undo=None):
    """Calls a function that reads the options `given`, and progress(work, done) about ten times a second meanwhile. A true result and Ctrl-C
    stop the work. Raises KeyboardInterrupt then, and an exception of progress(); calls undo() before where the function had ended well."""
    raised = []

    def tell(_, work, done):
        try:
            if not raised and progress and progress(work.decode("utf-8", "replace"), done):
                raised.append(KeyboardInterrupt())
        except BaseException as error:  # goes on in the caller
            raised.append(error)
        return len(raised)

    callback = PROGRESS(tell)
    call("burnish_options_progress", given, callback, None)
    with _noted_interrupts(raised):
        code = getattr(library(), name)(*arguments)
    if raised and (code != 0 or undo):  # else the work is done, and nothing can be taken back
        if code == 0:
            undo()
        raise raised[0]
    if code == STOPPED:
        raise KeyboardInterrupt
    check(code)


def environment_of(of, given):
    """Returns the environment's name for the library, or None. An array of height x width x 3 floats goes into the options `given`."""
    if of is None or isinstance(of, (str, bytes, os.PathLike)):
        return None if of is None else path(of)
    pixels, width, height = picture_of(of)
    call("burnish_options_environment", given, pixels, width, height)
    return None


def matrix(of, name):
    """Returns 16 floats column by column: of 16 numbers in that order, or of 4 rows with 4 numbers each."""
    if len(of) == 4:
        rows = [list(flat(row)) for row in of]
        if any(len(row) != 4 for row in rows) or rows[3] != [0, 0, 0, 1]:
            raise ValueError(f"{name}: 4 rows have 4 numbers each, and the fourth row is 0, 0, 0, 1")
        of = [rows[row][column] for column in range(4) for row in range(4)]
    held = floats(of, 16, name)
    if len(held) != 16:
        raise ValueError(f"{name}: {len(held)} numbers are not 16")
    return held


class Values:
    """Floats of a picture, by rows, columns and channels. numpy.asarray(), from_dlpack() of any library and memoryview(values.bytes()) copy
    nothing; the picture lives as long as they do. values[y, x] is a tuple."""

    def __init__(self, owner, address, shape):
        self.owner, self.address, self.shape = owner, address, shape

    @property
    def __array_interface__(self):
        return {"version": 3, "shape": self.shape, "typestr": "<f4", "data": (self.address, True)}

    def __dlpack_device__(self):
        """Returns DLPack's device: (1, 0), the CPU."""
        return _dlpack.CPU, 0

    def __dlpack__(self, *, stream=None, max_version=None, dl_device=None, copy=None):
        """Returns a DLPack capsule without a copy. The floats are for reading. Raises BufferError for a stream, another device or a copy."""
        if stream is not None or copy or (dl_device is not None and tuple(dl_device) != self.__dlpack_device__()):
            raise BufferError("a picture offers its floats on the CPU, without a stream and without a copy")
        return _dlpack.capsule(self, self.address, self.shape, max_version)

    def bytes(self):
        """A read-only memoryview of the floats, flat."""
        count = self.shape[0] * self.shape[1] * self.shape[2]
        held = (ctypes.c_float * count).from_address(self.address)
        held.owner = self.owner  # lives with the view
        return memoryview(held).cast("B").cast("f").toreadonly()

    def _repr_png_(self):
        return _show.layer(self)

    def __getitem__(self, at):
        y, x = at
        if not (0 <= y < self.shape[0] and 0 <= x < self.shape[1]):
            raise IndexError(f"({y}, {x}) lies outside of {self.shape[0]} rows and {self.shape[1]} columns")
        first = (y * self.shape[1] + x) * self.shape[2]
        floats = ctypes.cast(self.address, ctypes.POINTER(ctypes.c_float))
        return tuple(floats[first + c] for c in range(self.shape[2]))


def flat(values):
    for value in values:
        if isinstance(value, (str, bytes)):
            raise TypeError("a text is no number")
        if hasattr(value, "__iter__"):
            yield from flat(value)
        else:
            yield value


def _of_buffer(values, code):
    """Returns an array of a buffer in rows without gaps whose numbers are of the machine's own kinds, else None."""
    try:
        view = memoryview(values)
    except (TypeError, ValueError, BufferError):
        return None
    kinds = "fd" if code == "f" else "BHIL"
    if view.ndim == 0 or view.format not in tuple(kinds) or not view.c_contiguous or view.nbytes == 0:
        return None
    held = array.array(view.format)
    held.frombytes(view.cast("B"))
    return held if view.format == code else array.array(code, held)


def _check_shape(values, each, name):
    """Refuses arrays whose last side is another than a row's length, such as 3 x n in place of n x 3."""
    shape = getattr(values, "shape", None)
    if isinstance(shape, tuple) and len(shape) > 1 and each < 4 and shape[-1] != each:
        raise ValueError(f"{name}: shape {shape} is not (n, {each})")


def _place_of_fault(values, code):
    """Returns "/INDEX" of the first value that is no number of the code, or ""."""
    for index, value in enumerate(flat(values)):
        try:
            array.array(code, [value])
        except (TypeError, OverflowError):
            return f"/{index}"
    return ""


def _gathered(values, code, each, name):
    """Returns an array of the code: nested sequences, or arrays of any kind, strides and byte order. A fault names its place."""
    _check_shape(values, each, name)
    try:
        held = _of_buffer(values, code)
        if held is None:
            values = values.tolist() if hasattr(values, "tolist") else values if hasattr(values, "__len__") else list(values)
            held = array.array(code, flat(values))
    except (TypeError, OverflowError) as error:
        try:
            place = _place_of_fault(values, code)
        except TypeError:  # a text among the numbers, or no sequence at all
            place = ""
        raise TypeError(f"{name}{place}: {error}") from None
    if len(held) == 0 or len(held) % each:
        raise ValueError(f"{name}: {len(held)} numbers are no multiple of {each}")
    return held


def floats(values, each, name):
    held = _gathered(values, "f", each, name)
    return (ctypes.c_float * len(held)).from_buffer(held)


def numbers(values, each, name):
    held = _gathered(values, "I", each, name)
    return (ctypes.c_uint32 * len(held)).from_buffer(held)


def floats_at(address):
    """Returns a pointer to floats, which slices can read. address: from picture_of()."""
    return ctypes.cast(address, ctypes.POINTER(ctypes.c_float))


def picture_of(of):
    """(address or array, width, height) of a Picture, or of an object with height x width x 3 floats."""
    if hasattr(of, "_frame"):
        of = of.pixels
    shape = getattr(of, "shape", None)
    if shape is None or len(shape) != 3 or shape[2] != 3:
        raise ValueError("a picture has height x width x 3 floats")
    if isinstance(of, Values):
        return of.address, shape[1], shape[0]
    held = floats(of, 3, "picture")
    if len(held) != shape[0] * shape[1] * 3:
        raise ValueError(f"a picture of shape {tuple(shape)} has {len(held)} floats")
    return ctypes.cast(held, ctypes.c_void_p), shape[1], shape[0]
