// How soon the page of camber serve has all tiles on the screen after a drag, in Chromium: one line of JSON.
// usage: page_drags.mjs CAMBER CITY
// npm's playwright-core is found through NODE_PATH, Chromium on PATH. Exit status: 77, and the reason, where something is
// not installed.
import {launchBrowser, skip, startServe} from '../../tests/tool/browser.mjs';

const CENTER = [-8.611, 41.1496], ZOOM = 14; // Porto
const WIDE = {width: 1280, height: 720};
const DRAGS = 20;

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
// Runs in the page. window.released becomes the milliseconds from the next release of the mouse to the frame after the
// one in which tiles cover the window.
function timeRelease() {
    window.released = new Promise(resolve => addEventListener('mouseup', () => {
        const start = performance.now();
        const look = () => {
            if (coverWindow() < 0.999)
                requestAnimationFrame(look);
            else
                requestAnimationFrame(() => setTimeout(() => resolve(performance.now() - start)));
        };
        requestAnimationFrame(look);
    }, {capture: true, once: true}));
}

async function drag(page, dx, dy) {
    const x = (WIDE.width - dx) / 2, y = (WIDE.height - dy) / 2;
    await page.mouse.move(x - 4 * Math.sign(dx), y - 4 * Math.sign(dy));
    await page.mouse.down();
    await page.mouse.move(x, y);
    await page.mouse.move(x + dx, y + dy, {steps: 8});
    await page.mouse.up();
}

const [tool, city] = process.argv.slice(2);
const browser = await launchBrowser(), server = await startServe(tool, [city]);
if (server.url === null) {
    await browser.close();
    skip('camber was built without serve (Debian: libmicrohttpd-dev)');
}
// Over rows that were not seen yet, by two thirds of the window.
const page = await browser.newPage({viewport: WIDE, reducedMotion: 'reduce'}), times = [];
await page.context().addInitScript(`window.coverWindow = ${coverWindow}; window.timeRelease = ${timeRelease}`);
await page.goto(`${server.url}/#${ZOOM}/${CENTER[1]}/${CENTER[0]}`);
await page.waitForFunction(() => coverWindow() > 0.999);
for (let i = 0; i < DRAGS; i++) {
    await page.evaluate(() => timeRelease());
    if (i % 4 === 3)
        await drag(page, 0, -480);
    else
        await drag(page, i % 8 < 4 ? -900 : 900, 0);
    times.push(await page.evaluate(() => window.released));
}
await browser.close();
await server.stop();
times.sort((a, b) => a - b);
const [median_ms, late_ms, most_ms] = [0.5, 0.95, 1].map(share => times[Math.ceil(share * DRAGS) - 1]);
console.log(JSON.stringify({drags: DRAGS, median_ms, late_ms, most_ms}));
