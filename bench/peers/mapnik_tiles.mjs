// A pyramid by npm's @mapnik/mapnik (found through NODE_PATH): pictures of 8 x 8 tiles, cut, and each tile encoded.
// usage: mapnik_tiles.mjs MAP.xml W,S,E,N MIN_ZOOM MAX_ZOOM FORMAT
// Two workers draw and encode side by side. A tile of one colour is not encoded, and none is written. Prints a line of
// JSON: version, milliseconds from the loaded map to the last tile, those of the processors' time, tiles that were
// encoded, and their bytes. Exit status 77: the package is not installed.
import {createRequire} from 'node:module';

const WORKERS = 2, TILE = 256, META = 8, SIDE = TILE * META, BUFFER = 64;
process.env.UV_THREADPOOL_SIZE = String(WORKERS);
let mapnik;
try {
    mapnik = createRequire(import.meta.url)('@mapnik/mapnik');
} catch {
    process.exit(77);
}
mapnik.register_default_input_plugins();

const [xml, box, minZoom, maxZoom, format] = process.argv.slice(2);
const [west, south, east, north] = box.split(',').map(Number);
const WORLD = 20037508.342789244;
const xOf = lon => (lon + 180) / 360;
const yOf = lat => (1 - Math.asinh(Math.tan(lat * Math.PI / 180)) / Math.PI) / 2;

// The pictures whose tiles overlap the box.
function* pictures() {
    for (let zoom = Number(minZoom); zoom <= Number(maxZoom); zoom++) {
        const last = 2 ** zoom - 1, tileAt = value => Math.min(last, Math.max(0, Math.floor(value * 2 ** zoom)));
        const [left, right, top, bottom] = [tileAt(xOf(west)), tileAt(xOf(east)), tileAt(yOf(north)), tileAt(yOf(south))];
        for (let y = top - top % META; y <= bottom; y += META)
            for (let x = left - left % META; x <= right; x += META)
                yield {zoom, x, y, left, right, top, bottom};
    }
}

const done = {tiles: 0, bytes: 0};
const promised = (object, name, ...given) =>
    new Promise((resolve, reject) => object[name](...given, (error, value) => error ? reject(error) : resolve(value)));

async function draw(map, picture) {
    const {zoom, x, y, left, right, top, bottom} = picture, tile = 2 * WORLD / 2 ** zoom;
    map.extent = [x * tile - WORLD, WORLD - (y + META) * tile, (x + META) * tile - WORLD, WORLD - y * tile];
    const image = await promised(map, 'render', new mapnik.Image(SIDE, SIDE), {buffer_size: BUFFER});
    for (let row = Math.max(y, top); row < y + META && row <= bottom; row++)
        for (let column = Math.max(x, left); column < x + META && column <= right; column++) {
            const view = image.view((column - x) * TILE, (row - y) * TILE, TILE, TILE);
            if (view.isSolidSync())
                continue;
            const bytes = await promised(view, 'encode', format);
            done.bytes += bytes.length; // apart from the wait, in which the other worker adds its own
            done.tiles++;
        }
}

async function work(map, queue) {
    for (let next = queue.next(); !next.done; next = queue.next())
        await draw(map, next.value);
}

const maps = Array.from({length: WORKERS}, () => {
    const map = new mapnik.Map(SIDE, SIDE);
    map.loadSync(xml);
    map.bufferSize = BUFFER;
    return map;
});
const queue = pictures(), begin = performance.now(), used = process.cpuUsage();
await Promise.all(maps.map(map => work(map, queue)));
const ms = performance.now() - begin, {user, system} = process.cpuUsage(used);
console.log(JSON.stringify({version: mapnik.versions.mapnik, ms, cpu_ms: (user + system) / 1000, ...done}));
