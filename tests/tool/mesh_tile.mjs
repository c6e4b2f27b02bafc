// Reads mesh tiles as docs/mesh-tiles.md describes them, for tests. npm's three, which has the decoder of meshoptimizer, is
// found through NODE_PATH.
import {existsSync} from 'node:fs';
import {join} from 'node:path';
import {pathToFileURL} from 'node:url';

export const SENTINEL = 1, FIRST = 2, LAST = 4, RING = 8, CUT = 16;

// The decoder; null: npm's three is not installed.
export async function loadDecoder() {
    const path = join(process.env.NODE_PATH ?? '', 'three/examples/jsm/libs/meshopt_decoder.module.js');
    if (!existsSync(path))
        return null;
    const {MeshoptDecoder} = await import(pathToFileURL(path));
    await MeshoptDecoder.ready;
    return MeshoptDecoder;
}

// The JSON of a GLB, what its accessors have, and the attributes of its lines by name, each an array of vertices.
export function readTile(decoder, file) {
    const view = new DataView(file.buffer, file.byteOffset, file.byteLength), text = view.getUint32(12, true);
    const json = JSON.parse(new TextDecoder().decode(file.subarray(20, 20 + text))), binary = file.subarray(28 + text);
    const buffers = json.bufferViews.map(({byteLength, extensions}) => {
        const packed = extensions.EXT_meshopt_compression, start = packed.byteOffset ?? 0, bytes = new Uint8Array(byteLength);
        decoder.decodeGltfBuffer(bytes, packed.count, packed.byteStride, binary.subarray(start, start + packed.byteLength),
            packed.mode, packed.filter);
        return bytes;
    });
    const values = json.accessors.map(({bufferView, byteOffset = 0, componentType, count, type}) => {
        const bytes = new DataView(buffers[bufferView].buffer), width = type === 'SCALAR' ? 1 : Number(type.slice(3));
        const [size, get] = {5121: [1, 'getUint8'], 5122: [2, 'getInt16'], 5125: [4, 'getUint32'], 5126: [4, 'getFloat32']}[componentType];
        const stride = json.bufferViews[bufferView].byteStride ?? size * width;
        return Array.from({length: count}, (_, i) => Array.from({length: width}, (__, k) =>
            bytes[get](byteOffset + stride * i + size * k, true)));
    });
    const named = ({attributes}) => Object.fromEntries(Object.entries(attributes).map(([name, i]) => [name, values[i]]));
    const {primitives, extras} = json.meshes[0], lines = primitives.find(({mode}) => mode === 5);
    const areas = primitives.find(({mode}) => mode === undefined);
    return {json, extras, values, attributes: lines ? named(lines) : null,
        areas: areas ? {...named(areas), indices: values[areas.indices].flat()} : null};
}

// The records of lines: each second vertex has one.
export function recordsOf({attributes}) {
    return attributes._POINT.filter((_, i) => i % 2 === 0).map(([x, y, row, flags], i) =>
        ({x, y, row, flags, along: attributes._ALONG?.[2 * i]}));
}
