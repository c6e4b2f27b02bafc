// What the tests that drive Debian's Chromium share: starting it, and comparing what it shows with what camber draws.
import {spawn} from 'node:child_process';
import {existsSync} from 'node:fs';
import {createRequire} from 'node:module';
import {createServer} from 'node:net';
import {join} from 'node:path';

const modules = process.env.NODE_PATH ?? '';

export function skip(what) {
    console.log(`skipped: ${what}`);
    process.exit(77);
}

// Skips where something is missing: Chromium on PATH, npm's playwright-core and the packages named in NODE_PATH. Names
// that begin with -- are Chromium's switches.
export function launchBrowser(...names) {
    const isSwitch = name => name.startsWith('--');
    for (const name of [...names.filter(name => !isSwitch(name)), 'playwright-core'])
        if (!existsSync(join(modules, name)))
            skip(`npm package ${name} is not installed`);
    const executablePath = (process.env.PATH ?? '').split(':').flatMap(path =>
        ['chromium', 'chromium-browser', 'google-chrome'].map(name => join(path, name))).find(existsSync);
    if (!executablePath)
        skip('no Chromium (Debian: chromium)');
    return createRequire(import.meta.url)('playwright-core').chromium.launch({executablePath,
        args: ['--no-sandbox', '--ignore-gpu-blocklist', '--enable-unsafe-swiftshader', '--force-color-profile=srgb',
            ...names.filter(isSwitch)]});
}

// Starts `camber serve` of an input: its URL without a slash at its end, and what stops it. Where the build has no
// server, the URL is null.
export async function startServe(tool, input) {
    const port = await new Promise(resolve => {
        const socket = createServer().listen(0, '127.0.0.1', () => {
            const found = socket.address().port;
            socket.close(() => resolve(found));
        });
    });
    const url = `http://127.0.0.1:${port}`;
    const serve = spawn(tool, ['serve', '-q', input, '--listen', `127.0.0.1:${port}`],
        {stdio: ['ignore', 'ignore', 'pipe']});
    let complaint = '';
    serve.stderr.on('data', text => complaint += text);
    const gone = new Promise(resolve => serve.on('close', resolve));
    const isReady = () => fetch(url + '/health').then(answer => answer.ok, () => false);
    for (let wait = 0; wait < 100 && serve.exitCode === null && !await isReady(); wait++)
        await new Promise(resolve => setTimeout(resolve, 100));
    const stop = () => {
        serve.kill();
        return gone;
    };
    if (serve.exitCode === null)
        return {url, stop};
    await gone;
    if (!complaint.includes('this build has no server'))
        throw new Error(complaint);
    return {url: null, stop};
}

// The corner of tiles of 256 px next to a place. Such a tile has one zoom more than the map.
export function cornerAt([longitude, latitude], zoom) {
    const tiles = 2 ** (zoom + 1), y = (1 - Math.asinh(Math.tan(latitude * Math.PI / 180)) / Math.PI) / 2;
    const column = Math.round((longitude + 180) / 360 * tiles) / tiles, row = Math.round(y * tiles) / tiles;
    return [column * 360 - 180, Math.atan(Math.sinh((1 - 2 * row) * Math.PI)) * 180 / Math.PI];
}

// Compares two PNGs in a page that allows data: URLs. `most` is the largest difference of a channel, `off` counts the
// pixels that differ, `wide` those that do by more than so many levels with all eight neighbours: more than an edge.
// `mean` is that of the channels, and `colors` counts the colours of the second.
export function comparePictures(page, shown, drawn, levels = 8) {
    return page.evaluate(async ([levels, ...pictures]) => {
        const [a, b] = await Promise.all(pictures.map(async bytes => {
            const image = await createImageBitmap(await (await fetch('data:image/png;base64,' + bytes)).blob());
            const canvas = new OffscreenCanvas(image.width, image.height).getContext('2d');
            canvas.drawImage(image, 0, 0);
            return canvas.getImageData(0, 0, image.width, image.height);
        }));
        let most = 0, off = 0, wide = 0, sum = 0;
        const far = new Uint8Array(a.width * a.height);
        const colors = new Set();
        for (let i = 0; i < a.data.length; i += 4) {
            let apart = 0;
            for (let c = 0; c < 3; c++) {
                apart = Math.max(apart, Math.abs(a.data[i + c] - b.data[i + c]));
                sum += Math.abs(a.data[i + c] - b.data[i + c]);
            }
            most = Math.max(most, apart);
            off += apart > 0;
            far[i / 4] = apart > levels;
            colors.add(b.data[i] << 16 | b.data[i + 1] << 8 | b.data[i + 2]);
        }
        const around = [-1, 0, 1].flatMap(row => [-1, 0, 1].map(column => row * a.width + column));
        for (let i = a.width + 1; i < far.length - a.width - 1; i++)
            wide += around.every(step => far[i + step]);
        return {most, off, wide, mean: sum / (a.data.length / 4 * 3), colors: colors.size, same: a.width === b.width && a.height === b.height};
    }, [levels, shown.toString('base64'), drawn.toString('base64')]);
}
