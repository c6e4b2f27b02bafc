// The page of camber serve: a map that fills the window, shown by Leaflet from the server's own tiles.
//
// In: tiles.json, which says what the tiles are; the URL's hash, #zoom/latitude/longitude; with --edit the stream of
// events, which tells when the style's file was saved. Out: the hash, and the choice of light or dark.
//
// All paths are relative, so that the server may stand below a folder of another. Zooms that people see are those of
// `camber render --zoom`, where the world is 512 px wide at zoom 0; Leaflet counts from 256. Whatever comes from the
// server becomes text and never HTML.
'use strict';

const DARK_FOLDER = 'dark/'; // where the built-in style's dark tiles are
const MOST_LATITUDE = 85.05; // where the square world ends
const SCALE_PX = 72;         // the scale's bar is as long at most
const MOST_TRIES = 5;        // for a tile that does not come
const RETRY_MS = 1500;       // for a server that does not answer
const LOST = 'The server does not answer. The map goes on when it does.';
const PICTURES = ['png', 'webp', 'jpg', 'jpeg', 'avif'];
const CHOICE = 'camber-theme';

const element = id => document.getElementById(id);
const systemIsDark = matchMedia('(prefers-color-scheme: dark)');
const isStill = matchMedia('(prefers-reduced-motion: reduce)');

// ---- Light and dark ----

const getSystemTheme = () => systemIsDark.matches ? 'dark' : 'light';
// The browser may forbid to remember anything; then a choice holds until the page is left.
let unsaved = null;
function readTheme() {
    try {
        return unsaved ?? localStorage.getItem(CHOICE) ?? getSystemTheme();
    } catch {
        return getSystemTheme();
    }
}
function writeTheme(theme) {
    try {
        if (theme === getSystemTheme())
            localStorage.removeItem(CHOICE); // whoever wants what the system has follows it again
        else
            localStorage.setItem(CHOICE, theme);
    } catch {
        unsaved = theme;
    }
}
function paint(theme) {
    document.documentElement.dataset.theme = theme;
    element('theme')?.setAttribute('aria-pressed', String(theme === 'dark'));
}
const getPainted = () => document.documentElement.dataset.theme;

// ---- What is said ----

// For screen readers alone.
function say(text) {
    element('said').textContent = text;
}
// A quiet bar that stays until it is taken back by an empty text. `place` is where in which file.
function showNotice(text, place = '') {
    element('notice').hidden = !text;
    element('notice-text').textContent = text;
    element('notice-place').textContent = place;
}

// By custom an attribution has links and a few entities. Links that lead to the web stay; of other elements there is
// their text alone.
const ATTRIBUTION_PART = /<a\s[^>]*?href\s*=\s*(?:"([^"]*)"|'([^']*)')[^>]*>|(<\/a\s*>)|<\/?[a-z!][^>]*>|([^<]+|<)/gi;
const ENTITIES = {amp: '&', copy: '©', gt: '>', lt: '<', nbsp: '\u00a0', quot: '"', '#39': "'", '#169': '©'};

// Where OpenStreetMap's attribution leads by its licence. An attribution that has its own link keeps that one.
const OSM_NAME = /(OpenStreetMap(?: contributors)?)/, OSM_COPYRIGHT = 'https://www.openstreetmap.org/copyright';

function makeLink(target, text = '') {
    const link = document.createElement('a');
    link.href = target;
    link.rel = 'noopener';
    link.textContent = text;
    return link;
}
const linkNames = text => text.split(OSM_NAME).map((part, i) => i % 2 ? makeLink(OSM_COPYRIGHT, part) : part);
const readEntities = text => text.replace(/&(#?\w+);/g, (whole, name) => ENTITIES[name] ?? whole);
function showAttribution(text) {
    const line = element('attribution');
    let place = line;
    line.replaceChildren();
    for (const [, quoted, apostrophed, end, words] of (text ?? '').matchAll(ATTRIBUTION_PART)) {
        const target = readEntities(quoted ?? apostrophed ?? '');
        if (end) {
            place = line;
        } else if (words) {
            const text = readEntities(words).replace(/\(c\)/gi, '©');
            place.append(...place === line ? linkNames(text) : [text]);
        } else if (/^https?:\/\//i.test(target)) {
            place = makeLink(target);
            line.append(place);
        }
    }
    line.hidden = !line.textContent.trim();
}

// ---- The place ----

// As many decimals of a degree as tell half a pixel.
const decimalsAt = zoom => Math.max(0, Math.ceil((zoom * Math.LN2 + Math.log(512 / 360 / 0.5)) / Math.LN10));

function readHash() {
    const numbers = location.hash.slice(1).split('/').map(text => text ? Number(text) : NaN);
    if (numbers.length < 3 || !numbers.slice(0, 3).every(Number.isFinite) || Math.abs(numbers[1]) > MOST_LATITUDE)
        return null;
    return {zoom: numbers[0] + 1, center: [numbers[1], numbers[2]]};
}
function writeHash(map) {
    const zoom = map.getZoom() - 1, center = map.getCenter().wrap(), decimals = decimalsAt(zoom);
    history.replaceState(null, '', `#${+zoom.toFixed(2)}/${center.lat.toFixed(decimals)}/${center.lng.toFixed(decimals)}`);
}

// Leaflet rounds zooms; one that was typed stays as it is.
function goTo(map, place) {
    const snap = map.options.zoomSnap;
    map.options.zoomSnap = 0;
    map.setView(place.center, place.zoom, {animate: false});
    map.options.zoomSnap = snap;
}

function describePlace(place, zoom) {
    const decimals = Math.min(decimalsAt(zoom), 5), {lat, lng} = place.wrap(); // a metre
    return `${Math.abs(lat).toFixed(decimals)}° ${lat < 0 ? 'S' : 'N'}, ` +
        `${Math.abs(lng).toFixed(decimals)}° ${lng < 0 ? 'W' : 'E'}`;
}
function showPlace(map, place) {
    const zoom = map.getZoom() - 1;
    element('place').textContent = describePlace(place, zoom);
    element('zoom').textContent = `zoom ${+zoom.toFixed(2)}`;
}
// The bar is as long as the largest round number of metres that fits, in the middle of the map.
function showScale(map) {
    const y = map.getSize().y / 2;
    const most = map.distance(map.containerPointToLatLng([0, y]), map.containerPointToLatLng([SCALE_PX, y]));
    const power = 10 ** Math.floor(Math.log10(most)), round = power * [5, 2, 1].find(step => step * power <= most);
    element('bar').style.width = `${SCALE_PX * round / most}px`;
    element('length').textContent = round >= 1000 ? `${round / 1000} km` : `${round} m`;
}

// Keeps hash, readings and buttons with the map, and the map with a hash that is typed or gone back to.
function followPlace(map) {
    let pointer = null, silence; // without a mouse on the map its middle is told
    map.on('mousemove', event => {
        pointer = event.containerPoint;
        showPlace(map, event.latlng);
    });
    map.on('mouseout', () => {
        pointer = null;
        showPlace(map, map.getCenter());
    });
    map.on('move zoom resize', () => {
        showPlace(map, pointer ? map.containerPointToLatLng(pointer) : map.getCenter());
        showScale(map);
    });
    map.on('moveend', () => {
        const zoom = map.getZoom() - 1;
        writeHash(map);
        clearTimeout(silence);
        silence = setTimeout(() => say(`Zoom ${+zoom.toFixed(2)}, ${describePlace(map.getCenter(), zoom)}`), 800);
    });
    map.on('zoomend zoomlevelschange', () => {
        element('zoom-in').setAttribute('aria-disabled', String(map.getZoom() >= map.getMaxZoom()));
        element('zoom-out').setAttribute('aria-disabled', String(map.getZoom() <= map.getMinZoom()));
    });
    addEventListener('hashchange', () => {
        const place = readHash();
        if (place)
            goTo(map, place);
    });
}

// ---- Tiles ----

function makeMap() {
    const map = L.map('map', {
        attributionControl: false,
        zoomControl: false,
        bounceAtZoomLimits: false,
        fadeAnimation: false, // a tile that is there is seen
        inertia: !isStill.matches,
        zoomAnimation: !isStill.matches,
        tap: false,
        wheelPxPerZoomLevel: 120, // a notch is a zoom
    });
    // Keys move the map while nothing else has the focus, too.
    map.fire('focus');
    document.addEventListener('focusin', event => map.fire(event.target === map.getContainer() ? 'focus' : 'blur'));
    document.addEventListener('focusout', event => event.relatedTarget || map.fire('focus'));
    return map;
}

// The part of the world that has tiles; null: all of it, any number of times around.
function getBounds(tiles) {
    const [west, south, east, north] = tiles.bounds ?? [-180, -90, 180, 90];
    const far = east < west ? east + 360 : east; // across the antimeridian
    return far - west >= 360 ? null : L.latLngBounds([south, west], [north, far]);
}
// CSS px; MapLibre reads the same member.
const getSide = tiles => tiles.tileSize ?? 256;
// WebP where there is a choice.
const getEnding = tiles => /\.(\w+)$/.exec(tiles.tiles.find(url => url.endsWith('.webp')) ?? tiles.tiles[0])[1];
// A number that was not asked for before keeps tiles from being taken out of the browser's memory.
function makeLayer(folder, tiles, version) {
    const side = getSide(tiles), shift = Math.log2(side / 256);
    const ratio = Math.min(Math.ceil(devicePixelRatio), tiles.camber?.ratio_max ?? 1);
    const fineness = ratio > 1 ? `@${ratio}x` : '', query = version ? `?${version}` : '';
    return L.tileLayer(`${folder}{z}/{x}/{y}${fineness}.${getEnding(tiles)}${query}`, {
        bounds: !tiles.camber?.drawn && getBounds(tiles) || undefined, // what is drawn has a ground everywhere
        keepBuffer: 4,
        maxZoom: tiles.maxzoom + shift,
        minZoom: tiles.minzoom + shift,
        tileSize: side,
        updateInterval: 50, // ms, while the map is dragged
        updateWhenIdle: false,
        zoomOffset: -shift,
    });
}

// A tile is asked for again where the server is busy, or is being started. An image does not tell why there is none, so
// its headers are asked for. A tile that is not in an archive stays away.
function askAgain({tile}) {
    const source = tile.src, tries = Number(tile.dataset.tries ?? 0) + 1;
    tile.dataset.tries = tries;
    if (tries > MOST_TRIES)
        return;
    setTimeout(async () => {
        if (!tile.isConnected) // the map went on
            return;
        const status = await fetch(source, {method: 'HEAD'}).then(answer => answer.status, () => 503);
        if (status === 200)
            tile.src = source;
        else if (status === 503)
            askAgain({tile});
    }, tries * 1000);
}

// The layer that is seen, and the one that replaces it once all its tiles are there.
function makeLayers(map) {
    let shown = null, coming = null;
    return layer => {
        coming?.remove();
        coming = layer;
        const settle = () => {
            shown?.remove();
            shown = layer;
            coming = null;
        };
        layer.once('load', settle);
        layer.on('tileerror', askAgain);
        layer.setZIndex(shown ? shown.options.zIndex - 1 : 1);
        layer.addTo(map);
        if (!layer.isLoading()) { // no tile of it is in the window
            layer.off('load', settle);
            settle();
        }
    };
}

async function describe(folder) {
    const answer = await fetch(folder + 'tiles.json', {cache: 'no-cache'});
    if (!answer.ok)
        throw new Error(answer.status);
    return {folder, tiles: await answer.json()};
}
// What is to be shown under the theme of the page. Tiles that are dark by themselves make the page dark.
async function describeForTheme() {
    const found = await describe(''), theme = found.tiles.camber?.theme ?? null;
    element('theme').hidden = theme === 'dark';
    paint(theme === 'dark' ? 'dark' : readTheme());
    return theme === 'light' && getPainted() === 'dark' ? describe(DARK_FOLDER) : found;
}

// ---- The panel ----

function showUrls(tiles) {
    const url = tiles.tiles[0];
    element('tile-url').value = url;
    element('tilejson-url').value = url.replace(/\{z\}.*$/, 'tiles.json');
    element('extent').textContent = `Zooms ${tiles.minzoom} to ${tiles.maxzoom}, tiles of ${getSide(tiles)} px.`;
}
async function copyField(button) {
    const field = element(button.dataset.copies);
    let copied = true;
    field.select();
    try {
        await navigator.clipboard.writeText(field.value);
    } catch { // which needs https or this machine
        copied = document.execCommand('copy');
    }
    button.textContent = copied ? 'Copied' : 'Ctrl+C';
    say(copied ? 'Copied' : 'Selected: press Control and C');
    setTimeout(() => button.textContent = 'Copy', 1600);
}
function openPanel(open) {
    element('panel').hidden = !open;
    element('use').setAttribute('aria-expanded', String(open));
    if (!open)
        element('use').focus();
}
function makePanel() {
    element('use').onclick = () => openPanel(element('panel').hidden);
    element('close').onclick = () => openPanel(false);
    for (const button of document.querySelectorAll('.copy'))
        button.onclick = () => copyField(button);
    addEventListener('keydown', event => {
        if (event.key === 'Escape' && !element('panel').hidden)
            openPanel(false);
    });
}

// ---- All of it ----

// Follows the file of a style that is edited. The stream comes back by itself when the server does.
function followEdits(page) {
    const stream = new EventSource('events');
    stream.addEventListener('style', event => {
        const {revision, error} = JSON.parse(event.data);
        showNotice(error ? 'The style has an error. The map shows the last good one.' : '', error ?? '');
        const isNew = page.revision !== null && revision !== page.revision;
        page.revision = revision;
        if (isNew && !error) {
            page.version++;
            page.refresh().then(() => say('The map follows the new style.'));
        }
    });
    stream.addEventListener('error', () => {
        page.isLost = true;
        showNotice(LOST);
    });
    stream.addEventListener('open', () => {
        if (page.isLost) {
            page.isLost = false;
            showNotice('');
            page.version++;
            page.refresh();
        }
    });
}

// One zoom closer than what shows everything, where a sixth of that is lost at most.
function findFirstZoom(map, bounds) {
    const zoom = map.getBoundsZoom(bounds), size = map.getSize();
    const {x, y} = map.project(bounds.getSouthEast(), zoom + 1).subtract(map.project(bounds.getNorthWest(), zoom + 1));
    return x > 1.2 * size.x || y > 1.2 * size.y ? zoom : zoom + 1;
}
function showFirst(map, tiles) {
    const place = readHash(), bounds = getBounds(tiles);
    if (place)
        goTo(map, place);
    else if (bounds)
        map.setView(bounds.getCenter(), findFirstZoom(map, bounds));
    else
        map.setView([tiles.center?.[1] ?? 0, tiles.center?.[0] ?? 0], tiles.center?.[2] ?? tiles.minzoom);
}
// Asks the server what its tiles are, and shows them in place of those that are seen.
async function refresh(page) {
    const turn = ++page.turn;
    let found;
    try {
        found = await describeForTheme();
    } catch {
        page.isLost = true;
        showNotice(LOST);
        setTimeout(() => turn === page.turn && page.refresh(), RETRY_MS);
        return;
    }
    if (turn !== page.turn) // something newer is on its way
        return;
    if (page.isLost)
        showNotice('');
    page.isLost = false;
    const {folder, tiles} = found, shift = Math.log2(getSide(tiles) / 256);
    element('title').hidden = !tiles.name;
    element('name').textContent = tiles.name ?? '';
    document.title = tiles.name ? `${tiles.name} · camber` : 'camber';
    showAttribution(tiles.attribution);
    showUrls(tiles);
    page.map.setMinZoom(tiles.minzoom + shift);
    page.map.setMaxZoom(tiles.maxzoom + shift);
    if (!page.tiles)
        showFirst(page.map, tiles);
    if (PICTURES.includes(getEnding(tiles)))
        page.show(makeLayer(folder, tiles, page.version));
    else
        showNotice('These are vector tiles. To see them here, let camber serve draw them: with --style.');
    page.tiles = tiles;
    if (tiles.camber?.edit && !page.follows) {
        page.follows = true;
        followEdits(page);
    }
}

// A window that goes to a finer screen wants finer tiles.
function watchRatio(page) {
    matchMedia(`(resolution: ${devicePixelRatio}dppx)`).addEventListener('change', () => {
        page.refresh();
        watchRatio(page);
    }, {once: true});
}
function start() {
    paint(getPainted());
    const map = makeMap();
    const page = {map, show: makeLayers(map), tiles: null, revision: null, version: 0, turn: 0,
        follows: false, isLost: false, refresh: () => refresh(page)};
    followPlace(map);
    makePanel();
    element('zoom-in').onclick = () => map.zoomIn();
    element('zoom-out').onclick = () => map.zoomOut();
    element('fit').onclick = () => page.tiles && map.fitBounds(getBounds(page.tiles) ?? [[-60, -180], [75, 180]]);
    element('theme').onclick = () => {
        writeTheme(getPainted() === 'dark' ? 'light' : 'dark');
        page.refresh();
    };
    systemIsDark.addEventListener('change', page.refresh);
    watchRatio(page);
    page.refresh();
}

// The build had no Leaflet: one picture of all.
async function showPicture() {
    const note = document.createElement('p'), picture = document.createElement('img');
    note.className = 'card plain';
    note.textContent = 'Leaflet was not there when camber was built. Install libjs-leaflet and build again; ' +
        'until then there is one picture in place of the map.';
    document.body.replaceChildren(note);
    const [longitude, latitude, zoom] = (await describe('')).tiles.center ?? [0, 0, 1];
    picture.alt = 'The map';
    picture.onload = () => note.append(picture); // of an archive there is none
    picture.src = `static/${longitude},${latitude},${zoom - 1}/800x500.png`;
}

paint(readTheme());
addEventListener('DOMContentLoaded', () => typeof L === 'undefined' ? showPicture() : start());
