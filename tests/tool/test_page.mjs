// The page of camber serve in Chromium: what a person does with it.
// usage: test_page.mjs CAMBER INPUT FOLDER
// INPUT has streets around CENTER. npm's playwright-core is found through NODE_PATH, Chromium on PATH. Screenshots stay
// in FOLDER. Exit status: 1 where a check failed, 77 where something is not installed.
import {execFileSync} from 'node:child_process';
import {mkdirSync, readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {comparePictures, cornerAt, findPort, launchBrowser, PATIENCE_MS, skip, startServe} from './browser.mjs';

const CENTER = [-122.0268, 36.9735]; // Santa Cruz
const SEA = [-122.1, 36.952];          // near it, in the bounds of INPUT
const town = fileURLToPath(new URL('../data/monaco/monaco.osm.pbf', import.meta.url));
const TOWN_CENTER = [7.4235, 43.7365], TOWN_ZOOM = 15;
const OFF_EDGES = 200; // pixels of lines that turn back outside a tile, which may differ by more than a level
const DRAWN = ['--layer', 'roads']; // tiles of an archive would be served as they are
const WIDE = {width: 1280, height: 720}, PHONE = {width: 360, height: 740};
const ZOOM = 14;
const LEVELS = 1;     // as of tiles and pictures everywhere; the browser adds nothing
const CONTRAST = 4.5; // WCAG's AA, for small text
const FINGER_PX = 44;
const STEP_PX = 4;    // that begins a drag

const [tool, input, folder] = process.argv.slice(2);
let failures = 0;
function check(right, what, found = '') {
    console.log(`${right ? 'ok' : 'not ok'} - ${what}${right || found === '' ? '' : `: ${JSON.stringify(found)}`}`);
    failures += !right;
}

// ---- The server ----

async function startServer(...options) {
    return startServerAt(0, ...options);
}
async function startServerAt(port, ...options) {
    const {url, ...server} = await startServe(tool, options, port);
    return {url: url + '/', ...server};
}

// ---- The page ----

// Runs in the page. The share of the window under loaded tiles of the map's own zoom, each place counted once.
function coverWindow() {
    const seen = new Map();
    for (const tile of document.querySelectorAll('img.leaflet-tile-loaded')) {
        const box = tile.getBoundingClientRect();
        if (tile.naturalWidth && Math.abs(box.width - tile.width) < 0.5) // others are stretched from another zoom
            seen.set(`${box.left},${box.top}`, Math.max(0, Math.min(box.right, innerWidth) - Math.max(box.left, 0)) *
                Math.max(0, Math.min(box.bottom, innerHeight) - Math.max(box.top, 0)));
    }
    return [...seen.values()].reduce((sum, area) => sum + area, 0) / (innerWidth * innerHeight);
}
const complaints = [];
async function openPage(browser, url, options = {}) {
    const context = await browser.newContext({viewport: WIDE, colorScheme: 'light', reducedMotion: 'reduce',
        ...options});
    const page = await context.newPage();
    page.on('console', message => ['error', 'warning'].includes(message.type()) && complaints.push(message.text()));
    page.on('pageerror', error => complaints.push(error.message));
    page.on('dialog', dialog => complaints.push('a dialog: ' + dialog.message()));
    await context.addInitScript(`window.coverWindow = ${coverWindow}`);
    await page.goto(url);
    await waitForTiles(page);
    return page;
}
const waitForTiles = page => page.waitForFunction(() => coverWindow() > 0.999);
const hashAt = ([longitude, latitude], zoom = ZOOM) => `#${zoom}/${latitude}/${longitude}`;
const readPlace = page => page.evaluate(() => location.hash.slice(1).split('/').map(Number));
const waitForFrames = page => page.evaluate(() => new Promise(resolve =>
    requestAnimationFrame(() => requestAnimationFrame(resolve))));
// Leaflet 1.7 forgets the first step, and each moves the map in the next frame: before that, the last steps are left out.
async function drag(page, dx, dy) {
    const {width, height} = page.viewportSize(), x = (width - dx) / 2, y = (height - dy) / 2;
    await page.mouse.move(x - STEP_PX * Math.sign(dx), y - STEP_PX * Math.sign(dy));
    await page.mouse.down();
    await page.mouse.move(x, y);
    await page.mouse.move(x + dx, y + dy, {steps: 8});
    await waitForFrames(page);
    await page.mouse.up();
}
// Whether the map gets to one of those zooms.
const reaches = (page, ...zooms) => page.waitForFunction(wanted => wanted.some(zoom =>
    location.hash.startsWith(`#${zoom}/`)), zooms).then(() => true, () => false);
const shoot = (page, name) => page.screenshot({path: join(folder, name + '.png')});

// ---- What is checked ----

async function checkFirstView(page) {
    check(await page.title() !== '', 'it has a title');
    check(await page.locator('#length').textContent() !== '', 'it has a scale');
    check(/° N, .*° [EW]/.test(await page.locator('#place').textContent()), 'it tells where its middle is');
    check(await page.locator('#zoom').textContent() === `zoom ${ZOOM}`, 'it tells its zoom');
    const policy = await page.evaluate(() => fetch('').then(answer => answer.headers.get('Content-Security-Policy')));
    check(/default-src 'none'/.test(policy) && !/unsafe/.test(policy), 'its policy allows nothing inline', policy);
    const licence = await page.evaluate(() => fetch('page/leaflet-LICENSE.txt').then(answer => answer.text()));
    check(/Redistribution and use in source and binary/.test(licence), "Leaflet's licence is beside it");
}

async function checkPixels(page, blank, url, what) {
    const corner = cornerAt(CENTER, ZOOM), drawn = join(folder, 'drawn.png');
    await page.goto(url + hashAt(corner));
    await page.reload(); // another hash alone loads nothing
    await waitForTiles(page);
    execFileSync(tool, ['render', '-q', '-f', input, ...DRAWN, '--zoom', String(ZOOM), '--center',
        corner.map(value => value.toFixed(12)).join(','), '--size', `${WIDE.width}x${WIDE.height}`, '-o', drawn]);
    await page.evaluate(() => document.querySelectorAll('.card').forEach(card => card.style.visibility = 'hidden'));
    const found = await comparePictures(blank, await shoot(page, 'shown'), readFileSync(drawn));
    check(found.same && found.most <= LEVELS && found.colors > 100, `${what} the pixels of camber render`, found);
    await page.reload();
    await waitForTiles(page);
}

async function checkMoves(page) {
    const before = await readPlace(page);
    await drag(page, -300, 100);
    await page.waitForFunction(east => Number(location.hash.split('/')[2]) > east, before[2]);
    await waitForTiles(page);
    const after = await readPlace(page), degree = 512 * 2 ** ZOOM / 360; // px
    check(Math.abs((after[2] - before[2]) * degree - 300) < STEP_PX + 1 && after[1] > before[1] && after[0] === ZOOM,
        'a drag of 300 px moves it by as much', {before, after});
    for (const [what, change, act] of [
        ['the wheel zooms in', 1, () => page.mouse.wheel(0, -100)],
        ['the wheel zooms out', -1, () => page.mouse.wheel(0, 100)],
        ['the plus button zooms in', 1, () => page.click('#zoom-in')],
        ['the minus button zooms out', -1, () => page.click('#zoom-out')],
        ['the plus key zooms in', 1, () => page.focus('#map').then(() => page.keyboard.press('+'))],
        ['the minus key zooms out', -1, () => page.keyboard.press('-')],
    ]) {
        const [zoom] = await readPlace(page);
        await act();
        check(await reaches(page, zoom + change), what);
        await waitForTiles(page);
    }
    const [, , east] = await readPlace(page);
    await page.keyboard.press('ArrowRight');
    await page.waitForFunction(from => Number(location.hash.split('/')[2]) > from, east);
    check(true, 'the right arrow moves it east');
}

// The view that the page shows: the place of a tile in the window tells it to the pixel.
function findView(page) {
    return page.evaluate(() => {
        const tile = [...document.querySelectorAll('img.leaflet-tile-loaded')].find(one =>
            Math.abs(one.getBoundingClientRect().width - one.width) < 0.5);
        const [zoom, column, row] = tile.src.match(/(\d+)\/(\d+)\/(\d+)(@2x)?\.png/).slice(1, 4).map(Number);
        const box = tile.getBoundingClientRect(), world = 256 * 2 ** zoom;
        const x = (256 * column - box.left + innerWidth / 2) / world, y = (256 * row - box.top + innerHeight / 2) / world;
        return {zoom: zoom - 1, center: [x * 360 - 180, Math.atan(Math.sinh((1 - 2 * y) * Math.PI)) * 180 / Math.PI]};
    });
}

// A town with names: while it moves, zooms and gets dark, the window shows what camber render draws of the same view.
async function checkLabels(browser, blank) {
    const server = await startServer(town);
    const page = await openPage(browser, server.url + hashAt(TOWN_CENTER, TOWN_ZOOM));
    const compare = async (name, theme) => {
        await waitForTiles(page);
        const {zoom, center} = await findView(page), drawn = [[], ['--no-labels']].map(more => {
            const file = join(folder, `labels-${name}-drawn.png`);
            execFileSync(tool, ['render', '-q', '-f', town, '--theme', theme, '--zoom', String(zoom), '--center',
                center.map(value => value.toFixed(12)).join(','), '--size', `${WIDE.width}x${WIDE.height}`, '-o', file,
                ...more]);
            return readFileSync(file);
        }).reverse();
        await page.evaluate(() => {
            document.activeElement.blur(); // the map shows that it has the focus
            document.querySelectorAll('.card').forEach(card => card.style.visibility = 'hidden');
        });
        const shown = await shoot(page, `labels-${name}`), names = await comparePictures(blank, ...drawn);
        await page.evaluate(() => document.querySelectorAll('.card').forEach(card => card.style.visibility = ''));
        const found = await comparePictures(blank, shown, drawn[1]);
        check(found.same && found.wide === 0 && found.off <= OFF_EDGES && names.off > 5000,
            `${name}: the map and its names are those of camber render`, {zoom, center, names: names.off, ...found});
    };
    await compare('opened', 'light');
    await drag(page, -310, 170);
    await compare('moved', 'light');
    for (const [name, wheel, zoom] of [['nearer', -100, TOWN_ZOOM + 1], ['farther', 100, TOWN_ZOOM], ['far', 100, TOWN_ZOOM - 1]]) {
        await page.mouse.move(WIDE.width / 2 + 130, WIDE.height / 2 - 70);
        await page.mouse.wheel(0, wheel);
        await reaches(page, zoom);
        await compare(name, 'light');
    }
    await page.click('#theme');
    await waitForTheme(page, true);
    await compare('dark', 'dark');
    await drag(page, 205, -90);
    await compare('dark-moved', 'dark');
    await page.context().close();
    await server.stop();
}

async function checkHash(page, url) {
    const place = await page.evaluate(() => location.hash);
    await page.reload();
    await waitForTiles(page);
    check(await page.evaluate(() => location.hash) === place, 'a reload keeps the place');
    await page.goto('about:blank');
    await page.goBack();
    await waitForTiles(page);
    check(await page.evaluate(() => location.hash) === place, 'Back keeps the place');
    await page.goto(url + hashAt(CENTER, ZOOM - 1));
    await page.waitForFunction(zoom => document.getElementById('zoom').textContent === `zoom ${zoom}`, ZOOM - 1);
    check(true, 'a hash that is typed moves the map');
    await page.goto(url + hashAt(CENTER, ZOOM - 0.5));
    await page.locator('#zoom', {hasText: String(ZOOM - 0.5)}).waitFor();
    check((await readPlace(page))[0] === ZOOM - 0.5, 'the map moves to a zoom between two', await readPlace(page));
    await page.reload();
    await page.waitForFunction(() => document.querySelector('img.leaflet-tile-loaded'));
    check((await readPlace(page))[0] === ZOOM - 0.5, 'and opens there', await readPlace(page));
    await shoot(page, 'between-zooms');
    await page.goto(url + '#x/<b>/1');
    await page.reload();
    await page.waitForFunction(() => /^#\d/.test(location.hash));
    check(true, 'a hash that is no place is as none');
    await page.goto(url + hashAt(CENTER));
}

async function waitForTheme(page, dark) {
    await page.waitForFunction(wanted => [...document.querySelectorAll('img.leaflet-tile')].every(tile =>
        tile.src.includes('/dark/') === wanted), dark);
    await waitForTiles(page);
}
async function checkTheme(page) {
    await page.click('#theme');
    await waitForTheme(page, true);
    const ground = () => page.evaluate(() => getComputedStyle(document.getElementById('map')).backgroundColor);
    check(await ground() === 'rgb(16, 20, 28)', 'a button makes it dark', await ground());
    await page.reload();
    await waitForTiles(page);
    await shoot(page, 'dark');
    check(await ground() === 'rgb(16, 20, 28)', 'a reload keeps it dark');
    check((await page.locator('#tilejson-url').inputValue()).endsWith('/dark/tiles.json'), 'so is its TileJSON');
    await checkContrast(page, 'dark');
    await page.click('#theme');
    await waitForTheme(page, false);
    await page.emulateMedia({colorScheme: 'dark'});
    await page.waitForFunction(() => document.documentElement.dataset.theme === 'dark');
    await page.emulateMedia({colorScheme: 'light'});
    await page.waitForFunction(() => document.documentElement.dataset.theme === 'light');
    check(true, "without a choice it follows the system's");
    await waitForTiles(page);
    await checkContrast(page, 'light');
}

// Of each text on a card, over black tiles and over white ones.
async function checkContrast(page, theme) {
    await page.click('#use');
    const poor = await page.evaluate(([least, texts]) => {
        const parse = color => color.match(/[\d.]+/g).map(Number);
        const linear = value => value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
        const light = color => [0.2126, 0.7152, 0.0722].reduce((sum, part, i) =>
            sum + part * linear(color[i] / 255), 0);
        const found = [];
        for (const text of document.querySelectorAll(texts)) {
            const [r, g, b, a = 1] = parse(getComputedStyle(text.closest('.card')).backgroundColor);
            for (const below of [0, 255]) {
                const ground = light([r, g, b].map(value => value * a + below * (1 - a)));
                const ink = light(parse(getComputedStyle(text).color));
                const contrast = (Math.max(ink, ground) + 0.05) / (Math.min(ink, ground) + 0.05);
                if (!(contrast >= least))
                    found.push([text.id || text.textContent, contrast]);
            }
        }
        return found;
    }, [CONTRAST, 'h1, h2, .card p, .card a, .card label, .card span, .card button']);
    check(poor.length === 0, `its texts stand out, ${theme}`, poor);
    await page.keyboard.press('Escape');
    check(await page.locator('#panel').isHidden(), `Escape closes the panel, ${theme}`);
}

async function checkCopying(page, url) {
    await page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
    await page.click('#use');
    await shoot(page, 'panel');
    for (const way of ['the clipboard', 'the selection, where the page has no clipboard']) {
        for (const [field, wanted] of [['tilejson-url', url + 'tiles.json'], ['tile-url', url + '{z}/{x}/{y}.png']]) {
            await page.click(`[data-copies=${field}]`);
            await page.locator(`[data-copies=${field}]`, {hasText: 'Copied'}).waitFor();
            const copied = await page.evaluate(() => {
                window.clipboard ??= navigator.clipboard;
                return Clipboard.prototype.readText.call(window.clipboard);
            });
            check(copied === wanted, `${field} is copied by ${way}`, copied);
            await page.evaluate(() => Clipboard.prototype.writeText.call(window.clipboard, ''));
        }
        await page.evaluate(() => Object.defineProperty(navigator, 'clipboard', {value: undefined}));
    }
    await page.click('#close');
}

// Each control that Tab reaches has a name, and the window looks otherwise while it has the focus.
async function checkKeyboard(page, blank) {
    const names = [], poor = [];
    await page.mouse.move(WIDE.width / 2, WIDE.height - 200);
    const before = await page.screenshot();
    for (let press = 0; press < 20; press++) {
        await page.keyboard.press('Tab');
        const name = await page.evaluate(() => document.activeElement === document.body ? null :
            document.activeElement.getAttribute('aria-label') ?? document.activeElement.textContent.trim());
        if (name === null || names.includes(name))
            break;
        names.push(name);
        if (!name || (await comparePictures(blank, await page.screenshot(), before)).off < 50)
            poor.push(name);
    }
    check(names.length >= 6 && poor.length === 0, 'Tab reaches each control, named and seen', {names, poor});
}

async function checkPhone(browser, url) {
    const page = await openPage(browser, url + hashAt(CENTER),
        {viewport: PHONE, isMobile: true, hasTouch: true, deviceScaleFactor: 2});
    await shoot(page, 'phone');
    const sources = await page.evaluate(() => [...document.querySelectorAll('img.leaflet-tile')].map(tile => tile.src));
    check(sources.every(source => source.includes('@2x.')), 'a fine screen has fine tiles', sources[0]);
    const off = () => page.evaluate(least => [...document.querySelectorAll('.card, button')].filter(part => {
        const box = part.getBoundingClientRect();
        return box.width && (box.left < 0 || box.right > innerWidth || box.top < 0 || box.bottom > innerHeight ||
            (part.nodeName === 'BUTTON' && Math.min(box.width, box.height) < least));
    }).map(part => part.id || part.className), FINGER_PX);
    check((await off()).length === 0, `on a phone all is in the window, and buttons have ${FINGER_PX} px`, await off());
    await page.tap('#use');
    await shoot(page, 'phone-panel');
    check((await off()).length === 0, 'its panel, too', await off());
    await page.tap('#close');
    const [zoom] = await readPlace(page), touches = await page.context().newCDPSession(page);
    for (let step = 0; step <= 8; step++) {
        const points = [{x: 180 - 25 - 8 * step, y: 370}, {x: 180 + 25 + 8 * step, y: 370}];
        await touches.send('Input.dispatchTouchEvent', {type: step ? 'touchMove' : 'touchStart', touchPoints: points});
    }
    await touches.send('Input.dispatchTouchEvent', {type: 'touchEnd', touchPoints: []});
    check(await reaches(page, zoom + 1, zoom + 2), 'two fingers zoom in', await readPlace(page));
    await page.context().close();
}

// What comes from a file is text; of links those that lead to the web are left.
async function checkForeignText(browser) {
    const server = await startServer(input, ...DRAWN, '--name', '<img src=x onerror=alert(1)>', '--attribution',
        '&copy; <a href="https://example.org/a?b&amp;c">Roads</a><a href="javascript:alert(2)"> and</a>' +
        '<script>alert(3)</script><img src=x onerror=alert(4)> (c) more');
    const page = await openPage(browser, server.url + hashAt(CENTER));
    check(await page.locator('h1').textContent() === '<img src=x onerror=alert(1)>', 'a name is text');
    const credit = await page.locator('#attribution').textContent();
    check(credit.startsWith('© Roads and') && credit.endsWith('© more'), 'an attribution is text', credit);
    const parts = await page.evaluate(() => [...document.querySelectorAll('#attribution *')].map(part =>
        part.outerHTML));
    check(parts.join() ===
        '<a href="https://example.org/a?b&amp;c" rel="noopener">Roads</a>', 'with links to the web alone');
    await page.context().close();
    await server.stop();
}

// OpenStreetMap's name leads to its licence, unless it leads somewhere already. Around it there is text.
async function checkLicence(browser) {
    const links = page => page.evaluate(() => [...document.querySelectorAll('#attribution *')].map(part =>
        part.outerHTML).join());
    const licence = 'href="https://www.openstreetmap.org/copyright" rel="noopener"';
    for (const [text, shown, wanted] of [
        ['(c) OpenStreetMap contributors', '© OpenStreetMap contributors',
            `<a ${licence}>OpenStreetMap contributors</a>`],
        ['&lt;b&gt;OpenStreetMap&lt;/b&gt;, <i onclick=alert(5)>us</i>', '<b>OpenStreetMap</b>, us',
            `<a ${licence}>OpenStreetMap</a>`],
        ['<a href="https://example.org/osm">OpenStreetMap</a>', 'OpenStreetMap',
            '<a href="https://example.org/osm" rel="noopener">OpenStreetMap</a>'],
    ]) {
        const server = await startServer(input, ...DRAWN, '--attribution', text);
        const page = await openPage(browser, server.url + hashAt(CENTER));
        check(await page.locator('#attribution').textContent() === shown && await links(page) === wanted,
            `the licence's link of ${text}`, await links(page));
        await page.context().close();
        await server.stop();
    }
}

// A map that is dark by itself has a dark page, whatever the system's theme, and no button.
async function checkDarkMap(browser) {
    const archive = join(folder, 'dark.pmtiles');
    execFileSync(tool, ['tiles', '-q', '-f', input, ...DRAWN, '-o', archive, '--theme', 'dark', '--min-zoom', '12',
        '--max-zoom', String(ZOOM + 1)]);
    for (const [what, shown] of [['map', [input, '--theme', 'dark']], ['archive', [archive]]]) {
        const server = await startServer(...shown);
        const page = await openPage(browser, server.url + hashAt(CENTER));
        check(await page.evaluate(() => document.documentElement.dataset.theme) === 'dark' &&
            await page.locator('#theme').isHidden(), `a dark ${what} has a dark page`);
        await shoot(page, `dark-${what}`);
        await page.context().close();
        await server.stop();
    }
}

// A map whose light and dark theme are two archives, found in the list of maps. The other map has the same input.
async function checkMaps(browser) {
    const [light, dark] = ['light', 'dark'].map(theme => {
        const archive = join(folder, `pair-${theme}.pmtiles`);
        execFileSync(tool, ['tiles', '-q', '-f', input, ...DRAWN, '-o', archive, '--theme', theme, '--min-zoom', '12',
            '--max-zoom', String(ZOOM + 1)]);
        return archive;
    });
    const server = await startServer(`drawn=${input}`, `pair=${light}`, `pair/dark=${dark}`);
    const context = await browser.newContext({viewport: WIDE, colorScheme: 'light', reducedMotion: 'reduce'});
    const page = await context.newPage();
    page.on('console', message => ['error', 'warning'].includes(message.type()) && complaints.push(message.text()));
    await context.addInitScript(`window.coverWindow = ${coverWindow}`);
    await page.goto(server.url);
    check((await page.locator('li a').allTextContents()).length === 2, 'the maps are listed', await page.content());
    await shoot(page, 'maps');
    await page.locator('li a[href="pair/"]').click();
    await page.waitForURL(/\/pair\//);
    await page.goto(server.url + 'pair/' + hashAt(CENTER));
    await waitForTheme(page, false);
    const ground = () => page.evaluate(() => getComputedStyle(document.getElementById('map')).backgroundColor);
    check(await page.locator('#theme').isVisible(), 'two archives have a button');
    await page.click('#theme');
    await waitForTheme(page, true);
    check(await ground() === 'rgb(16, 20, 28)', 'it shows the dark archive on a dark page', await ground());
    await shoot(page, 'pair-dark');
    await page.click('#theme');
    await waitForTheme(page, false);
    check(await ground() !== 'rgb(16, 20, 28)', 'and the light one on a light page', await ground());
    await page.emulateMedia({colorScheme: 'dark'});
    await waitForTheme(page, true);
    check(true, "without a choice two archives follow the system's");
    await context.close();
    await server.stop();
}

// The browser reports that nothing answers; so this page's console is not silent.
async function checkRestart(browser) {
    const server = await startServerAt(await findPort(), input, ...DRAWN);
    const page = await openPage(browser, server.url + hashAt(CENTER));
    await server.stop();
    const silent = complaints.length;
    await page.click('#theme');
    await page.locator('#notice').waitFor({state: 'visible'});
    const again = await startServerAt(server.port, input, ...DRAWN);
    await page.locator('#notice').waitFor({state: 'hidden'});
    await waitForTheme(page, true);
    complaints.length = silent;
    check(true, 'it goes on when a server that was away is back');
    await page.context().close();
    await again.stop();
}

// Tiles of 512 px, of which some are not there since nothing is to be seen in them.
async function checkArchive(browser, blank) {
    const archive = join(folder, 'city.pmtiles');
    execFileSync(tool, ['tiles', '-q', '-f', input, ...DRAWN, '-o', archive, '--tile-size', '512', '--min-zoom',
        '12', '--max-zoom', String(ZOOM)]);
    const server = await startServer(archive);
    const page = await openPage(browser, server.url + hashAt(CENTER));
    await checkPixels(page, blank, server.url, 'the map of an archive has');
    await page.goto(server.url + hashAt(SEA));
    await page.waitForFunction(() => {
        const all = [...document.querySelectorAll('img.leaflet-tile')];
        return all.length > 0 && all.every(tile => tile.complete);
    });
    const tiles = await page.locator('img.leaflet-tile').count();
    const seen = await page.locator('img.leaflet-tile-loaded').count();
    check(seen < tiles, 'tiles that an archive lacks are none', {seen, tiles});
    await page.context().close();
    await server.stop();
}

async function checkEditing(browser) {
    const file = join(folder, 'edited.json');
    const write = color => writeFileSync(file, JSON.stringify({version: 8, sources: {}, layers: [
        {id: 'ground', type: 'background', paint: {'background-color': color}}]}));
    write('#ff0000');
    const server = await startServer(input, '--edit', file);
    const page = await openPage(browser, server.url + hashAt(CENTER));
    const pixel = async () => {
        const shown = await page.screenshot({clip: {x: 640, y: 360, width: 1, height: 1}});
        return blankPixel(page.context(), shown);
    };
    check(await pixel() === '255,0,0', 'an edited style is shown', await pixel());
    // The least of the window that tiles have covered in any frame, while the styles change.
    await page.evaluate(() => {
        window.least = 1;
        const look = () => (window.least = Math.min(window.least, coverWindow()), requestAnimationFrame(look));
        look();
    });
    await waitForFrames(page);
    write('#0000ff');
    await waitFor(async () => await pixel() === '0,0,255');
    check(await pixel() === '0,0,255', 'a saved style is followed', await pixel());
    writeFileSync(file, '{"version": 8,\n"sources": {},\n"layers": [}');
    // A file that is written in place is empty for a moment, which may be told before.
    await page.locator('#notice', {hasText: 'line 3'}).waitFor({state: 'visible'});
    await shoot(page, 'error');
    const told = await page.locator('#notice').textContent();
    check(/edited\.json.*line 3/.test(told), 'a broken one is told with its place', told);
    check(await pixel() === '0,0,255', 'and the last good one stays', await pixel());
    write('#00ff00');
    await page.locator('#notice').waitFor({state: 'hidden'});
    await waitFor(async () => await pixel() === '0,255,0');
    check(await pixel() === '0,255,0', 'a mended one is shown', await pixel());
    const least = await page.evaluate(() => window.least);
    check(least > 0.999, 'no tile was away while they changed', least);
    await page.context().close();
    await server.stop();
}
async function blankPixel(context, picture) {
    const blank = await context.newPage();
    const color = await blank.evaluate(async bytes => {
        const image = await createImageBitmap(await (await fetch('data:image/png;base64,' + bytes)).blob());
        const canvas = new OffscreenCanvas(1, 1).getContext('2d');
        canvas.drawImage(image, 0, 0);
        return canvas.getImageData(0, 0, 1, 1).data.slice(0, 3).join();
    }, picture.toString('base64'));
    await blank.close();
    return color;
}
async function waitFor(what) {
    for (const end = Date.now() + PATIENCE_MS; Date.now() < end && !await what();)
        await new Promise(resolve => setTimeout(resolve, 100));
}

// ---- All of it ----

const browser = await launchBrowser();
let help;
try {
    help = execFileSync(tool, ['serve', '--help'], {stdio: ['ignore', 'pipe', 'ignore']}).toString();
} catch {
    await browser.close();
    skip('camber was built without serve (Debian: libmicrohttpd-dev)');
}
mkdirSync(folder, {recursive: true});
const server = await startServer(input, ...DRAWN);
try {
    const page = await openPage(browser, server.url + hashAt(CENTER)), blank = await browser.newPage();
    await checkFirstView(page);
    await shoot(page, 'light');
    await checkPixels(page, blank, server.url, 'its map has');
    await checkMoves(page);
    await checkHash(page, server.url);
    await checkTheme(page);
    await checkCopying(page, server.url);
    await page.reload();
    await waitForTiles(page);
    await checkKeyboard(page, blank);
    await page.context().close();
    await checkPhone(browser, server.url);
    await checkForeignText(browser);
    await checkLicence(browser);
    await checkLabels(browser, blank);
    await checkDarkMap(browser);
    await checkMaps(browser);
    await checkRestart(browser);
    await checkArchive(browser, blank);
    if (help.includes('--edit'))
        await checkEditing(browser);
    check(complaints.length === 0, 'the console is silent', complaints);
} finally {
    await browser.close();
    await server.stop();
}
process.exit(failures ? 1 : 0);
