// burnish for JavaScript: pictures with the bits that the program draws, in browsers and node.
//
//   import { load } from "burnish";
//   const burnish = await load();
//   const scene = burnish.open(bytesOfLampGlb, { environment: "builtin:studio" });
//   const picture = scene.render({ width: 640, height: 360, technique: "lobe_line" });
//   picture.pixels;    // Float32Array, 3 a pixel, linear Rec.709 radiance
//   picture.hash;      // the pixel hash of `burnish render --stats`
//
// Lengths are metres, angles degrees. Names and values of options are the library's: burnish.options() lists them. Calls work in the calling
// thread: worker.mjs does the same in a worker.
import makeCore from "./burnish_core.mjs";

/** A failure. `code` is the exit code of the program: 2 wrong option, 4 bad input, 77 unavailable, 130 stopped, 70 a fault of burnish. */
export class BurnishError extends Error {
    constructor(message, code) {
        super(message);
        this.name = "BurnishError";
        this.code = code;
    }
}

async function bytesOf(source) {
    if (!(source instanceof URL) && typeof source !== "string")
        return source;
    const url = new URL(source, import.meta.url);
    if (url.protocol === "file:" && typeof process === "object") {
        const { readFile } = await import("node:fs/promises");
        return readFile(url).catch((fault) => { throw new BurnishError(`${url}: ${fault.code}`, 4); });
    }
    const answer = await fetch(url).catch((fault) => { throw new BurnishError(`${url}: ${fault.message}`, 4); });
    if (!answer.ok)
        throw new BurnishError(`${url}: ${answer.status} ${answer.statusText}`, 4);
    return answer.arrayBuffer().catch((fault) => { throw new BurnishError(`${url}: ${fault.message}`, 4); });
}

/** Starts the library. wasm: the bytes of burnish_core.wasm, or its address; without it the file beside this one. */
export async function load({ wasm = new URL("burnish_core.wasm", import.meta.url) } = {}) {
    const wasmBinary = await bytesOf(wasm);
    try {
        return new Burnish(await makeCore({ wasmBinary, printErr: (line) => console.warn(line) }));
    } catch (fault) {
        throw fault instanceof BurnishError ? fault : new BurnishError(`${isBytes(wasm) ? "wasm" : wasm}: ${fault.message ?? fault}`, 4);
    }
}

const isBytes = (value) => value instanceof Uint8Array || value instanceof ArrayBuffer;

function asBytes(value, name) {
    if (!isBytes(value))
        throw new BurnishError(`${name}: is no Uint8Array and no ArrayBuffer`, 2);
    return value instanceof ArrayBuffer ? new Uint8Array(value) : value;
}

const asText = (value) => (Array.isArray(value) || ArrayBuffer.isView(value) ? [...value].join(",") : String(value));

/** The name of a model that has none: by its first bytes. */
function modelName(bytes) {
    const first = String.fromCharCode(...bytes.subarray(0, 4));
    return first === "glTF" ? "scene.glb" : /^\s*\{/.test(first) ? "scene.gltf" : "scene.obj";
}

class Burnish {
    #core;
    #folders = 0;
    #lost = null; // the fault that ended the module

    constructor(core) {
        this.#core = core;
    }

    get version() {
        return this.#core.UTF8ToString(this.#core._burnish_version());
    }

    #list(name, ...others) {
        const text = (of, index) => this.#core.UTF8ToString(this.#core["_burnish_" + of](index));
        const out = [];
        for (let i = 0; this.#core["_burnish_" + name](i); ++i)
            out.push([text(name, i), ...others.map((other) => text(other, i))]);
        return out;
    }

    /** Options of open() and render(): [{name, help, values, fallback}]. */
    options() {
        return this.#list("option_name", "option_help", "option_values", "option_default").map(([name, help, values, fallback]) => ({
            name, help, values, fallback,
        }));
    }

    /** Techniques for light from the environment: [{name, help}]. */
    techniques() {
        return this.#list("technique_name", "technique_help").map(([name, help]) => ({ name, help }));
    }

    /** Throws if the module has ended. */
    alive() {
        if (this.#lost)
            throw new BurnishError(`burnish ended: ${this.#lost.message}`, 70);
    }

    /** Calls a function of the C interface. Throws what it says. */
    call(name, ...values) {
        this.alive();
        let code;
        try {
            code = this.#core["_burnish_" + name](...values);
        } catch (error) { // a trap or an exception of JavaScript: what the module holds can no longer be trusted
            this.#lost = error;
            throw new BurnishError(`burnish ended: ${error.message}`, 70);
        }
        if (code !== 0)
            throw new BurnishError(this.#core.UTF8ToString(this.#core._burnish_error()), code);
    }

    /** Calls with the address of a text; null gives 0. */
    withText(text, work) {
        if (text === null || text === undefined)
            return work(0);
        this.alive();
        const size = this.#core.lengthBytesUTF8(text) + 1, at = this.#core._malloc(size);
        if (!at)
            throw new BurnishError("out of memory", 4);
        try {
            this.#core.stringToUTF8(text, at, size);
            return work(at);
        } finally {
            if (!this.#lost)
                this.#core._free(at);
        }
    }

    /** Calls with the address of `bytes` bytes, zero at first. */
    withMemory(bytes, work) {
        this.alive();
        const at = this.#core._malloc(bytes) >>> 0;
        if (!at)
            throw new BurnishError("out of memory", 4);
        try {
            this.#core.HEAPU8.fill(0, at, at + bytes);
            return work(at);
        } finally {
            if (!this.#lost)
                this.#core._free(at);
        }
    }

    /** The pointer at an address. */
    word(at) {
        return this.#core.HEAPU32[at >>> 2];
    }

    get lost() {
        return this.#lost !== null;
    }

    get core() {
        return this.#core;
    }

    /** Calls with options. `progress(work, done)` is called ten times a second, and stops the work by returning true. */
    withOptions({ progress, ...values }, work) {
        return this.withMemory(4, (slot) => {
            this.call("options_make", slot);
            const options = this.word(slot);
            let told = 0, thrown = null;
            try {
                for (const [name, value] of Object.entries(values))
                    if (value !== undefined && value !== null)
                        this.withText(name, (n) => this.withText(asText(value), (v) => this.call("options_set", options, n, v)));
                if (progress) {
                    told = this.#core.addFunction((user, name, done) => {
                        try {
                            return progress(this.#core.UTF8ToString(name), done) === true ? 1 : 0;
                        } catch (error) {
                            thrown = { error };
                            return 1; // stops the work
                        }
                    }, "iiid");
                    this.call("options_progress", options, told, 0);
                }
                return work(options);
            } catch (error) {
                throw thrown ? thrown.error : error;
            } finally {
                if (!this.#lost)
                    this.#core._burnish_options_free(options);
                if (told)
                    this.#core.removeFunction(told);
            }
        });
    }

    /** Calls with a folder that holds files: {name: bytes}. Names may hold folders. */
    withFiles(files, work) {
        const FS = this.#core.FS, folder = `/in/${++this.#folders}`, made = [];
        try {
            for (const [name, bytes] of Object.entries(files)) {
                const path = `${folder}/${name}`;
                if (path.split("/").includes(".."))
                    throw new BurnishError(`${name}: a file's name may not lead out of its folder`, 4);
                this.alive();
                FS.mkdirTree(path.slice(0, path.lastIndexOf("/")));
                FS.writeFile(path, asBytes(bytes, name));
                made.push(path);
            }
            return work(folder);
        } finally {
            for (const path of made)
                FS.unlink(path);
        }
    }

    /** Calls with the scene's or the environment's place: "builtin:NAME", or a file made of {name, bytes} or bytes. */
    #placed(source, nameOf, files, kind) {
        if (source === undefined || source === null || typeof source === "string")
            return source ?? null;
        const bytes = asBytes(isBytes(source) ? source : source.bytes, kind);
        const name = source.name ?? nameOf(bytes);
        files[name] = bytes;
        return { file: name };
    }

    /** Opens a scene: "builtin:NAME", the bytes of a .glb, .gltf or .obj file, or {name, bytes}.
     * environment: "builtin:NAME", the bytes of a .hdr file, or {name, bytes}. files: {name: bytes}, which the scene's file names. */
    open(scene, { environment, files = {}, ...options } = {}) {
        const all = { ...files };
        const sceneAt = this.#placed(scene, modelName, all, "scene"), lightAt = this.#placed(environment, () => "environment.hdr", all, "environment");
        const path = (folder, place) => (place && place.file ? `${folder}/${place.file}` : place);
        return this.withFiles(all, (folder) =>
            this.withOptions(options, (o) =>
                this.withText(path(folder, sceneAt), (s) =>
                    this.withText(path(folder, lightAt), (e) =>
                        this.withMemory(4, (slot) => {
                            this.call("open", s, e, o, slot);
                            return new Scene(this, this.word(slot));
                        })))));
    }

    /** Compares two pictures of equal size: HDR-FLIP and other figures. */
    compare(reference, test) {
        if (reference.width !== test.width || reference.height !== test.height)
            throw new BurnishError(`sizes differ: ${reference.width}x${reference.height} and ${test.width}x${test.height}`, 3);
        for (const { width, height, pixels } of [reference, test])
            if (!Number.isInteger(width) || !Number.isInteger(height) || pixels.length !== 3 * width * height)
                throw new BurnishError(`pixels: has ${pixels.length} numbers in place of 3 x ${width} x ${height}`, 3);
        const names = ["flip_mean", "flip_p99", "flip_max", "mse", "rel_mse", "max_abs", "differing_fraction"];
        const copied = (picture, work) => this.withMemory(picture.pixels.byteLength, (at) => {
            this.#core.HEAPF32.set(picture.pixels, at >>> 2);
            return work(at);
        });
        return copied(reference, (a) => copied(test, (b) => this.withMemory(8 + 8 * names.length, (out) => {
            this.#core.HEAPU32[out >>> 2] = 8 + 8 * names.length;
            this.call("compare", a, b, reference.width, reference.height, out);
            return Object.fromEntries(names.map((name, i) => [name, this.#core.HEAPF64[(out >>> 3) + 1 + i]]));
        })));
    }
}

/** A scene under an environment. close() frees its memory. */
class Scene {
    #burnish;
    #session;

    constructor(burnish, session) {
        this.#burnish = burnish;
        this.#session = session;
    }

    #listed(function_) {
        const core = this.#burnish.core, out = [];
        for (let i = 0, text; (text = core["_burnish_" + function_](this.#open, i)) !== 0; ++i)
            out.push(core.UTF8ToString(text));
        return out;
    }

    get #open() {
        this.#burnish.alive();
        if (!this.#session)
            throw new BurnishError("the scene is closed", 2);
        return this.#session;
    }

    get materials() { return this.#listed("scene_material"); }
    get nodes() { return this.#listed("scene_node"); }
    get lights() { return this.#listed("scene_light"); }
    get variants() { return this.#listed("scene_variant"); }
    /** What was repaired or left out while the scene was read. */
    get warnings() { return this.#listed("warning"); }

    #index(kind, which) {
        if (typeof which === "number")
            return which;
        const index = this.#burnish.withText(which, (name) => this.#burnish.core["_burnish_find_" + kind](this.#open, name));
        if (index < 0)
            throw new BurnishError(`no ${kind} is named '${which}'`, 2);
        return index;
    }

    /** Changes factors of a material, by index or name. */
    setMaterial(which, factors) {
        const index = this.#index("material", which);
        this.#burnish.withOptions(factors, (o) => this.#burnish.call("set_material", this.#open, index, o));
    }

    /** Changes factors of a lamp, by index or name. */
    setLight(which, factors) {
        const index = this.#index("light", which);
        this.#burnish.withOptions(factors, (o) => this.#burnish.call("set_light", this.#open, index, o));
    }

    /** Moves a node, by index or name. matrix: 16 numbers, column by column, to the parent's space. */
    setNode(which, matrix) {
        if (matrix.length !== 16)
            throw new BurnishError(`matrix: has ${matrix.length} numbers in place of 16`, 2);
        const index = this.#index("node", which);
        this.#burnish.withMemory(64, (at) => {
            this.#burnish.core.HEAPF32.set(matrix, at >>> 2);
            this.#burnish.call("set_node", this.#open, index, at);
        });
    }

    /** Changes the environment: as open() takes it. */
    setEnvironment(environment, options = {}) {
        const files = {}, named = environment === undefined || environment === null || typeof environment === "string";
        if (!named)
            files[environment.name ?? "environment.hdr"] = asBytes(isBytes(environment) ? environment : environment.bytes, "environment");
        this.#burnish.withFiles(files, (folder) =>
            this.#burnish.withOptions(options, (o) =>
                this.#burnish.withText(named ? environment : `${folder}/${Object.keys(files)[0]}`, (e) =>
                    this.#burnish.call("set_environment", this.#open, e, o))));
    }

    /** Draws a picture. */
    render(options = {}) {
        return this.#burnish.withOptions(options, (o) => this.#burnish.withMemory(4, (slot) => {
            this.#burnish.call("render", this.#open, o, slot);
            return new Picture(this.#burnish, this.#burnish.word(slot), asText(options.layers ?? options.aov ?? ""));
        }));
    }

    close() {
        if (this.#session && !this.#burnish.lost)
            this.#burnish.core._burnish_close(this.#session);
        this.#session = 0;
    }
}

/** A picture. Its arrays are copies, which live on by themselves. */
class Picture {
    constructor(burnish, frame, layers) {
        const core = burnish.core;
        try {
            this.width = core._burnish_frame_width(frame);
            this.height = core._burnish_frame_height(frame);
            const floats = (at, channels) => core.HEAPF32.slice(at >>> 2, (at >>> 2) + channels * this.width * this.height);
            /** 3 floats a pixel by rows from the top: linear Rec.709 radiance. */
            this.pixels = floats(core._burnish_frame_pixels(frame), 3);
            /** 16 hexadecimal digits, equal on every machine. */
            this.hash = BigInt.asUintN(64, core._burnish_frame_hash(frame)).toString(16).padStart(16, "0");
            /** {name: {values, channels}} of the layers that were asked for. */
            this.layers = {};
            for (const name of layers.split(",").filter(Boolean))
                this.layers[name] = burnish.withMemory(4, (slot) => burnish.withText(name, (n) => {
                    const at = core._burnish_frame_layer(frame, n, slot), channels = burnish.word(slot);
                    return at ? { values: floats(at, channels), channels } : undefined;
                }));
            this.#burnish = burnish;
            this.#frame = frame;
        } catch (error) {
            core._burnish_frame_free(frame);
            throw error;
        }
    }
    #burnish;
    #frame;

    /** The picture as screens show it: 4 bytes a pixel, for an ImageData. exposure: stops. tonemap: "none", "pbr-neutral" or "aces". */
    rgba8({ exposure = 0, tonemap = "pbr-neutral" } = {}) {
        const core = this.#burnish.core;
        if (!this.#frame)
            throw new BurnishError("the picture is closed", 2);
        return this.#burnish.withText(tonemap, (name) => this.#burnish.withMemory(4, (slot) => {
            this.#burnish.call("frame_tonemap", this.#frame, name);
            this.#burnish.call("frame_rgba8", this.#frame, exposure, slot);
            const at = this.#burnish.word(slot);
            return new Uint8ClampedArray(core.HEAPU8.slice(at, at + 4 * this.width * this.height).buffer);
        }));
    }

    /** Frees what rgba8() needs. The arrays stay. */
    close() {
        if (this.#frame && !this.#burnish.lost)
            this.#burnish.core._burnish_frame_free(this.#frame);
        this.#frame = 0;
    }
}
