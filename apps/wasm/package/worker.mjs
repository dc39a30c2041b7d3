// A worker that holds the library for remote.mjs.
import { BurnishError, load } from "./burnish.mjs";

const port = typeof self === "undefined" ? (await import("node:worker_threads")).parentPort : self;
const scenes = new Map();
let burnish = null, next = 0;

const arrays_of = (picture) => [picture.pixels.buffer, ...Object.values(picture.layers).map((layer) => layer.values.buffer), ...(picture.rgba ? [picture.rgba.buffer] : [])];

function scene_of(number) {
    if (!scenes.has(number))
        throw new BurnishError("the scene is closed", 2);
    return scenes.get(number);
}

const work = {
    load: async (source) => {
        burnish = await load(source);
        return { version: burnish.version, options: burnish.options(), techniques: burnish.techniques() };
    },
    open: (scene, options) => {
        const opened = burnish.open(scene, options);
        scenes.set(++next, opened);
        const { materials, nodes, lights, variants, warnings } = opened;
        return { scene: next, materials, nodes, lights, variants, warnings };
    },
    render: (scene, { display, ...options }) => {
        const drawn = scene_of(scene).render(options);
        try {
            const { width, height, pixels, hash, layers } = drawn;
            return { width, height, pixels, hash, layers, rgba: display ? drawn.rgba8(display) : undefined };
        } finally {
            drawn.close();
        }
    },
    change: (scene, method, values) => { scene_of(scene)[method](...values); },
    close: (scene) => { scenes.get(scene)?.close(); scenes.delete(scene); },
    compare: (reference, test) => burnish.compare(reference, test),
};

const answer = async ({ id, name, values, tells }) => {
    try {
        if (tells) // a function cannot be sent: the other side has it
            values[1] = { ...values[1], progress: (step, done) => { port.postMessage({ id, step, done }); } };
        const result = await work[name](...values);
        port.postMessage({ id, result }, name === "render" ? arrays_of(result) : []);
    } catch (error) {
        port.postMessage({ id, error: { message: error.message, code: error instanceof BurnishError ? error.code : 70 } });
    }
};
if (port.on)
    port.on("message", answer);
else
    port.onmessage = ({ data }) => answer(data);
