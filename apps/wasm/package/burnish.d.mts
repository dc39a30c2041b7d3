/** Pictures with the bits that the program `burnish` draws, in browsers and node. Lengths are metres, angles degrees. */

/** A failure. `code` is the exit code of the program: 2 wrong option, 3 sizes differ, 4 bad input, 77 unavailable, 130 stopped, 70 a fault of
 * burnish. */
export declare class BurnishError extends Error {
    constructor(message: string, code: number);
    readonly code: number;
}

/** Options by the library's names: {width: 640, technique: "lobe_line", orbit: [30, 20]}. Burnish.options() lists them. */
export type OptionValue = string | number | boolean | ReadonlyArray<number | string> | Float32Array;
export interface Options {
    [name: string]: OptionValue | ProgressFunction | undefined | null;
    /** Called ten times a second with the work's name, and its share that is done, 0 to 1, or -1. Returning true stops the work (code 130). */
    progress?: ProgressFunction;
}
export type ProgressFunction = (work: string, done: number) => boolean | void;

/** A file with its name, or the bytes of a .glb, .gltf, .obj or .hdr file. */
export type Source = string | Uint8Array | ArrayBuffer | { name: string; bytes: Uint8Array | ArrayBuffer };

export interface OpenOptions {
    /** "builtin:studio", or a .hdr file. Without it: the scene's own light, else builtin:studio. */
    environment?: Source;
    /** Files that the scene's file names. */
    files?: { [name: string]: Uint8Array | ArrayBuffer };
    [option: string]: unknown;
}

export interface OptionInfo { name: string; help: string; values: string; fallback: string; }
export interface TechniqueInfo { name: string; help: string; }

export interface Layer { values: Float32Array; channels: number; }

export interface Pixels {
    readonly width: number;
    readonly height: number;
    /** 3 a pixel by rows from the top: linear Rec.709 radiance. */
    readonly pixels: Float32Array;
}

export interface Display {
    /** Stops, -64 to 64. */
    exposure?: number;
    tonemap?: "none" | "pbr-neutral" | "aces";
}

export interface Picture extends Pixels {
    /** 16 hexadecimal digits over the pixels' bits, equal on every machine. */
    readonly hash: string;
    /** Layers that the option `layers` asked for. */
    readonly layers: { [name: string]: Layer };
    /** The picture as screens show it, 4 bytes a pixel: for an ImageData. */
    rgba8(display?: Display): Uint8ClampedArray;
    /** Frees what rgba8() needs. The arrays stay. */
    close(): void;
}

export interface Comparison {
    flip_mean: number; flip_p99: number; flip_max: number; mse: number; rel_mse: number; max_abs: number; differing_fraction: number;
}

/** Materials, lights and nodes are named, or given by index. */
export interface Scene {
    readonly materials: string[];
    readonly nodes: string[];
    readonly lights: string[];
    readonly variants: string[];
    /** What was repaired or left out while the scene was read. */
    readonly warnings: string[];
    setMaterial(which: number | string, factors: Options): void;
    setLight(which: number | string, factors: Options): void;
    /** matrix: 16 numbers, column by column, to the parent's space. */
    setNode(which: number | string, matrix: ArrayLike<number>): void;
    setEnvironment(environment: Source | undefined, options?: Options): void;
    render(options?: Options): Picture;
    /** Frees the scene's memory. */
    close(): void;
}

export interface Burnish {
    readonly version: string;
    options(): OptionInfo[];
    techniques(): TechniqueInfo[];
    open(scene: Source, options?: OpenOptions): Scene;
    compare(reference: Pixels, test: Pixels): Comparison;
}

/** Starts the library in the calling thread. wasm: the bytes of burnish_core.wasm, or its address; without it the file beside this one. */
export declare function load(source?: { wasm?: Uint8Array | ArrayBuffer | URL | string }): Promise<Burnish>;
