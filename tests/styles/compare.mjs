// Public styles, drawn by camber beside MapLibre GL JS in Chromium: the same tiles, sprites and glyphs.
// usage: compare.mjs CAMBER OUT [STYLE [CITY]]
// CAMBER_STYLES names the folder that prepare.py makes. npm's maplibre-gl, pmtiles and playwright-core are found
// through NODE_PATH, Chromium on PATH. A picture is right if the channels of both differ by less than MEAN of 255 on
// average. MapLibre places labels in the order of the features in tiles, camber in one that is the same for all cuts of
// a map, so both are asked for the order of tiles ("symbol-z-order": "source"); how far the style's own picture is from
// that is printed, too. MapLibre's, camber's and eight times their difference stay in OUT, side by side. Exit status: 1
// where a picture differs, 77 where something is not installed.
import {execFileSync} from 'node:child_process';
import {existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join, resolve} from 'node:path';
import {comparePictures, launchBrowser, serveFiles, skip} from '../tool/browser.mjs';

const WIDTH = 768, HEIGHT = 512, MEAN = 1.5;
// Each view is in one tile: MapLibre cuts lines where tiles meet, camber joins them.
const VIEWS = [
    {city: 'liechtenstein', center: [9.629, 47.16], zoom: 10.95},
    {city: 'porto', center: [-8.6353, 41.1621], zoom: 13.95},
    {city: 'newyork', center: [-74.00665, 40.71187], zoom: 16.95},
];
// Pictures that differ by more: the most that they may, and why.
const AREAS = 'areas of a translucent layer add up where they overlap there; here a layer fills them together';
const EXCEPTIONS = {
    'liberty 16.95': [2.4, AREAS],
    'ofm-liberty 16.95': [2.4, AREAS],
    'osm-bright 16.95': [2.9, 'streets that go on in other tiles are labelled from where their tile cuts them there, ' +
        'and from their beginning here; shops then have other places'],
};
const LEFT_OUT = ['raster', 'fill-extrusion', 'hillshade', 'heatmap'];

const [tool, out, onlyStyle, onlyCity] = process.argv.slice(2);
const modules = process.env.NODE_PATH ?? '', folder = process.env.CAMBER_STYLES && resolve(process.env.CAMBER_STYLES);
if (!folder || !existsSync(join(folder, 'styles')))
    skip('CAMBER_STYLES names no folder that prepare.py made: public styles are not compared');
const browser = await launchBrowser('maplibre-gl', 'pmtiles');

// ---- What the browser asks for ----

const PAGE = `<!doctype html><style>body { margin: 0 } #map { width: ${WIDTH}px; height: ${HEIGHT}px }</style>
<div id="map"></div>
<script src="/modules/pmtiles/dist/pmtiles.js"></script>
<script type="module">
import * as maplibre from '/modules/maplibre-gl/dist/maplibre-gl.mjs';
maplibre.addProtocol('pmtiles', new pmtiles.Protocol().tile);
window.show = (style, center, zoom) => new Promise((resolve, reject) => {
    const map = new maplibre.Map({container: 'map', style, center, zoom, interactive: false, attributionControl: false,
        fadeDuration: 0, localIdeographFontFamily: false, pixelRatio: 1});
    map.on('error', event => reject(event.error));
    map.on('styleimagemissing', () => {});
    map.on('idle', () => resolve());
    window.map = map;
});
</script>`;

// ---- The pictures ----

// The style of a folder with the root's and the city's names, and with the layers that are kept.
function readStyle(name, city, root, keep, byTiles) {
    const text = readFileSync(join(folder, 'styles', name, 'style.json'), 'utf8');
    const style = JSON.parse(text.replaceAll('{root}', root).replaceAll('{city}', city));
    style.layers = style.layers.filter(layer => !LEFT_OUT.includes(layer.type) && keep(layer));
    for (const layer of style.layers)
        if (byTiles && layer.type === 'symbol')
            layer.layout = {...layer.layout, 'symbol-z-order': 'source'};
    for (const [source, {type}] of Object.entries(style.sources))
        if (LEFT_OUT.includes(type))
            delete style.sources[source];
    return style;
}
function drawByCamber(style, view, work) {
    const document = join(work, 'style.json'), picture = join(work, 'drawn.png');
    writeFileSync(document, JSON.stringify(style));
    execFileSync(tool, ['render', '-q', '-f', '--style', document, '--center', view.center.join(','), '--zoom',
        String(view.zoom), '--size', `${WIDTH}x${HEIGHT}`, '-o', picture], {stdio: ['ignore', 'ignore', 'inherit']});
    return readFileSync(picture);
}
async function drawByMapLibre(page, style, view) {
    await page.goto(page.url());
    await page.waitForFunction(() => window.show);
    await page.evaluate(([style, center, zoom]) => window.show(style, center, zoom), [style, view.center, view.zoom]);
    return page.locator('#map').screenshot({type: 'png'});
}
// Both pictures and eight times their difference, side by side.
async function layBeside(page, shown, drawn) {
    const url = await page.evaluate(async pictures => {
        const [a, b] = await Promise.all(pictures.map(async bytes =>
            createImageBitmap(await (await fetch('data:image/png;base64,' + bytes)).blob())));
        const canvas = document.createElement('canvas');
        canvas.width = a.width * 3;
        canvas.height = a.height;
        const context = canvas.getContext('2d');
        context.drawImage(a, 0, 0);
        context.drawImage(b, a.width, 0);
        const [left, right] = [0, a.width].map(x => context.getImageData(x, 0, a.width, a.height));
        for (let i = 0; i < left.data.length; i++)
            left.data[i] = i % 4 === 3 ? 255 : 8 * Math.abs(left.data[i] - right.data[i]);
        context.putImageData(left, 2 * a.width, 0);
        return canvas.toDataURL('image/png');
    }, [shown, drawn].map(bytes => bytes.toString('base64')));
    return Buffer.from(url.split(',')[1], 'base64');
}
async function check(page, name, view, own, work) {
    const all = () => true, bare = layer => layer.type !== 'symbol', differences = [];
    const shown = await drawByMapLibre(page, readStyle(name, view.city, own, all, true), view);
    const plain = await drawByMapLibre(page, readStyle(name, view.city, own, bare, true), view);
    const pictures = [[shown, all, true, ''], [plain, bare, true, '-bare'], [shown, all, false, '-own']];
    for (const [of, keep, byTiles, part] of pictures) {
        const drawn = drawByCamber(readStyle(name, view.city, folder, keep, byTiles), view, work);
        writeFileSync(join(out, `${name}-${view.zoom}${part}.png`), await layBeside(page, of, drawn));
        differences.push((await comparePictures(page, of, drawn)).mean);
    }
    const [most, reason] = EXCEPTIONS[`${name} ${view.zoom}`] ?? [MEAN], [whole, lines, ordered] = differences;
    // A picture that has come to agree must go from the exceptions.
    const right = whole < most && (!reason || whole >= MEAN);
    console.log(`${name}, zoom ${view.zoom}: mean difference ${whole.toFixed(2)}, without labels ${lines.toFixed(2)},` +
        ` in camber's order ${ordered.toFixed(2)}${right ? '' : `: wrong, the limit is ${most}`}` +
        `${reason ? ` (${reason})` : ''}`);
    return right;
}

const work = mkdtempSync(join(tmpdir(), 'camber-styles-')), server = serveFiles(PAGE,
    path => path.startsWith('/modules/') ? join(modules, path.slice(8)) : join(folder, path));
let right = true;
try {
    mkdirSync(out, {recursive: true});
    await new Promise(done => server.listen(0, '127.0.0.1', done));
    const own = `http://127.0.0.1:${server.address().port}`;
    const page = await browser.newPage({viewport: {width: WIDTH, height: HEIGHT}, deviceScaleFactor: 1});
    await page.goto(own);
    for (const name of readdirSync(join(folder, 'styles')).sort())
        for (const view of VIEWS)
            if ((!onlyStyle || name === onlyStyle) && (!onlyCity || view.city === onlyCity))
                right = await check(page, name, view, own, work) && right;
} finally {
    await browser.close();
    server.close();
    rmSync(work, {recursive: true});
}
process.exit(right ? 0 : 1);
