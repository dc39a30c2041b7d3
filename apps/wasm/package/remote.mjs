// The library in a worker: the calling thread never waits.
//
//   import { connect } from "burnish/remote";
//   const burnish = await connect();
//   const scene = await burnish.open("builtin:teapot");
//   const picture = await scene.render({ width: 640, height: 360, display: {} });
//   context.putImageData(new ImageData(picture.rgba, picture.width, picture.height), 0, 0);
//
// Options and results are those of burnish.mjs. `display` asks for 8-bit pixels too: {exposure, tonemap}. A progress function hears, and cannot
// stop the work: end() does.
import { BurnishError } from "./burnish.mjs";

async function start() {
    const url = new URL("worker.mjs", import.meta.url);
    if (typeof Worker === "function")
        return new Worker(url, { type: "module" });
    const { Worker: Thread } = await import("node:worker_threads");
    return new Thread(url);
}

/** Starts a worker. wasm: as load() takes it; bytes or an address as text. */
export async function connect({ wasm } = {}) {
    const worker = await start(), waiting = new Map();
    let next = 0, ended = null;
    const end = (message, code) => {
        ended = new BurnishError(message, code);
        for (const { reject } of waiting.values())
            reject(ended);
        waiting.clear();
    };
    const take = ({ id, result, error, step, done }) => {
        const call = waiting.get(id);
        if (!call)
            return;
        if (step !== undefined) {
            call.progress(step, done);
            return;
        }
        waiting.delete(id);
        if (error)
            call.reject(new BurnishError(error.message, error.code));
        else
            call.resolve(result);
    };
    if (worker.on) {
        worker.on("message", take);
        worker.on("error", (error) => end(`the worker ended: ${error.message}`, 70));
    } else {
        worker.onmessage = ({ data }) => take(data);
        worker.onerror = (event) => end(`the worker ended: ${event.message || "it could not start"}`, 70);
    }
    const call = (name, ...values) => new Promise((resolve, reject) => {
        if (ended) {
            reject(ended);
            return;
        }
        const id = ++next, progress = values[1]?.progress;
        if (progress) {
            const { progress: _, ...rest } = values[1];
            values[1] = rest;
        }
        waiting.set(id, { resolve, reject, progress });
        try {
            worker.postMessage({ id, name, values, tells: !!progress });
        } catch (error) { // a value that cannot be sent
            waiting.delete(id);
            reject(new BurnishError(error.message, 2));
        }
    });
    try {
        const { version, options, techniques } = await call("load", wasm === undefined ? {} : { wasm });
        return {
            version,
            options: () => options,
            techniques: () => techniques,
            open: async (scene, options = {}) => remote_scene(call, await call("open", scene, options)),
            compare: (reference, test) => call("compare", size_and_pixels(reference), size_and_pixels(test)),
            /** Ends the worker. Calls under way fail with code 130. */
            end: () => {
                end("stopped", 130);
                return worker.terminate();
            },
        };
    } catch (error) {
        worker.terminate();
        throw error;
    }
}

const size_and_pixels = ({ width, height, pixels }) => ({ width, height, pixels });

function remote_scene(call, { scene, ...lists }) {
    const changes = ["setMaterial", "setLight", "setNode", "setEnvironment"];
    return {
        ...lists,
        render: (options = {}) => call("render", scene, options),
        close: () => call("close", scene),
        ...Object.fromEntries(changes.map((method) => [method, (...values) => call("change", scene, method, values)])),
    };
}
