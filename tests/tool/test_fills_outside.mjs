// The fill layers of a style over vector tiles, drawn by camber render and by MapLibre GL JS in Chromium.
// usage: test_fills_outside.mjs CAMBER MBTILES PYTHON FOLDER
// npm's maplibre-gl and playwright-core are found through NODE_PATH, Chromium on PATH. Both read the same tiles, as
// files. They smooth edges each in its own way, which an area that one of them lacks, moves or fills by another rule
// cannot look like: that is wider. (A house to the north of the views has a hole that touches its ring, which MapLibre
// fills; it is a hole.) Pictures of views that fail stay in FOLDER. Exit status: 1 where they differ, 77 where
// something is not installed.
import {execFileSync} from 'node:child_process';
import {createServer} from 'node:http';
import {existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {comparePictures, launchBrowser} from './browser.mjs';

const SIDE = 768, CENTER = [-122.0265, 36.9705], ZOOMS = [15, 16.4, 17.7];
// Levels of 255 that a channel may be off on average, and that nothing wider than an edge may be off.
const MEAN = 2, LEVELS = 32;

const [tool, input, python, folder] = process.argv.slice(2);
const modules = process.env.NODE_PATH ?? '';
const browser = await launchBrowser('maplibre-gl');

const EXTRACT = `
import gzip, os, sqlite3, sys
for zoom, column, row, data in sqlite3.connect(sys.argv[1]).execute("SELECT * FROM tiles"):
    folder = os.path.join(sys.argv[2], str(zoom), str(column))
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, f"{2 ** zoom - 1 - row}.pbf"), "wb") as file:
        file.write(gzip.decompress(data) if data[:2] == b"\\x1f\\x8b" else data)
`;
// Opaque, translucent over it and moved, and with outlines of another colour from a zoom on.
const styleOf = tiles => ({version: 8, sources: {city: {type: 'vector', tiles: [tiles], minzoom: 15, maxzoom: 15}},
    layers: [{id: 'ground', type: 'background', paint: {'background-color': '#f6f2ea'}},
        {id: 'shade', type: 'fill', source: 'city', 'source-layer': 'buildings',
            paint: {'fill-color': '#405060', 'fill-opacity': 0.3, 'fill-translate': [3, 5], 'fill-antialias': false}},
        {id: 'houses', type: 'fill', source: 'city', 'source-layer': 'buildings',
            paint: {'fill-color': ['interpolate', ['linear'], ['zoom'], 14, '#c9dcb7', 18, '#e3a08c'],
                'fill-outline-color': ['step', ['zoom'], 'rgba(0, 0, 0, 0)', 16, '#705040']}}]});
const PAGE = `<!doctype html><style>body { margin: 0 } #map { width: ${SIDE}px; height: ${SIDE}px }</style>
<div id="map"></div>
<script type="module">
import * as maplibre from '/maplibre-gl/dist/maplibre-gl.mjs';
window.show = (style, center, zoom) => new Promise((resolve, reject) => {
    const shown = new maplibre.Map({container: 'map', style, center, zoom, interactive: false, attributionControl: false,
        fadeDuration: 0});
    shown.on('error', event => event.error.status === 404 || reject(event.error));
    shown.on('idle', () => resolve());
});
</script>`;
const TYPES = {'.mjs': 'text/javascript', '.css': 'text/css'};

function serve(work) {
    return createServer((request, response) => {
        const path = new URL(request.url, 'http://camber').pathname;
        const file = path.startsWith('/tiles/') ? join(work, path) : join(modules, path);
        const found = !path.includes('..') && existsSync(file) && statSync(file).isFile();
        const type = path === '/' ? 'text/html' : TYPES[path.slice(path.lastIndexOf('.'))] ?? 'application/x-protobuf';
        response.writeHead(found || path === '/' ? 200 : 404, {'Content-Type': type});
        response.end(path === '/' ? PAGE : found ? readFileSync(file) : undefined);
    });
}

async function check(page, work, own, zoom) {
    const drawn = join(work, 'drawn.png'), style = join(work, 'style.json');
    writeFileSync(style, JSON.stringify(styleOf(`${work}/tiles/{z}/{x}/{y}.pbf`)));
    execFileSync(tool, ['render', '-q', '-f', '--style', style, '--center', CENTER.join(','), '--zoom', String(zoom),
        '--size', `${SIDE}x${SIDE}`, '--simplify-px', '0', '-o', drawn]);
    await page.goto(own);
    await page.waitForFunction(() => window.show);
    await page.evaluate(([by, place, at]) => window.show(by, place, at),
        [styleOf(`${own}tiles/{z}/{x}/{y}.pbf`), CENTER, zoom]);
    const shown = await page.locator('#map').screenshot({type: 'png'});
    const found = await comparePictures(page, shown, readFileSync(drawn), LEVELS);
    console.log(`zoom ${zoom}: ${found.mean.toFixed(3)} of 255 on average, ${found.wide} pixels past ${LEVELS} with all ` +
        `around them; ${found.colors} colours`);
    // A picture without houses would be equal too.
    const right = found.same && found.mean <= MEAN && found.wide <= 8 && found.colors > 100;
    if (!right) {
        mkdirSync(folder, {recursive: true});
        writeFileSync(join(folder, `maplibre-${zoom}.png`), shown);
        writeFileSync(join(folder, `camber-${zoom}.png`), readFileSync(drawn));
    }
    return right;
}

const work = mkdtempSync(join(tmpdir(), 'camber-fills-'));
const server = serve(work);
let right = true;
try {
    execFileSync(python, ['-c', EXTRACT, input, join(work, 'tiles')]);
    await new Promise(resolve => server.listen(0, '127.0.0.1', resolve));
    const page = await browser.newPage({viewport: {width: SIDE, height: SIDE}, deviceScaleFactor: 1});
    for (const zoom of ZOOMS)
        right = await check(page, work, `http://127.0.0.1:${server.address().port}/`, zoom) && right;
} finally {
    await browser.close();
    server.close();
    rmSync(work, {recursive: true});
}
process.exit(right ? 0 : 1);
