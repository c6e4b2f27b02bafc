// Reads every tile of PMTiles by npm's pmtiles (found through NODE_PATH), which shares nothing with camber.
// usage: read_archives.mjs COUNT FILE STEP   The tiles of the numbers 0 to COUNT - 1 are there, and no other; every
// STEP-th is read.
// Prints a line `ZOOM COLUMN ROW HASH` a tile. Exit status: 1 where a tile is missing, 77 where the reader is not installed.
import {closeSync, openSync, readSync} from 'node:fs';
import {createRequire} from 'node:module';

let pmtiles;
try {
    pmtiles = createRequire(import.meta.url)('pmtiles');
} catch {
    console.log('skipped: npm package pmtiles is not installed');
    process.exit(77);
}

class FileSource {
    constructor(path) {
        this.path = path;
        this.file = openSync(path);
    }
    getKey() {
        return this.path;
    }
    async getBytes(offset, length) {
        const bytes = Buffer.alloc(length);
        const got = readSync(this.file, bytes, 0, length, offset);
        return {data: bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + got)};
    }
}

// CRC-32, as zlib computes it.
const table = new Uint32Array(256);
for (let i = 0; i < 256; i++) {
    table[i] = i;
    for (let bit = 0; bit < 8; bit++)
        table[i] = table[i] & 1 ? 0xedb88320 ^ (table[i] >>> 1) : table[i] >>> 1;
}
function hash(bytes) {
    let value = 0xffffffff;
    for (const byte of bytes)
        value = table[(value ^ byte) & 255] ^ (value >>> 8);
    return (value ^ 0xffffffff) >>> 0;
}

const [count, path, step] = [Number(process.argv[2]), process.argv[3], Number(process.argv[4])];
const archive = new pmtiles.PMTiles(new FileSource(path));
const header = await archive.getHeader();
const metadata = await archive.getMetadata();
if (header.numAddressedTiles !== count || metadata.name !== 'made') {
    console.error(`${path}: ${header.numAddressedTiles} tiles, name ${metadata.name}`);
    process.exit(1);
}
const lines = [];
for (let number = 0; number < count; number += step) {
    const [z, x, y] = pmtiles.tileIdToZxy(number);
    const tile = await archive.getZxy(z, x, y);
    if (!tile) {
        console.error(`${path}: no tile ${z}/${x}/${y}`);
        process.exit(1);
    }
    lines.push(`${z} ${x} ${y} ${hash(new Uint8Array(tile.data))}`);
}
const [z, x, y] = pmtiles.tileIdToZxy(count);
if (await archive.getZxy(z, x, y)) {
    console.error(`${path}: a tile that was not written, ${z}/${x}/${y}`);
    process.exit(1);
}
process.stdout.write(lines.join('\n') + '\n');
