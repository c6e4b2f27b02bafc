// The tiles of camber tiles and of camber serve, shown by MapLibre GL JS and by OpenLayers in Chromium, against the
// picture that camber render draws.
// usage: test_maps.mjs CAMBER INPUT FOLDER
// npm's maplibre-gl, ol, pmtiles and playwright-core are found through NODE_PATH, Chromium on PATH. Of each view a map
// shows tiles pixel by pixel: its centre is a corner of tiles, and its zoom theirs. Pictures of views that fail stay in
// FOLDER. Exit status: 1 where they differ, 77 where something is not installed.
import {execFileSync} from 'node:child_process';
import {mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {comparePictures, cornerAt, launchBrowser, serveFiles, startServe} from './browser.mjs';

const SIDE = 768, TILE = 256, CENTER = [-122.0268, 36.9735], ZOOMS = [12, 14, 15];
// camber's own promise across the pictures that tiles are cut from. The map shows texels as they are: nothing is added.
const LEVELS = 1;

const [tool, input, folder] = process.argv.slice(2);
const modules = process.env.NODE_PATH ?? '';
const browser = await launchBrowser('maplibre-gl', 'ol', 'pmtiles');

// ---- What the browser asks for ----

const PAGE = `<!doctype html><style>body { margin: 0 } #map { width: ${SIDE}px; height: ${SIDE}px }</style>
<div id="map"></div>
<script src="/pmtiles/dist/pmtiles.js"></script>
<script src="/ol/dist/ol.js"></script>
<script type="module">
import * as maplibre from '/maplibre-gl/dist/maplibre-gl.mjs';
maplibre.addProtocol('pmtiles', new pmtiles.Protocol().tile);
function showByMapLibre(url, center, zoom) {
    return new Promise((resolve, reject) => {
        const map = new maplibre.Map({
            container: 'map', center, zoom, interactive: false, attributionControl: false, fadeDuration: 0,
            style: {version: 8, sources: {city: {type: 'raster', url, tileSize: ${TILE}}},
                layers: [{id: 'city', type: 'raster', source: 'city', paint: {'raster-fade-duration': 0}}]}});
        map.on('error', event => reject(event.error));
        map.on('idle', () => resolve());
    });
}
function showByOpenLayers(url, center, zoom) {
    return new Promise((resolve, reject) => {
        const source = new ol.source.TileJSON({url, crossOrigin: 'anonymous', transition: 0});
        source.on('tileloaderror', () => reject(new Error('a tile is not loaded')));
        const map = new ol.Map({target: 'map', controls: [], interactions: [], pixelRatio: 1,
            layers: [new ol.layer.Tile({source})],
            view: new ol.View({center: ol.proj.fromLonLat(center), zoom: zoom + 1})});
        map.on('rendercomplete', () => source.getState() === 'ready' && resolve());
    });
}
window.show = {maplibre: showByMapLibre, openlayers: showByOpenLayers};
</script>`;


// ---- The views ----

async function check(page, work, zoom, maps) {
    const center = cornerAt(CENTER, zoom), drawn = join(work, 'drawn.png');
    execFileSync(tool, ['render', '-q', '-f', input, '--center', center.map(value => value.toFixed(12)).join(','), '--zoom',
        String(zoom), '--size', `${SIDE}x${SIDE}`, '-o', drawn]);
    let all = true;
    for (const [name, map, url] of maps) {
        await page.goto(page.url());
        await page.waitForFunction(() => window.show);
        await page.evaluate(([by, from, place, at]) => window.show[by](from, place, at), [map, url, center, zoom]);
        const shown = await page.locator('#map').screenshot({type: 'png'});
        const found = await comparePictures(page, shown, readFileSync(drawn));
        console.log(`${name}, zoom ${zoom}: ${found.off} of ${SIDE * SIDE} pixels differ, by ${found.most} of 255 at ` +
            `most; ${found.colors} colours`);
        // A picture with no streets would be equal too.
        const right = found.same && found.most <= LEVELS && found.colors > 100;
        all = all && right;
        if (!right) {
            mkdirSync(folder, {recursive: true});
            writeFileSync(join(folder, `${name}-${zoom}.png`), shown);
            writeFileSync(join(folder, `drawn-${zoom}.png`), readFileSync(drawn));
        }
    }
    return all;
}

const work = mkdtempSync(join(tmpdir(), 'camber-maps-'));
const server = serveFiles(PAGE, path => path === '/city.pmtiles' ? join(work, 'city.pmtiles') : join(modules, path)),
    served = await startServe(tool, [input]);
let right = true;
try {
    // With empty tiles: else the page shows through where there is the background alone.
    execFileSync(tool, ['tiles', '-q', input, '-o', join(work, 'city.pmtiles'), '--min-zoom', '13', '--max-zoom', '16',
        '--keep-empty']);
    await new Promise(resolve => server.listen(0, '127.0.0.1', resolve));
    const own = `http://127.0.0.1:${server.address().port}/`;
    const maps = [['MapLibre of an archive', 'maplibre', `pmtiles://${own}city.pmtiles`]];
    if (served.url)
        maps.push(['MapLibre of a server', 'maplibre', `${served.url}/tiles.json`],
            ['OpenLayers of a server', 'openlayers', `${served.url}/tiles.json`]);
    const page = await browser.newPage({viewport: {width: SIDE, height: SIDE}, deviceScaleFactor: 1});
    await page.goto(own);
    for (const zoom of ZOOMS)
        right = await check(page, work, zoom, maps) && right;
} finally {
    await browser.close();
    server.close();
    await served.stop();
    rmSync(work, {recursive: true});
}
process.exit(right ? 0 : 1);
