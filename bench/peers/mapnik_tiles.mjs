// A pyramid by npm's @mapnik/mapnik (found through NODE_PATH): pictures of up to 8 x 8 tiles, none of them outside of the
// pyramid, cut, and each tile encoded.
// usage: mapnik_tiles.mjs MAP.xml W,S,E,N MIN_ZOOM MAX_ZOOM FORMAT RUNS
// Two workers draw and encode side by side. A tile of one colour is not encoded, and none is written. The pyramid is
// drawn once to warm up, and then so many times. Prints a line of JSON: version, medians of the milliseconds from the
// loaded map to the last tile and of those of the processors' time, tiles that were encoded, and their bytes. Exit
// status 77: the package is not installed.
import {createRequire} from 'node:module';

const WORKERS = 2, TILE = 256, META = 8, BUFFER = 64;
process.env.UV_THREADPOOL_SIZE = String(WORKERS);
let mapnik;
try {
    mapnik = createRequire(import.meta.url)('@mapnik/mapnik');
} catch {
    process.exit(77);
}
mapnik.register_default_input_plugins();

const [xml, box, minZoom, maxZoom, format, runs] = process.argv.slice(2);
const [west, south, east, north] = box.split(',').map(Number);
const WORLD = 20037508.342789244;
const xOf = lon => (lon + 180) / 360;
const yOf = lat => (1 - Math.asinh(Math.tan(lat * Math.PI / 180)) / Math.PI) / 2;

// Pictures of the tiles that overlap the box: the tiles [x, x + across) of the rows [y, y + down).
function* pictures() {
    for (let zoom = Number(minZoom); zoom <= Number(maxZoom); zoom++) {
        const last = 2 ** zoom - 1, tileAt = value => Math.min(last, Math.max(0, Math.floor(value * 2 ** zoom)));
        const [left, right, top, bottom] = [tileAt(xOf(west)), tileAt(xOf(east)), tileAt(yOf(north)), tileAt(yOf(south))];
        for (let y = top; y <= bottom; y += META)
            for (let x = left; x <= right; x += META)
                yield {zoom, x, y, across: Math.min(META, right + 1 - x), down: Math.min(META, bottom + 1 - y)};
    }
}

const promised = (object, name, ...given) =>
    new Promise((resolve, reject) => object[name](...given, (error, value) => error ? reject(error) : resolve(value)));

async function draw(map, {zoom, x, y, across, down}, done) {
    const tile = 2 * WORLD / 2 ** zoom;
    map.resize(across * TILE, down * TILE);
    map.extent = [x * tile - WORLD, WORLD - (y + down) * tile, (x + across) * tile - WORLD, WORLD - y * tile];
    const image = await promised(map, 'render', new mapnik.Image(across * TILE, down * TILE), {buffer_size: BUFFER});
    for (let row = 0; row < down; row++)
        for (let column = 0; column < across; column++) {
            const view = image.view(column * TILE, row * TILE, TILE, TILE);
            if (view.isSolidSync())
                continue;
            const bytes = await promised(view, 'encode', format);
            done.bytes += bytes.length; // apart from the wait, in which the other worker adds its own
            done.tiles++;
        }
}

async function work(map, queue, done) {
    for (let next = queue.next(); !next.done; next = queue.next())
        await draw(map, next.value, done);
}

const maps = Array.from({length: WORKERS}, () => {
    const map = new mapnik.Map(TILE, TILE);
    map.loadSync(xml);
    map.bufferSize = BUFFER;
    return map;
});

async function measure() {
    const done = {tiles: 0, bytes: 0}, queue = pictures(), begin = performance.now(), used = process.cpuUsage();
    await Promise.all(maps.map(map => work(map, queue, done)));
    const ms = performance.now() - begin, {user, system} = process.cpuUsage(used);
    return {...done, ms, cpu_ms: (user + system) / 1000};
}

const median = values => values.sort((a, b) => a - b)[Math.floor(values.length / 2)];
await measure();
const measured = [];
for (let run = 0; run < Number(runs); run++)
    measured.push(await measure());
console.log(JSON.stringify({
    version: mapnik.versions.mapnik,
    ...measured[0],
    ms: median(measured.map(run => run.ms)),
    cpu_ms: median(measured.map(run => run.cpu_ms)),
}));
