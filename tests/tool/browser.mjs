// What the tests that drive Debian's Chromium share: starting it, and comparing what it shows with what camber draws.
import {spawn} from 'node:child_process';
import {createReadStream, existsSync, readFileSync, statSync} from 'node:fs';
import {createServer as createHttpServer} from 'node:http';
import {createRequire} from 'node:module';
import {createServer} from 'node:net';
import {extname, join} from 'node:path';

const modules = process.env.NODE_PATH ?? '';
export const PATIENCE_MS = 240000; // for what happens at once on an idle machine: only what hangs takes longer

export function skip(what) {
    console.log(`skipped: ${what}`);
    process.exit(77);
}

// Skips where something is missing: Chromium on PATH, npm's playwright-core and the packages named in NODE_PATH. Names
// that begin with -- are Chromium's switches.
export async function launchBrowser(...names) {
    const isSwitch = name => name.startsWith('--');
    for (const name of [...names.filter(name => !isSwitch(name)), 'playwright-core'])
        if (!existsSync(join(modules, name)))
            skip(`npm package ${name} is not installed`);
    const executablePath = (process.env.PATH ?? '').split(':').flatMap(path =>
        ['chromium', 'chromium-browser', 'google-chrome'].map(name => join(path, name))).find(existsSync);
    if (!executablePath)
        skip('no Chromium (Debian: chromium)');
    const browser = await createRequire(import.meta.url)('playwright-core').chromium.launch({executablePath,
        timeout: PATIENCE_MS, args: ['--no-sandbox', '--ignore-gpu-blocklist', '--enable-unsafe-swiftshader', '--force-color-profile=srgb',
            ...names.filter(isSwitch)]});
    const newContext = browser.newContext.bind(browser);
    browser.newContext = async options => {
        const context = await newContext(options);
        context.setDefaultTimeout(PATIENCE_MS);
        return context;
    };
    browser.newPage = async options => (await browser.newContext(options)).newPage();
    return browser;
}

// A free port of those that the system gives nobody who asks for any: none is likely to take it before it is used.
export function findPort() {
    const given = Number(readFileSync('/proc/sys/net/ipv4/ip_local_port_range', 'ascii').split(/\s/)[0]);
    return new Promise(resolve => {
        const port = given > 20000 ? 20000 + Math.floor(Math.random() * (given - 20000)) : 0;
        const socket = createServer().listen(port, '127.0.0.1', () => {
            const found = socket.address().port;
            socket.close(() => resolve(found));
        }).on('error', () => resolve(findPort()));
    });
}

// Starts `camber serve` with the options, at that port or at one that the system chooses: its URL without a slash at its
// end, its port, and what stops it. Where the build has no server, the URL is null.
export async function startServe(tool, options, port = 0) {
    const serve = spawn(tool, ['serve', '-q', ...options, '--json', '--listen', `127.0.0.1:${port}`],
        {stdio: ['ignore', 'pipe', 'pipe']});
    let about = '', complaint = '';
    serve.stdout.on('data', text => about += text);
    serve.stderr.on('data', text => complaint += text);
    const gone = new Promise(resolve => serve.on('close', resolve));
    const parse = () => {
        try {
            return JSON.parse(about).url;
        } catch {
            return null;
        }
    };
    const isReady = async () => parse() && await fetch(parse() + '/health').then(answer => answer.ok, () => false);
    while (serve.exitCode === null && !await isReady())
        await new Promise(resolve => setTimeout(resolve, 20));
    const stop = () => {
        serve.kill();
        return gone;
    };
    if (serve.exitCode === null)
        return {url: parse(), port: Number(new URL(parse()).port), stop};
    await gone;
    if (!complaint.includes('this build has no server'))
        throw new Error(`camber serve ${options.join(' ')}: ${complaint}`);
    return {url: null, stop};
}

// The corner of tiles of 256 px next to a place. Such a tile has one zoom more than the map.
export function cornerAt([longitude, latitude], zoom) {
    const tiles = 2 ** (zoom + 1), y = (1 - Math.asinh(Math.tan(latitude * Math.PI / 180)) / Math.PI) / 2;
    const column = Math.round((longitude + 180) / 360 * tiles) / tiles, row = Math.round(y * tiles) / tiles;
    return [column * 360 - 180, Math.atan(Math.sinh((1 - 2 * row) * Math.PI)) * 180 / Math.PI];
}

// A server of a page, at /, and of files: fileOf names that of a path. Archives are read by ranges.
const TYPES = {'.css': 'text/css', '.js': 'text/javascript', '.json': 'application/json', '.mjs': 'text/javascript',
    '.png': 'image/png'};
function sendFile(request, response, file) {
    const size = statSync(file).size, range = /^bytes=(\d+)-(\d+)$/.exec(request.headers.range ?? '');
    const start = range ? Number(range[1]) : 0, end = range ? Math.min(Number(range[2]), size - 1) : size - 1;
    response.writeHead(range ? 206 : 200, {'Content-Type': TYPES[extname(file)] ?? 'application/octet-stream',
        'Content-Length': end - start + 1, ETag: '"1"',
        ...(range && {'Content-Range': `bytes ${start}-${end}/${size}`})});
    createReadStream(file, {start, end}).pipe(response);
}
export function serveFiles(page, fileOf) {
    return createHttpServer((request, response) => {
        const path = decodeURIComponent(new URL(request.url, 'http://camber').pathname), file = fileOf(path);
        if (path === '/') {
            response.writeHead(200, {'Content-Type': 'text/html'});
            response.end(page);
        } else if (!path.includes('..') && existsSync(file) && statSync(file).isFile()) {
            sendFile(request, response, file);
        } else {
            response.writeHead(404);
            response.end();
        }
    });
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
        const shown = new Uint32Array(a.data.buffer), drawn = new Uint32Array(b.data.buffer);
        for (let i = 0; i < a.data.length; i += 4) {
            const color = drawn[i / 4];
            if (i === 0 || color !== drawn[i / 4 - 1])
                colors.add(color & 0xffffff);
            if (shown[i / 4] === color)
                continue;
            let apart = 0;
            for (let c = 0; c < 3; c++) {
                apart = Math.max(apart, Math.abs(a.data[i + c] - b.data[i + c]));
                sum += Math.abs(a.data[i + c] - b.data[i + c]);
            }
            most = Math.max(most, apart);
            off += apart > 0;
            far[i / 4] = apart > levels;
        }
        const around = [-1, 0, 1].flatMap(row => [-1, 0, 1].map(column => row * a.width + column));
        for (let i = a.width + 1; i < far.length - a.width - 1; i++)
            wide += far[i] && around.every(step => far[i + step]);
        return {most, off, wide, mean: sum / (a.data.length / 4 * 3), colors: colors.size, same: a.width === b.width && a.height === b.height};
    }, [levels, shown.toString('base64'), drawn.toString('base64')]);
}
