// The page of camber serve: Leaflet shows the server's own tiles in a map that fills the window.
//
// Input: tiles.json, which describes the tiles; the URL's hash, #zoom/latitude/longitude; with --edit the stream of
// events, which says when the style's file was saved. Output: the hash, and the choice of light or dark.
//
// All paths are relative, so that the server can be below a folder of another server. The page shows zooms as in
// `camber render --zoom`, where the world is 512 px wide at zoom 0; for Leaflet it is 256 px wide. All data from the
// server is inserted as text, never as HTML.
'use strict';

const DARK_FOLDER = 'dark/'; // path of the built-in style's dark tiles
const MOST_LATITUDE = 85.05; // limit of Web Mercator
const SCALE_PX = 72;         // longest bar of the scale
const MOST_TRIES = 5;        // for a tile that cannot be loaded
const RETRY_MS = 1500;       // for a server that does not answer
const LOST = 'The server does not answer. The map goes on when it does.';
const PICTURES = ['png', 'webp', 'jpg', 'jpeg', 'avif'];
const CHOICE = 'camber-theme';

const element = id => document.getElementById(id);
const systemIsDark = matchMedia('(prefers-color-scheme: dark)');
const isStill = matchMedia('(prefers-reduced-motion: reduce)');

// ---- Light and dark ----

const getSystemTheme = () => systemIsDark.matches ? 'dark' : 'light';
// The browser may not allow the page to store anything; then the choice is lost when the page is closed.
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
            localStorage.removeItem(CHOICE); // a choice that equals the system's setting follows the system again
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

// ---- Messages ----

// Only for screen readers.
function say(text) {
    element('said').textContent = text;
}
// Shows a bar that stays until it is removed with an empty text. `place` is a position in a file.
function showNotice(text, place = '') {
    element('notice').hidden = !text;
    element('notice-text').textContent = text;
    element('notice-place').textContent = place;
}

// Attributions usually contain links and a few entities. Links to web pages are kept; all other elements are reduced to
// their text.
const ATTRIBUTION_PART = /<a\s[^>]*?href\s*=\s*(?:"([^"]*)"|'([^']*)')[^>]*>|(<\/a\s*>)|<\/?[a-z!][^>]*>|([^<]+|<)/gi;
const ENTITIES = {amp: '&', copy: '©', gt: '>', lt: '<', nbsp: '\u00a0', quot: '"', '#39': "'", '#169': '©'};

// The link that OpenStreetMap's licence requires. An attribution with a link of its own keeps it.
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

// ---- The view ----

// Returns how many decimals of a degree are needed for half a pixel.
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

// Leaflet rounds zooms; a typed zoom is kept as it is.
function goTo(map, place) {
    const snap = map.options.zoomSnap;
    map.options.zoomSnap = 0;
    map.setView(place.center, place.zoom, {animate: false});
    map.options.zoomSnap = snap;
}

function describePlace(place, zoom) {
    const decimals = Math.min(decimalsAt(zoom), 5), {lat, lng} = place.wrap(); // about a metre
    return `${Math.abs(lat).toFixed(decimals)}° ${lat < 0 ? 'S' : 'N'}, ` +
        `${Math.abs(lng).toFixed(decimals)}° ${lng < 0 ? 'W' : 'E'}`;
}
function showPlace(map, place) {
    const zoom = map.getZoom() - 1;
    element('place').textContent = describePlace(place, zoom);
    element('zoom').textContent = `zoom ${+zoom.toFixed(2)}`;
}
// The bar's length is the largest round number of metres that fits, measured in the middle of the map.
function showScale(map) {
    const y = map.getSize().y / 2;
    const most = map.distance(map.containerPointToLatLng([0, y]), map.containerPointToLatLng([SCALE_PX, y]));
    const power = 10 ** Math.floor(Math.log10(most)), round = power * [5, 2, 1].find(step => step * power <= most);
    element('bar').style.width = `${SCALE_PX * round / most}px`;
    element('length').textContent = round >= 1000 ? `${round / 1000} km` : `${round} m`;
}

// Updates hash, readings and buttons when the map moves, and moves the map when the hash changes.
function followPlace(map) {
    let pointer = null, silence; // if the mouse is not on the map, the readings are for its middle
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
        fadeAnimation: false, // loaded tiles are shown at once
        inertia: !isStill.matches,
        zoomAnimation: !isStill.matches,
        tap: false,
        wheelPxPerZoomLevel: 120, // one notch of the wheel is one zoom
    });
    // Keys also move the map while nothing has the focus.
    map.fire('focus');
    document.addEventListener('focusin', event => map.fire(event.target === map.getContainer() ? 'focus' : 'blur'));
    document.addEventListener('focusout', event => event.relatedTarget || map.fire('focus'));
    return map;
}

// Returns the part of the world that has tiles; null: the whole world, repeated.
function getBounds(tiles) {
    const [west, south, east, north] = tiles.bounds ?? [-180, -90, 180, 90];
    const far = east < west ? east + 360 : east; // it crosses the antimeridian
    return far - west >= 360 ? null : L.latLngBounds([south, west], [north, far]);
}
// Returns the size of a tile in CSS px. MapLibre reads the same member.
const getSide = tiles => tiles.tileSize ?? 256;
// Chooses WebP if it is available.
const getEnding = tiles => /\.(\w+)$/.exec(tiles.tiles.find(url => url.endsWith('.webp')) ?? tiles.tiles[0])[1];
// A new number in the URL keeps the browser from using cached tiles.
function makeLayer(folder, tiles, version) {
    const side = getSide(tiles), shift = Math.log2(side / 256);
    const ratio = Math.min(Math.ceil(devicePixelRatio), tiles.camber?.ratio_max ?? 1);
    const fineness = ratio > 1 ? `@${ratio}x` : '', query = version ? `?${version}` : '';
    return L.tileLayer(`${folder}{z}/{x}/{y}${fineness}.${getEnding(tiles)}${query}`, {
        bounds: !tiles.camber?.drawn && getBounds(tiles) || undefined, // drawn tiles have a background everywhere
        keepBuffer: 4,
        maxZoom: tiles.maxzoom + shift,
        minZoom: tiles.minzoom + shift,
        tileSize: side,
        updateInterval: 50, // ms, while the map is dragged
        updateWhenIdle: false,
        zoomOffset: -shift,
    });
}

// Requests a tile again if the server is busy or starting. An image does not say why loading failed, so the page
// requests the headers. A tile that is missing in an archive is not requested again.
function askAgain({tile}) {
    const source = tile.src, tries = Number(tile.dataset.tries ?? 0) + 1;
    tile.dataset.tries = tries;
    if (tries > MOST_TRIES)
        return;
    setTimeout(async () => {
        if (!tile.isConnected) // the map has moved on
            return;
        const status = await fetch(source, {method: 'HEAD'}).then(answer => answer.status, () => 503);
        if (status === 200)
            tile.src = source;
        else if (status === 503)
            askAgain({tile});
    }, tries * 1000);
}

// The visible layer, and the one that replaces it when all its tiles have been loaded.
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
        if (!layer.isLoading()) { // none of its tiles is in the window
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
// Returns the tiles for the page's theme. If the tiles have only the dark theme, the page becomes dark.
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
    } catch { // this needs https or localhost
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

// ---- Start and updates ----

// Listens for changes of the edited style's file. The stream reconnects automatically when the server is back.
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

// Zooms in one level from the view that shows everything, if this cuts off at most a sixth.
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
// Requests the description of the server's tiles, and shows these tiles instead of the current ones.
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
    if (turn !== page.turn) // a newer request has been made
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

// When the window moves to a screen with a higher resolution, it needs finer tiles.
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

// If the server was built without Leaflet: shows one picture of everything.
async function showPicture() {
    const note = document.createElement('p'), picture = document.createElement('img');
    note.className = 'card plain';
    note.textContent = 'Leaflet was not there when camber was built. Install libjs-leaflet and build again; ' +
        'until then there is one picture in place of the map.';
    document.body.replaceChildren(note);
    const [longitude, latitude, zoom] = (await describe('')).tiles.center ?? [0, 0, 1];
    picture.alt = 'The map';
    picture.onload = () => note.append(picture); // an archive has none
    picture.src = `static/${longitude},${latitude},${zoom - 1}/800x500.png`;
}

paint(readTheme());
addEventListener('DOMContentLoaded', () => typeof L === 'undefined' ? showPicture() : start());
