// The page of examples/web in Chromium: mesh tiles that it draws, against the pictures of camber render.
// usage: test_web.mjs CAMBER PAGE INPUT FOLDER
// INPUT has streets around CENTER. npm's playwright-core is found through NODE_PATH, Chromium on PATH. Tiles and
// screenshots stay in FOLDER. Exit status: 1 where a check failed, 77 where something is not installed.
import {execFileSync} from 'node:child_process';
import {mkdirSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {createServer} from 'node:http';
import {join} from 'node:path';
import {comparePictures, launchBrowser, skip, startServe} from './browser.mjs';

const CENTER = [-122.0268, 36.9735]; // Santa Cruz
const WIDE = {width: 1280, height: 720};
// Zooms of tiles and between them; the last one of roads lies past the largest tiles'.
const VIEWS = [['roads', 14], ['roads', 12.3], ['roads', 14.62], ['roads', 15.9], ['lines', 14], ['lines', 14.6],
    ['areas', 13], ['areas', 14.4]];
// Of 255, of all channels: points are rounded, and simplified for the tiles' zoom; areas have four samples a pixel.
const MEAN = {roads: 0.25, lines: 0.25, areas: 0.4};
// Of 255, a pixel's largest channel. A point that is rounded may decide between miter and bevel, and shift a dash.
const WORST = {roads: 128, lines: 255, areas: 96};
const moveFrom = (from, to) =>
    ['interpolate', ['linear'], ['zoom'], 12, ['literal', from], 16, ['literal', to]];
// All that the page draws of lines.
const STYLE = {version: 8, sources: {}, layers: [
    {id: 'ground', type: 'background', paint: {'background-color': '#ffffff'}},
    {id: 'dashes', type: 'line', filter: ['in', 'type', 'residential', 'service'],
        layout: {'line-join': 'miter'}, paint: {'line-color': '#2060c0', 'line-dasharray': [2, 1.3],
            'line-width': ['interpolate', ['linear'], ['zoom'], 12, 3, 16, 9]}},
    {id: 'dots', type: 'line', filter: ['in', 'type', 'footway', 'path'],
        layout: {'line-cap': 'round', 'line-join': 'round'},
        paint: {'line-color': '#c03020', 'line-width': 3, 'line-dasharray': [0, 2]}},
    {id: 'translucent', type: 'line', filter: ['in', 'type', 'primary', 'secondary', 'tertiary'],
        layout: {'line-cap': 'round', 'line-join': 'round'},
        paint: {'line-color': '#20a040', 'line-opacity': 0.5, 'line-width': 9}},
    {id: 'rails', type: 'line', filter: ['in', 'type', 'tertiary', 'motorway'],
        layout: {'line-cap': 'square', 'line-join': 'bevel'},
        paint: {'line-color': '#000000', 'line-gap-width': 12, 'line-width': 2}},
    {id: 'blurred', type: 'line', filter: ['in', 'type', 'motorway', 'trunk'],
        paint: {'line-color': '#a020a0', 'line-blur': 4, 'line-width': 12,
            'line-translate': moveFrom([10, 4], [20, -16])}},
]};
// Its background begins between two zooms of tiles.
const LATE_STYLE = {version: 8, sources: {}, layers: [
    {id: 'ground', type: 'background', minzoom: 12.6, paint: {'background-color': '#204060'}},
    {id: 'shores', type: 'line', filter: ['==', 'kind', 'shore'], paint: {'line-color': '#c0a070', 'line-width': 3}},
]};
const FRAMES = 60;  // of a pan

const [tool, pagePath, input, folder] = process.argv.slice(2);
let failures = 0;
function check(right, what, found = '') {
    console.log(`${right ? 'ok' : 'not ok'} - ${what}${right || found === '' ? '' : `: ${JSON.stringify(found)}`}`);
    failures += !right;
}

// Stars with a hole, and lines along some: neighbours overlap, and tiles' borders cross them.
const AREA_STYLE = {version: 8, sources: {}, layers: [
    {id: 'ground', type: 'background', paint: {
        'background-color': ['interpolate', ['linear'], ['zoom'], 12, '#f6f2ea', 16, '#a0d0c0']}},
    {id: 'lakes', type: 'fill', filter: ['==', 'kind', 'lake'], paint: {'fill-color': '#a6cfdd'}},
    {id: 'woods', type: 'fill', filter: ['==', 'kind', 'wood'],
        paint: {'fill-color': '#70a050', 'fill-opacity': ['interpolate', ['linear'], ['zoom'], 12, 0.9, 15, 0.5]}},
    {id: 'shores', type: 'line', filter: ['==', 'kind', 'shore'], layout: {'line-join': 'round', 'line-cap': 'round'},
        paint: {'line-color': '#305070', 'line-width': 3}},
    {id: 'islands', type: 'fill', filter: ['==', 'kind', 'island'], paint: {
        'fill-color': '#f4d090', 'fill-translate': moveFrom([14, -6], [30, 10])}},
]};
function makeAreas() {
    const features = [], add = (kind, type, coordinates) =>
        features.push({type: 'Feature', properties: {kind}, geometry: {type, coordinates}});
    const ring = (x, y, radius, points) => Array.from({length: points + 1}, (_, i) => {
        const angle = i % points / points * 2 * Math.PI, reach = radius * (i % 2 && i < points ? 0.6 : 1);
        return [x + reach * Math.cos(angle), y + reach * Math.sin(angle) * 0.8];
    });
    for (let i = 0; i < 60; i++) {
        const x = CENTER[0] + 0.09 * (i % 10 / 9 - 0.5), y = CENTER[1] + 0.04 * (Math.floor(i / 10) / 5 - 0.5);
        const outer = ring(x, y, 0.004 + 0.0001 * i, 7 + i % 9), inner = ring(x, y, 0.0015, 12);
        add(['lake', 'wood', 'lake'][i % 3], 'Polygon', [outer, inner.reverse()]);
        if (i % 3 === 0) {
            add('shore', 'LineString', outer);
            add('island', 'Polygon', [ring(x + 0.001, y, 0.001, 5)]);
        }
    }
    return {type: 'FeatureCollection', features};
}

// ---- Tiles in a folder, and a server of files ----

const styleOf = style => style === 'roads' ? style : join(folder, style + '.json');
const inputOf = style => style === 'areas' || style === 'late' ? join(folder, 'areas.geojson') : input;
function makeTiles(style, tiles = join(folder, style), ...more) {
    rmSync(tiles, {recursive: true, force: true});
    execFileSync(tool, ['tiles', '-q', inputOf(style), '--style', styleOf(style), '--format', 'glb', '--tile-size',
        '512', '--min-zoom', '12', '--max-zoom', '15', ...more, '-o', tiles + '/']);
    return tiles;
}

let isBusy = () => false; // a path's name: whether its file cannot be had now
const server = createServer((request, response) => {
    const path = decodeURIComponent(new URL(request.url, 'http://localhost').pathname);
    let bytes = null;
    if (isBusy(path)) {
        response.writeHead(503).end();
        return;
    }
    try {
        bytes = readFileSync(path === '/' ? pagePath : join(folder, path));
    } catch {
        response.writeHead(404).end();
        return;
    }
    response.writeHead(200, {'Content-Type': path === '/' ? 'text/html' : 'application/octet-stream'}).end(bytes);
});
await new Promise(resolve => server.listen(0, '127.0.0.1', resolve));
const url = `http://127.0.0.1:${server.address().port}/`;

// ---- The page ----

const complaints = [];
const hashAt = (zoom, [longitude, latitude] = CENTER) => `#${zoom}/${latitude}/${longitude}`;
async function openPage(browser, style, zoom, options = {}) {
    const context = await browser.newContext({viewport: WIDE, ...options}), page = await context.newPage();
    page.on('console', message => ['error', 'warning'].includes(message.type()) && complaints.push(message.text()));
    page.on('pageerror', error => complaints.push(error.message));
    await page.goto(`${url}?tiles=${style}${hashAt(zoom)}`);
    await waitForTiles(page);
    return page;
}
// All tiles in view are drawn once this says so, in the frame before.
const waitForTiles = page => page.waitForFunction(() => document.body.dataset.loading === '0');
const waitForFrames = (page, count) => page.evaluate(frames => new Promise(resolve => {
    const next = () => frames-- > 0 ? requestAnimationFrame(next) : resolve();
    next();
}), count);
async function shoot(page, name) {
    await page.evaluate(() => document.querySelectorAll('.card').forEach(card => card.style.visibility = 'hidden'));
    return page.screenshot({path: join(folder, name + '.png')});
}

// ---- What is checked ----

// The page's points are those that its tiles have, of half the tolerance of a picture of their zoom: a point more or less
// near the end of a line turns its flat end.
function drawView(style, zoom, tolerance, ...more) {
    const drawn = join(folder, 'drawn.png');
    execFileSync(tool, ['render', '-q', '--no-labels', '-f', inputOf(style), '--style', styleOf(style), '--zoom', String(zoom),
        '--simplify-px', String(tolerance), '--center', CENTER.join(','), '--size', `${WIDE.width}x${WIDE.height}`, ...more,
        '-o', drawn]);
    return readFileSync(drawn);
}
const TILE_PX = 0.05; // of tolerance

async function checkPictures(browser, blank) {
    for (const [style, zoom] of VIEWS) {
        const page = await openPage(browser, style, zoom);
        const shown = await shoot(page, `${style}-${zoom}`);
        const drawn = drawView(style, zoom, TILE_PX * 2 ** (zoom - Math.floor(Math.min(zoom, 15))));
        const found = await comparePictures(blank, shown, drawn);
        console.log(`# ${style}, zoom ${zoom}: mean ${found.mean.toFixed(3)} of 255, worst ${found.most}`);
        check(found.same && found.colors > 50 && found.mean < MEAN[style] && found.most <= WORST[style],
            `${style} at zoom ${zoom} has the pixels of camber render`, found);
        await page.context().close();
    }
}

async function checkMoves(browser) {
    const page = await openPage(browser, 'roads', 14);
    // The hash follows when the map rests.
    const readPlace = async () => {
        await page.waitForFunction(() => !isAsked && glide === 0 && hashTimer === 0);
        return page.evaluate(() => location.hash.slice(1).split('/').map(Number));
    };
    const [, , east] = await readPlace();
    await page.mouse.move(900, 360);
    await page.mouse.down();
    for (let i = 1; i <= FRAMES; i++) {
        await page.mouse.move(900 - 6 * i, 360 + i);
        await waitForFrames(page, 1);
    }
    await page.mouse.up();
    const after = await readPlace(), degree = 512 * 2 ** 14 / 360; // px
    check(Math.abs((after[2] - east) * degree - 6 * FRAMES) < 1, 'a drag moves the map as far as the pointer',
        {east, after});
    await page.mouse.wheel(0, -100);
    await page.waitForFunction(() => view.zoom > 14.2);
    check(Math.abs((await readPlace())[0] - 14.25) < 1e-3, 'the wheel zooms by a quarter', await readPlace());
    await page.focus('#map');
    await page.keyboard.press('-');
    await page.waitForFunction(() => view.zoom < 13.8);
    check(Math.abs((await readPlace())[0] - 13.75) < 1e-3, 'the minus key zooms out', await readPlace());
    await page.evaluate(hash => location.hash = hash, hashAt(12.5));
    await page.waitForFunction(() => document.getElementById('state').textContent.includes('12.50'));
    check(true, 'a hash that is typed moves the map');
    await waitForTiles(page);
    check(complaints.length === 0, 'the console is silent', complaints);
    await page.context().close();
}

// What lies under the pointer stays there while the wheel zooms.
async function checkPointer(browser) {
    const page = await openPage(browser, 'roads', 13);
    const under = () => page.evaluate(() =>
        [view.x + (900 - innerWidth / 2) / worldPx(), view.y + (200 - innerHeight / 2) / worldPx()]);
    const before = await under();
    await page.mouse.move(900, 200);
    await page.mouse.wheel(0, -240);
    await page.waitForFunction(() => view.zoom > 13.5 && glide === 0);
    const after = await under(), off = Math.hypot(after[0] - before[0], after[1] - before[1]) * 512 * 2 ** 13;
    check(off < 1e-3, 'the wheel zooms about the pointer', {before, after});
    await page.context().close();
}

// A screen with two px a CSS px gets as many, from tiles that were made for one and for two.
async function checkDensity(browser, blank) {
    makeTiles('roads', join(folder, 'dense'), '--ratio', '2');
    for (const [tiles, tolerance] of [['roads', 2 * TILE_PX], ['dense', TILE_PX]]) {
        const page = await openPage(browser, tiles, 14, {deviceScaleFactor: 2});
        const zooms = await page.evaluate(() => [...tiles.keys()].map(name => parseInt(name)));
        const found = await comparePictures(blank, await shoot(page, tiles + '-2'),
            drawView('roads', 14, tolerance, '--ratio', '2'));
        console.log(`# two px a CSS px, ${tiles}: mean ${found.mean.toFixed(3)} of 255, worst ${found.most}`);
        check(found.same && found.mean < MEAN.roads && found.most <= WORST.roads && zooms.every(z => z === 14),
            `so has a picture of twice the px, from tiles in ${tiles}`, {found, zooms});
        await page.context().close();
    }
}

// Where the map rests, nothing is copied but a tile that comes; a canvas that was made anew gets all.
async function checkRest(browser, blank) {
    const page = await openPage(browser, 'roads', 14), before = await shoot(page, 'rest');
    const copies = await page.evaluate(() => {
        const copy = gl.blitFramebuffer, counts = [];
        let count = 0;
        gl.blitFramebuffer = (...all) => {
            count++;
            copy.apply(gl, all);
        };
        const [, entry] = [...tiles].find(([, one]) => one.tile && one.seen === frame);
        for (const change of [() => {}, () => entry.key = '', fitCanvas]) {
            count = 0;
            change();
            drawFrame();
            counts.push(count);
        }
        return counts;
    });
    const found = await comparePictures(blank, await shoot(page, 'rest-again'), before);
    check(copies[0] === 0 && copies[1] === 1 && copies[2] > 3, 'where the map rests, what is there stays', copies);
    check(found.same && found.off === 0, 'and is as before', found);
    await page.context().close();
}

async function checkBackground(browser) {
    makeTiles('late');
    complaints.length = 0;
    for (const [zoom, color] of [[12.3, [246, 242, 234]], [12.9, [32, 64, 96]], [14, [32, 64, 96]]]) {
        const page = await openPage(browser, 'late', zoom);
        const found = await page.evaluate(() => background.map(value => Math.round(255 * value)));
        check(found.join() === color.join() && complaints.length === 0,
            `a background that begins at zoom 12.6 is right at ${zoom}`, {found, complaints});
        await page.context().close();
    }
}

// A server that is busy: the page says so, and asks again.
async function checkSubtrees(browser) {
    isBusy = path => path.endsWith('.subtree');
    const page = await openPage(browser, 'roads', 14), told = await page.locator('#notice').textContent();
    check(/is missing: subtree .*: 503/.test(told), 'subtrees that cannot be had are told', told);
    isBusy = () => false;
    await page.waitForFunction(() => document.getElementById('notice').textContent === '');
    const state = await page.locator('#state').textContent();
    check(/ [1-9][0-9]* tiles/.test(state), 'and asked for again', state);
    await page.context().close();
}

// What is forgotten is freed, also where it comes later, and nothing newer of that name is.
async function checkMemory(browser) {
    const page = await openPage(browser, 'roads', 14);
    const found = await page.evaluate(async () => {
        const [name] = [...tiles].find(([, entry]) => entry.tile), place = name.split('/').map(Number);
        const create = gl.createTexture, free = gl.deleteTexture, read = readElements, isRight = [];
        let live = 0;
        gl.createTexture = () => {
            live++;
            return create.call(gl);
        };
        gl.deleteTexture = texture => {
            live -= texture !== null;
            free.call(gl, texture);
        };
        const bytes = await (await fetch(`${base}${name}.glb`)).arrayBuffer();
        readElements = () => {
            throw new Error('full');
        };
        try {
            makeTile(bytes);
        } catch (error) {
            isRight.push(error.message === 'full' && live === 0);
        }
        readElements = read;
        for (const isAborted of [false, true]) {
            forget(name, tiles.get(name));
            live = 0;
            const old = tileAt(...place);
            forget(name, old);
            if (isAborted)
                old.abort.abort();
            const newer = tileAt(...place);
            while (newer.state !== 'ready')
                await new Promise(resolve => setTimeout(resolve, 20));
            await new Promise(resolve => setTimeout(resolve, 300)); // for the old one to come late
            isRight.push(tiles.get(name) === newer && newer.state === 'ready' && !old.tile && !old.picture);
        }
        return [...isRight, performance.getEntriesByType('measure').length === 0];
    });
    check(found.length === 4 && found.every(right => right), 'what is forgotten is freed', found);
    await page.context().close();
}

async function checkDamage(browser) {
    const tiles = makeTiles('roads'), page = await openPage(browser, 'roads', 14);
    const [first, second, third] = await page.evaluate(() => [...tiles.entries()].filter(([, entry]) => entry.tile).
        map(([name]) => name));
    await page.context().close();
    const whole = readFileSync(join(tiles, first + '.glb'));
    writeFileSync(join(tiles, first + '.glb'), whole.subarray(0, whole.length >> 1));
    rmSync(join(tiles, second + '.glb'));
    const noise = readFileSync(join(tiles, third + '.glb'));
    noise.fill(0x7f, 20, 40);
    writeFileSync(join(tiles, third + '.glb'), noise);
    complaints.length = 0;
    const hurt = await openPage(browser, 'roads', 14), told = await hurt.locator('#notice').textContent();
    await hurt.screenshot({path: join(folder, 'damage.png')});
    check(told.includes(`${first} is damaged`) && told.includes(`${third} is damaged`), 'damaged tiles are told', told);
    check(told.includes(`${second} is missing`), 'a missing one is told', told);
    check(complaints.every(text => text.includes('404')) && complaints.length === 1, 'nothing else goes wrong',
        complaints);
    const drawn = await hurt.evaluate(() => [...tiles.values()].filter(entry => entry.tile).length);
    check(drawn > 3, 'all others are drawn', drawn);
    await hurt.context().close();
}

// The same tiles from camber serve, at another address.
async function checkServe(browser) {
    complaints.length = 0;
    const {url: at, stop} = await startServe(tool, [makeTiles('roads') + '/']);
    if (at === null)
        return;
    const page = await openPage(browser, encodeURIComponent(at + '/tiles.json'), 14);
    const state = await page.locator('#state').textContent(), told = await page.locator('#notice').textContent();
    check(/ [1-9][0-9]* tiles/.test(state) && told === '' && complaints.length === 0,
        'camber serve hands out the tiles', {state, told, complaints});
    await page.context().close();
    await stop();
}

async function checkNoTiles(browser) {
    const page = await (await browser.newContext()).newPage();
    await page.goto(`${url}?tiles=nowhere`);
    await page.waitForFunction(() => document.getElementById('notice').textContent !== '');
    const told = await page.locator('#notice').textContent();
    check(/No tiles at .*nowhere/.test(told), 'a page without tiles says so', told);
    await page.context().close();
}

// ---- All of it ----

// Mesa's driver, as camber's own GL has it: Chromium's own takes ten times as long.
const browser = await launchBrowser('--use-gl=angle', '--use-angle=gl-egl');
mkdirSync(folder, {recursive: true});
writeFileSync(join(folder, 'lines.json'), JSON.stringify(STYLE));
writeFileSync(join(folder, 'areas.json'), JSON.stringify(AREA_STYLE));
writeFileSync(join(folder, 'late.json'), JSON.stringify(LATE_STYLE));
writeFileSync(join(folder, 'areas.geojson'), JSON.stringify(makeAreas()));
try {
    const blank = await browser.newPage();
    if (!await blank.evaluate(() => !!document.createElement('canvas').getContext('webgl2'))) {
        await browser.close();
        skip('no WebGL 2 by EGL (Debian: libegl-mesa0, libgl1-mesa-dri)');
    }
    for (const style of new Set(VIEWS.map(([style]) => style)))
        makeTiles(style);
    await checkPictures(browser, blank);
    await checkMoves(browser);
    await checkPointer(browser);
    await checkDensity(browser, blank);
    await checkRest(browser, blank);
    await checkBackground(browser);
    await checkMemory(browser);
    await checkSubtrees(browser);
    await checkDamage(browser);
    await checkServe(browser);
    await checkNoTiles(browser);
} finally {
    await browser.close();
    server.close();
}
process.exit(failures ? 1 : 0);
