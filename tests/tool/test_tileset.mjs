// A tileset of mesh tiles in 3d-tiles-renderer (three.js) and Chromium. usage: test_tileset.mjs CAMBER INPUT FOLDER
// npm's three, 3d-tiles-renderer and playwright-core are found through NODE_PATH, Chromium on PATH. The screenshot stays in
// FOLDER. Exit status: 1 where a check failed, 77 where something is not installed.
import {execFileSync} from 'node:child_process';
import {existsSync, mkdirSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {createServer} from 'node:http';
import {extname, join, normalize} from 'node:path';
import {launchBrowser, startServe} from './browser.mjs';

const SIZE = {width: 512, height: 512}, ZOOM = 13; // MapLibre's: tiles of 256 px have one more
const [tool, input, folder] = process.argv.slice(2), modules = process.env.NODE_PATH ?? '';
let failures = 0;
function check(right, what, found = '') {
    console.log(`${right ? 'ok' : 'not ok'} - ${what}${right || found === '' ? '' : `: ${JSON.stringify(found)}`}`);
    failures += !right;
}
const browser = await launchBrowser('three', '3d-tiles-renderer');

// The camera looks down on the middle of a tile of the lowest zoom that has a city, from where a px of the screen is one
// of the tile.
const center = [-122.0268, 36.9735], world = 40075016.685578488;
const east = center[0] / 360 * world, north = Math.asinh(Math.tan(center[1] * Math.PI / 180)) / Math.PI / 2 * world;
const metres = world / 512 / 2 ** ZOOM * SIZE.height;
const page = `<!doctype html><meta charset="utf-8"><style>body{margin:0}canvas{display:block}</style>
<script type="importmap">{"imports":{"three":"/npm/three/build/three.module.js","three/":"/npm/three/",
"three/addons/":"/npm/three/examples/jsm/","3d-tiles-renderer/three":"/npm/3d-tiles-renderer/build/index.three.js",
"3d-tiles-renderer/core":"/npm/3d-tiles-renderer/build/index.core.js",
"3d-tiles-renderer/core/plugins":"/npm/3d-tiles-renderer/build/index.core-plugins.js",
"3d-tiles-renderer/three/plugins":"/npm/3d-tiles-renderer/build/index.three-plugins.js"}}</script>
<script type="module">
import {OrthographicCamera, Scene, Color, WebGLRenderer} from 'three';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';
import {MeshoptDecoder} from 'three/addons/libs/meshopt_decoder.module.js';
import {TilesRenderer} from '3d-tiles-renderer/three';
import {ImplicitTilingPlugin} from '3d-tiles-renderer/core/plugins';
const renderer = new WebGLRenderer({antialias: true, preserveDrawingBuffer: true});
renderer.setSize(${SIZE.width}, ${SIZE.height});
document.body.append(renderer.domElement);
const scene = new Scene(), half = ${metres} / 2;
scene.background = new Color('#ffffff');
const camera = new OrthographicCamera(-half, half, half, -half, 1, 20000);
camera.position.set(${east}, ${north}, 10000);
const tiles = new TilesRenderer(new URLSearchParams(location.search).get('tiles') ?? '/tiles/tileset.json');
const loader = new GLTFLoader(tiles.manager);
loader.setMeshoptDecoder(MeshoptDecoder);
tiles.manager.addHandler(/\\.(gltf|glb)$/g, loader);
tiles.registerPlugin(new ImplicitTilingPlugin());
window.errors = [];
window.models = 0;
tiles.addEventListener('load-error', ({url, error}) => window.errors.push(String(url) + ' ' + error));
tiles.addEventListener('load-model', () => window.models++);
tiles.setCamera(camera);
scene.add(tiles.group);
// Lines of tiles meet at borders, so pixels depend on the order of tiles: here on their places, not on what came first.
const order = (a, b) => a.renderOrder - b.renderOrder || place(a, 12) - place(b, 12) || place(a, 13) - place(b, 13) || a.id - b.id;
const place = (item, i) => Math.round(item.object.matrixWorld.elements[i]);
renderer.setOpaqueSort(order);
renderer.setTransparentSort(order);
window.idle = 0; // frames since something was loading
let models = 0;
renderer.setAnimationLoop(() => {
    camera.updateMatrixWorld();
    tiles.setResolutionFromRenderer(camera, renderer);
    tiles.update();
    renderer.render(scene, camera);
    // Children are asked for in a frame after their parents are there.
    const loading = tiles.stats.downloading + tiles.stats.parsing + (tiles.stats.queued ?? 0) > 0;
    window.idle = loading || window.models !== models ? 0 : window.idle + 1;
    models = window.models;
    window.visible = tiles.visibleTiles.size;
});
</script>`;
rmSync(folder, {recursive: true, force: true});
mkdirSync(folder, {recursive: true});
const drawn = join(folder, 'tiles/');
execFileSync(tool, ['tiles', input, '--format', 'glb', '--min-zoom', '10', '--max-zoom', '14', '-q', '-o', drawn]);
const types = {'.js': 'text/javascript', '.json': 'application/json', '.html': 'text/html'}, missing = [];
const server = createServer((request, response) => {
    const path = normalize(new URL(request.url, 'http://localhost').pathname);
    const file = path.startsWith('/npm/') ? join(modules, path.slice(4)) : join(folder, path);
    if (path !== '/' && !existsSync(file)) {
        if (path !== '/favicon.ico')
            missing.push(path);
        response.writeHead(path === '/favicon.ico' ? 204 : 404).end();
        return;
    }
    response.writeHead(200, {'content-type': path === '/' ? 'text/html' : types[extname(path)] ?? 'application/octet-stream'});
    response.end(path === '/' ? page : readFileSync(file));
}).listen(0, '127.0.0.1');
await new Promise(resolve => server.on('listening', resolve));

async function look(tab, tileset, from) {
    const said = [];
    tab.on('console', message => ['error', 'warning'].includes(message.type()) && said.push(message.text()));
    tab.on('pageerror', error => said.push(String(error)));
    await tab.goto(`http://127.0.0.1:${server.address().port}/${tileset}`);
    await tab.waitForFunction(() => window.models > 0 && window.visible > 0 && window.idle > 30)
        .catch(error => said.push(String(error)));
    const shown = await tab.screenshot();
    const state = await tab.evaluate(() => ({errors: window.errors, models: window.models, visible: window.visible}));
    check(state.models > 0 && state.visible > 0, `tiles ${from} are loaded and seen`, state);
    check(state.errors?.length === 0, 'without an error', state.errors);
    const own = said.filter(text => !/limited support|GPU stall|GL Driver Message/.test(text));
    check(own.length === 0, 'and nothing is said on the console', own.slice(0, 5));
    check(missing.length === 0, 'all that is asked for is there', missing.slice(0, 5));
    return shown;
}
const tab = await browser.newPage({viewport: SIZE}), shown = await look(tab, '', 'of a folder');
writeFileSync(join(folder, 'tileset.png'), shown);
const {url: served, stop} = await startServe(tool, [drawn]);
if (served !== null) {
    const other = await browser.newPage({viewport: SIZE});
    const again = await look(other, '?tiles=' + encodeURIComponent(served + '/tileset.json'), 'of camber serve');
    check(again.equals(shown), 'and look the same');
    await other.close();
    await stop();
}

// Lines are where camber draws them: of the pixels that it colours most are coloured, and few others.
const drawing = join(folder, 'drawn.png');
execFileSync(tool, ['render', input, '--no-labels', '--center', center.join(), '--zoom', String(ZOOM), '--size',
    `${SIZE.width}x${SIZE.height}`, '-q', '-o', drawing]);
const counts = await tab.evaluate(async pictures => {
    const [a, b] = await Promise.all(pictures.map(async bytes => {
        const image = await createImageBitmap(new Blob([Uint8Array.from(atob(bytes), c => c.charCodeAt(0))]));
        const canvas = new OffscreenCanvas(image.width, image.height).getContext('2d');
        canvas.drawImage(image, 0, 0);
        return canvas.getImageData(0, 0, image.width, image.height);
    }));
    let lines = 0, both = 0, others = 0;
    const orange = (data, i) => data[i] - data[i + 2] > 100; // primary and larger roads are the only ones that are
    const near = (data, x, y) => [-1, 0, 1].some(dy => [-1, 0, 1].some(dx => {
        const at = 4 * ((y + dy) * a.width + x + dx);
        return x + dx >= 0 && x + dx < a.width && y + dy >= 0 && y + dy < a.height && orange(data, at);
    }));
    for (let y = 0; y < a.height; y++)
        for (let x = 0; x < a.width; x++) {
            const at = 4 * (y * a.width + x);
            if (orange(b.data, at)) {
                lines++;
                both += near(a.data, x, y);
            } else if (orange(a.data, at)) {
                others += !near(b.data, x, y);
            }
        }
    return {lines, both, others};
}, [shown.toString('base64'), readFileSync(drawing).toString('base64')]);
check(counts.lines > 1000 && counts.both > 0.95 * counts.lines, 'main roads are where camber draws them', counts);
check(counts.others < 0.05 * counts.lines, 'and nowhere else', counts);
await browser.close();
server.close();
process.exit(failures ? 1 : 0);
