"""DLPack capsules of floats on the CPU, by ctypes (DLPack 1.0: dlpack.h). They copy nothing and need no numpy."""

import ctypes

CPU, FLOAT, READ_ONLY = 1, 2, 1
OLD, NEW = b"dltensor", b"dltensor_versioned"  # a reader renames the capsule, then calls the deleter itself

DELETER = ctypes.CFUNCTYPE(None, ctypes.c_void_p)


class Tensor(ctypes.Structure):
    _fields_ = [("data", ctypes.c_void_p), ("device_type", ctypes.c_int32), ("device_id", ctypes.c_int32), ("ndim", ctypes.c_int32),
                ("code", ctypes.c_uint8), ("bits", ctypes.c_uint8), ("lanes", ctypes.c_uint16), ("shape", ctypes.POINTER(ctypes.c_int64)),
                ("strides", ctypes.POINTER(ctypes.c_int64)), ("byte_offset", ctypes.c_uint64)]


class Managed(ctypes.Structure):
    _fields_ = [("tensor", Tensor), ("context", ctypes.c_void_p), ("deleter", DELETER)]


class Versioned(ctypes.Structure):
    _fields_ = [("major", ctypes.c_uint32), ("minor", ctypes.c_uint32), ("context", ctypes.c_void_p), ("deleter", DELETER),
                ("flags", ctypes.c_uint64), ("tensor", Tensor)]


_held = {}  # address of a managed tensor: all that it points to


@DELETER
def _delete(address, held=_held):
    held.pop(address, None)


def _function(name, result, *arguments):
    return ctypes.PYFUNCTYPE(result, *arguments)((name, ctypes.pythonapi))


_new = _function("PyCapsule_New", ctypes.py_object, ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p)
_valid = _function("PyCapsule_IsValid", ctypes.c_int, ctypes.c_void_p, ctypes.c_char_p)
_pointer = _function("PyCapsule_GetPointer", ctypes.c_void_p, ctypes.c_void_p, ctypes.c_char_p)


@ctypes.PYFUNCTYPE(None, ctypes.c_void_p)  # an address: the capsule dies, and counts no further reference
def _unread(capsule, held=_held, valid=_valid, pointer=_pointer, names=(OLD, NEW)):
    for name in names:
        if valid(capsule, name):
            held.pop(pointer(capsule, name), None)


for _kept in (_delete, _unread):  # an array may outlive this module, at the interpreter's end
    ctypes.pythonapi.Py_IncRef(ctypes.py_object(_kept))


def capsule(owner, address, shape, max_version=None):
    """Returns a capsule of 32-bit floats at the address; the owner lives until the reader lets go. Readers that know DLPack 1.0 see that
    the floats are read-only; older ones cannot be told."""
    sides = (ctypes.c_int64 * len(shape))(*shape)
    steps = (ctypes.c_int64 * len(shape))(*(_product(shape[i + 1 :]) for i in range(len(shape))))
    tensor = Tensor(address, CPU, 0, len(shape), FLOAT, 32, 1, sides, steps, 0)
    new = max_version is not None and tuple(max_version) >= (1, 0)
    managed = Versioned(1, 0, None, _delete, READ_ONLY, tensor) if new else Managed(tensor, None, _delete)
    at = ctypes.addressof(managed)
    _held[at] = (managed, sides, steps, owner)
    return _new(at, NEW if new else OLD, ctypes.cast(_unread, ctypes.c_void_p))


def _product(numbers):
    product = 1
    for number in numbers:
        product *= number
    return product
