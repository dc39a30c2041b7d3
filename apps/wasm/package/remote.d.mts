/** The library in a worker: the calling thread never waits. */
import type { Comparison, Display, OpenOptions, OptionInfo, Options, Pixels, Layer, ProgressFunction, Source, TechniqueInfo } from "./burnish.mjs";

/** Options of render(), and the 8-bit pixels that are wanted. */
export interface RemoteOptions {
    display?: Display;
    progress?: ProgressFunction;
    [option: string]: unknown;
}

export interface RemotePicture extends Pixels {
    readonly hash: string;
    readonly layers: { [name: string]: Layer };
    /** 4 bytes a pixel, where `display` asked for them. */
    readonly rgba?: Uint8ClampedArray;
}

export interface RemoteScene {
    readonly materials: string[];
    readonly nodes: string[];
    readonly lights: string[];
    readonly variants: string[];
    readonly warnings: string[];
    setMaterial(which: number | string, factors: Options): Promise<void>;
    setLight(which: number | string, factors: Options): Promise<void>;
    setNode(which: number | string, matrix: ArrayLike<number>): Promise<void>;
    setEnvironment(environment: Source | undefined, options?: Options): Promise<void>;
    render(options?: RemoteOptions): Promise<RemotePicture>;
    close(): Promise<void>;
}

export interface RemoteBurnish {
    readonly version: string;
    options(): OptionInfo[];
    techniques(): TechniqueInfo[];
    open(scene: Source, options?: OpenOptions): Promise<RemoteScene>;
    compare(reference: Pixels, test: Pixels): Promise<Comparison>;
    /** Ends the worker. Calls under way fail with code 130. */
    end(): Promise<unknown> | void;
}

export declare function connect(source?: { wasm?: Uint8Array | ArrayBuffer | string }): Promise<RemoteBurnish>;
