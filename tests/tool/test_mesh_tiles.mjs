// Mesh tiles from the command line: valid GLB, the points of camber's own tessellation, the same bytes however they are
// drawn. usage: test_mesh_tiles.mjs CAMBER INPUT FOLDER
// npm's gltf-validator and three are found through NODE_PATH. Exit status: 1 where a check failed, 77 where one is not
// installed.
import {execFileSync, spawnSync} from 'node:child_process';
import {mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {FIRST, SENTINEL, LAST, loadDecoder, readTile, recordsOf} from './mesh_tile.mjs';

const [tool, input, folder] = process.argv.slice(2);
const decoder = await loadDecoder();
let validator;
try {
    validator = createRequire(import.meta.url)('gltf-validator');
} catch {
    // Told below.
}
if (!decoder || !validator) {
    console.log(`skipped: npm package ${decoder ? 'gltf-validator' : 'three'} is not installed`);
    process.exit(77);
}
let failures = 0;
function check(right, what, found = '') {
    console.log(`${right ? 'ok' : 'not ok'} - ${what}${right || found === '' ? '' : `: ${JSON.stringify(found)}`}`);
    failures += !right;
}
function run(...args) {
    return execFileSync(tool, args, {encoding: 'utf8', stdio: ['ignore', 'pipe', 'inherit']});
}
function tilesOf(path) {
    return readdirSync(path, {recursive: true}).filter(name => name.endsWith('.glb')).sort()
        .map(name => ({name, place: name.split(/[/.]/).slice(0, 3).map(Number), bytes: readFileSync(join(path, name))}));
}

rmSync(folder, {recursive: true, force: true});
mkdirSync(folder, {recursive: true});
const drawn = join(folder, 'city/'), options = ['--format', 'glb', '--min-zoom', '10', '--max-zoom', '14', '-q'];
run('tiles', input, ...options, '-o', drawn);
const tiles = tilesOf(drawn);

// ---- Valid ----

// The validator does not know the compression, so each tile is also judged as it is when it is decoded.
function plain(tile) {
    const {json, values} = readTile(decoder, tile.bytes), parts = [];
    const kinds = {5121: Uint8Array, 5122: Int16Array, 5125: Uint32Array, 5126: Float32Array};
    let at = 0;
    const indices = new Set(json.meshes[0].primitives.map(primitive => primitive.indices));
    json.bufferViews = json.accessors.map((accessor, i) => {
        const array = kinds[accessor.componentType], stride = (values[i][0].length * array.BYTES_PER_ELEMENT + 3) >> 2 << 2;
        const bytes = new Uint8Array(values[i].length * stride), start = at;
        values[i].forEach((value, k) => bytes.set(new Uint8Array(array.from(value).buffer), k * stride));
        parts.push(bytes);
        at += bytes.length;
        Object.assign(accessor, {bufferView: i, byteOffset: 0});
        return {buffer: 0, byteOffset: start, byteLength: bytes.length,
            ...indices.has(i) ? {target: 34963} : {byteStride: stride, target: 34962}};
    });
    json.buffers = [{byteLength: at, uri: `data:application/octet-stream;base64,${Buffer.concat(parts).toString('base64')}`}];
    json.extensionsUsed = json.extensionsUsed.filter(name => name !== 'EXT_meshopt_compression');
    json.extensionsRequired = ['KHR_mesh_quantization'];
    return JSON.stringify(json);
}
async function judge(drawn) {
    const issues = [];
    for (const tile of drawn) {
        const packed = await validator.validateBytes(new Uint8Array(tile.bytes), {uri: tile.name, maxIssues: 5});
        const whole = await validator.validateString(plain(tile), {uri: tile.name, maxIssues: 5});
        for (const {issues: {messages}} of [packed, whole])
            issues.push(...messages.filter(({severity}) => severity <= 1).map(({code, pointer}) => [tile.name, code, pointer]));
    }
    return issues;
}
const issues = await judge(tiles);
check(tiles.length > 100, 'there are tiles', tiles.length);
check(issues.length === 0, 'each is valid, compressed and decoded', issues.slice(0, 5));

// ---- Well formed: sentinels around lines, rows and ranges within their tables ----

const wrong = [];
for (const tile of tiles) {
    const read = readTile(decoder, tile.bytes), records = recordsOf(read), {layers, rows} = read.extras;
    if (!(records[0].flags & SENTINEL) || !(records.at(-1).flags & SENTINEL))
        wrong.push([tile.name, 'no sentinel at an end']);
    records.forEach(({flags, row}, i) => {
        const before = records[i - 1]?.flags ?? 0;
        if (i > 0 && !(flags & SENTINEL) && Boolean(flags & FIRST) !== Boolean(before & SENTINEL))
            wrong.push([tile.name, 'a line that does not begin behind a sentinel', i]);
        if ((flags & SENTINEL) && i > 0 && !(before & (SENTINEL | LAST)))
            wrong.push([tile.name, 'a line that does not end before a sentinel', i]);
        if (row < 0 || row >= rows.length)
            wrong.push([tile.name, 'no such row', row]);
    });
    for (const {id, range: [first, count], paints} of layers)
        if (first < 1 || first + count >= records.length || !Object.keys(paints).every(row => row < rows.length))
            wrong.push([tile.name, id]);
}
check(wrong.length === 0, 'records and layers are well formed', wrong.slice(0, 5));

// ---- The points are those of the tessellation ----

// One layer of all lines, so that a tile and a view of its square have the same ones.
const style = join(folder, 'all.json');
writeFileSync(style, JSON.stringify({version: 8, sources: {}, layers: [{id: 'all', type: 'line',
    layout: {'line-cap': 'round', 'line-join': 'round'}, paint: {'line-width': 2, 'line-color': '#204060'}}]}));
const simple = join(folder, 'simple/'), PX = 256;
const lines = ['--style', style, '--simplify-px'];
run('tiles', input, ...lines, '0.5', '--format', 'glb', '--min-zoom', '14', '--max-zoom', '14', '-q', '-o', simple);

// The points of a view that is the tile's square, px from its centre, y down; without those at the view's cuts.
function pointsOfView(place) {
    const [zoom, column, row] = place, path = join(folder, 'view.glb'), side = 2 ** zoom;
    const longitude = (column + 0.5) / side * 360 - 180;
    const latitude = Math.atan(Math.sinh(Math.PI * (1 - 2 * (row + 0.5) / side))) * 180 / Math.PI;
    run('tessellate', input, ...lines, '0.25', '--center', `${longitude},${latitude}`, '--zoom', String(zoom - 1), '--size',
        `${PX}x${PX}`, '-q', '-f', '-o', path);
    const file = readFileSync(path), text = file.readUInt32LE(12), json = JSON.parse(file.subarray(20, 20 + text));
    if (!json.meshes)
        return [];
    const {count, byteOffset} = json.accessors[json.meshes[0].primitives[0].attributes._CENTER];
    const stride = json.bufferViews[0].byteStride, start = 28 + text + byteOffset;
    return Array.from({length: count}, (_, i) => [file.readFloatLE(start + stride * i) - PX / 2,
        -file.readFloatLE(start + stride * i + 4) - PX / 2]);
}
const STEP = PX / 32768, TOLERANCE = STEP / 2 + 1 / 512; // half a unit, and the steps of the two networks
function farthest(points, from) {
    const cells = new Map(), key = (x, y) => `${Math.round(x)},${Math.round(y)}`;
    for (const [x, y] of from)
        cells.set(key(x, y), [...cells.get(key(x, y)) ?? [], [x, y]]);
    return Math.max(0, ...points.map(([x, y]) => {
        let least = 9;
        for (let dx = -1; dx <= 1; dx++)
            for (let dy = -1; dy <= 1; dy++)
                for (const [a, b] of cells.get(key(x + dx, y + dy)) ?? [])
                    least = Math.min(least, Math.max(Math.abs(a - x), Math.abs(b - y)));
        return least;
    }));
}
const compared = tilesOf(simple), apart = [0, 0];
let points = 0;
for (const tile of compared.filter((_, i) => i % Math.ceil(compared.length / 12) === 0)) {
    const read = readTile(decoder, tile.bytes), records = recordsOf(read), own = pointsOfView(tile.place);
    const scale = read.extras.tilePx / read.extras.units, inside = ([x, y]) => Math.max(Math.abs(x), Math.abs(y)) < PX / 2;
    const kept = records.filter(({flags}) => !(flags & SENTINEL)).map(({x, y}) => [x * scale, y * scale]);
    apart[0] = Math.max(apart[0], farthest(kept.filter(inside), own));
    apart[1] = Math.max(apart[1], farthest(own.filter(inside), kept));
    points += kept.length;
}
check(points > 1000, 'there are points to compare', points);
check(apart[0] <= TOLERANCE, 'each point of a tile is one of the tessellation', apart[0]);
check(apart[1] <= TOLERANCE, 'each point of the tessellation is in its tile', apart[1]);

// ---- What reaches into a tile from outside of its picture ----

// A road 20 px west of the meridian 0, where a picture of tiles begins at zoom 4; its right is the east.
const road = join(folder, 'road.geojson'), longitude = -20 / (256 * 16) * 360;
writeFileSync(road, JSON.stringify({type: 'FeatureCollection', features: [{type: 'Feature', properties: {},
    geometry: {type: 'LineString', coordinates: [[longitude, 2], [longitude, 20]]}}]}));
for (const [name, moved] of [['an offset', {'line-offset': 30}], ['a translation', {'line-translate': [30, 0]}],
    ['a translation of low zooms', {'line-translate': ['interpolate', ['linear'], ['zoom'], 3, ['literal', [30, 0]], 3.9, ['literal', [0, 0]]]}]]) {
    const path = join(folder, 'moved/');
    writeFileSync(style, JSON.stringify({version: 8, sources: {}, layers: [{id: 'road', type: 'line',
        paint: {'line-width': 2, 'line-color': '#204060', ...moved}}]}));
    run('tiles', road, '--style', style, '--format', 'glb', '--min-zoom', '4', '--max-zoom', '4', '-q', '-f', '-o', path);
    check(tilesOf(path).some(tile => tile.name === '4/8/7.glb' && readTile(decoder, tile.bytes).attributes),
        `a line with ${name} is in the tile beside it`);
}

// ---- Images are left out ----

// An image of 2 x 2 px.
writeFileSync(join(folder, 'dot.png'), Buffer.from('iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAYAAABytg0kAAAAEUlEQVR42mP4z8DwH4QZYAwAR8oH+Rq28akAAAAASUVORK5CYII=',
    'base64'));
writeFileSync(join(folder, 'dot.json'), JSON.stringify({dot: {x: 0, y: 0, width: 2, height: 2, pixelRatio: 1}}));
const fences = join(folder, 'fences.geojson'), images = join(folder, 'images/'), geometry = [[1, 1], [9, 1], [9, 9], [1, 1]];
writeFileSync(fences, JSON.stringify({type: 'FeatureCollection', features: [['LineString', geometry], ['Polygon', [geometry]]]
    .map(([type, coordinates]) => ({type: 'Feature', properties: {}, geometry: {type, coordinates}}))}));
writeFileSync(style, JSON.stringify({version: 8, sources: {}, sprite: 'dot', layers: [
    {id: 'areas', type: 'fill', paint: {'fill-pattern': 'dot'}},
    {id: 'images', type: 'line', paint: {'line-width': 4, 'line-pattern': 'dot'}},
    {id: 'lines', type: 'line', paint: {'line-width': 2, 'line-dasharray': [1, 1]}, filter: ['==', ['geometry-type'], 'LineString']}]}));
run('tiles', fences, '--style', style, '--format', 'glb', '--min-zoom', '4', '--max-zoom', '4', '-q', '-o', images);
const fenced = tilesOf(images).map(tile => readTile(decoder, tile.bytes));
check(fenced.length > 0 && fenced.every(({extras, areas}) => !areas && extras.layers.map(({id}) => id).join() === 'lines'),
    'patterns are left out', fenced.map(({extras, areas}) => [extras.layers, areas]));

// ---- Areas: what is covered, by the nonzero rule ----

// A square with a hole, another square over its corner, and a third of the next row: degrees of 2^-13 turns, from the
// corner of a tile of zoom 10 that is 8 such units wide; near the equator rows are as high.
const UNIT = 360 / 2 ** 13, square = (x, y, side) => [[x, y], [x + side, y], [x + side, y + side], [x, y + side], [x, y]]
    .map(([a, b]) => [a * UNIT, b * UNIT]);
const polygon = (kind, ...rings) => ({type: 'Feature', properties: {kind}, geometry: {type: 'Polygon', coordinates: rings}});
const fields = join(folder, 'fields.geojson'), colors = join(folder, 'colors.json'), filled = join(folder, 'filled/');
writeFileSync(fields, JSON.stringify({type: 'FeatureCollection', features: [
    polygon('a', square(1, 1, 4), square(2, 2, 1).reverse()), polygon('a', square(4, 4, 2)), polygon('b', square(6, 1, 4))]}));
writeFileSync(colors, JSON.stringify({version: 8, sources: {}, layers: [{id: 'fields', type: 'fill', paint:
    {'fill-color': ['match', ['get', 'kind'], 'a', '#204060', '#a0b0c0'], 'fill-opacity': ['interpolate', ['linear'], ['zoom'], 9, 0.5, 10, 1]}}]}));
const areas = spawnSync(tool, ['tiles', fields, '--style', colors, '--format', 'glb', '--min-zoom', '10', '--max-zoom', '10',
    '-q', '-o', filled], {encoding: 'utf8'});
if (areas.stderr.includes('need GLU')) {
    check(areas.status === 69, 'a lack of GLU is told', areas.status);
    console.log('ok - areas are left out, here and where bytes are compared: no GLU (Debian: libglu1-mesa)');
} else {
    const made = tilesOf(filled), covered = {}, sampled = new Set();
    check((await judge(made)).length === 0, 'areas are valid');
    for (const tile of made) {
        const {extras: {units, layers}, areas: {_POINT, indices}} = readTile(decoder, tile.bytes);
        for (const {indices: [first, count], paints} of layers)
            for (let i = first; i < first + count; i += 3) {
                const [a, b, c] = indices.slice(i, i + 3).map(k => _POINT[k]), key = paints[a[2]].color;
                covered[key] = (covered[key] ?? 0) + inside(a, b, c, units);
                sampled.add(paints[a[2]].opacity.join());
            }
    }
    // Two squares with a side in common: the tessellator replaces the corners there.
    writeFileSync(fields, JSON.stringify({type: 'FeatureCollection', features: [polygon('a', square(1, 1, 2)), polygon('a', square(3, 1, 2))]}));
    writeFileSync(colors, JSON.stringify({version: 8, sources: {}, layers: [{id: 'fields', type: 'fill', paint: {'fill-color': '#204060'}}]}));
    run('tiles', fields, '--style', colors, '--format', 'glb', '--min-zoom', '10', '--max-zoom', '10', '-q', '-f', '-o', join(folder, 'twins/'));
    for (const {bytes} of tilesOf(join(folder, 'twins/'))) {
        const {json: {materials}, areas: {_POINT, indices}} = readTile(decoder, bytes);
        check(_POINT.length === new Set(indices).size, 'each corner is one of a triangle', [_POINT, indices]);
        check(!materials[0].alphaMode, 'opaque areas are not blended', materials);
    }
    // Those beside the meridian that are drawn beyond it, as far as they are moved.
    writeFileSync(fields, JSON.stringify({type: 'FeatureCollection', features: [polygon('a', square(-4, 1, 4))]}));
    writeFileSync(colors, JSON.stringify({version: 8, sources: {}, layers: [{id: 'fields', type: 'fill',
        paint: {'fill-color': '#204060', 'fill-translate': [30, 0]}}]}));
    run('tiles', fields, '--style', colors, '--format', 'glb', '--min-zoom', '10', '--max-zoom', '10', '-q', '-f', '-o', join(folder, 'moved/'));
    const beside = tilesOf(join(folder, 'moved/')).find(({name}) => name === '10/512/511.glb');
    const reached = beside ? Math.min(...readTile(decoder, beside.bytes).areas._POINT.map(([x]) => x)) : 0;
    check(reached <= -16384 - 30 * 128, 'an area with a translation reaches as far', reached);
    check([...sampled].join(' ') === '0.5,0.625,0.75,0.875,1', 'opacities are sampled', [...sampled]);
    const unit = 16 * 16; // points of the grid a square unit
    check(Math.abs(covered['#204060'] / unit - 18) < 0.3, 'a hole and an overlap', covered);
    check(Math.abs(covered['#a0b0c0'] / unit - 16) < 0.3, 'an area over two tiles', covered);
}
// How many points of a grid of 128 x 128 over the tile lie in a triangle.
function inside(a, b, c, units) {
    const step = units / 128, side = (p, q, x, y) => (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]);
    let count = 0;
    for (let i = 0; i < 128; i++)
        for (let k = 0; k < 128; k++) {
            const x = (i + 0.37) * step - units / 2, y = (k + 0.61) * step - units / 2; // on no diagonal
            const sides = [side(a, b, x, y), side(b, c, x, y), side(c, a, x, y)];
            count += sides.every(s => s < 0) || sides.every(s => s > 0);
        }
    return count;
}

// ---- The same bytes however they are drawn ----

// Archives of an input, in a folder.
function compare(what, input, options, folder) {
    const archive = (name, ...more) => {
        const path = join(folder, name);
        run('tiles', input, ...options, ...more, '-o', path);
        return readFileSync(path);
    };
    const whole = archive('whole.pmtiles');
    check(archive('one.pmtiles', '--threads', '1', '--name', 'whole').equals(whole), `${what} by one thread`);
    check(archive('three.pmtiles', '--threads', '3', '--name', 'whole').equals(whole), `${what} by three threads`);
    check(archive('small.pmtiles', '--memory', '64M', '--name', 'whole').equals(whole), `${what} with little memory`);
    const parts = [1, 2, 3].map(part => {
        run('tiles', input, ...options, '--name', 'whole', '--shard', `${part}/3`, '-o', join(folder, 'part.pmtiles'));
        return join(folder, `part.${part}-of-3.pmtiles`);
    });
    run('tiles', 'merge', ...parts, '-q', '-o', join(folder, 'merged.pmtiles'));
    check(readFileSync(join(folder, 'merged.pmtiles')).equals(whole), `${what} in three parts`);
}
compare('lines', input, options, folder);
if (!areas.stderr.includes('need GLU')) {
    const city = join(folder, 'areas/');
    mkdirSync(city);
    compare('areas', fileURLToPath(new URL('../data/monaco/monaco.osm.pbf', import.meta.url)),
        ['--format', 'glb', '--min-zoom', '15', '--max-zoom', '16', '-q'], city);
}
run('tiles', input, ...options, '--name', 'whole', '--resume', '-o', join(folder, 'whole.pmtiles'));
for (const path of [drawn, join(folder, 'whole.pmtiles')])
    check(spawnSync(tool, ['tiles', 'verify', path, '-q']).status === 0, `${path} keeps its promises`);
const shown = JSON.parse(run('tiles', 'show', join(folder, 'whole.pmtiles'), '--json'));
check(shown.type === 'glb' && shown.tiles === tiles.length, 'an archive says what it has', shown);
check(!readdirSync(drawn, {recursive: true}).some(name => name.endsWith('.png')), 'nothing but meshes');

// ---- The tileset names the tiles that there are, and no others ----

function subtree(level, x, y) {
    const file = readFileSync(join(drawn, 'subtrees', `${level}.${x}.${y}.subtree`)), text = Number(file.readBigUInt64LE(8));
    const json = JSON.parse(file.subarray(24, 24 + text).toString()), binary = file.subarray(24 + text);
    const has = part => {
        if (part.bitstream === undefined)
            return () => part.constant === 1;
        const {byteOffset} = json.bufferViews[part.bitstream];
        return bit => binary[byteOffset + (bit >> 3)] >> (bit & 7) & 1;
    };
    return {tile: has(json.tileAvailability), content: has(json.contentAvailability[0]), child: has(json.childSubtreeAvailability)};
}
const set = JSON.parse(readFileSync(join(drawn, 'tileset.json'))), {subtreeLevels, availableLevels} = set.root.implicitTiling;
const named = [];
function walk(root, level, x, y, levels, at) {
    const offset = (4 ** levels - 1) / 3;
    if (levels === subtreeLevels) {
        if (root.child(at) && level < availableLevels)
            walk(subtree(level, x, y), level, x, y, 0, 0);
        return;
    }
    if (!root.tile(offset + at))
        return;
    if (root.content(offset + at))
        named.push([level, x, y].join('/'));
    for (let k = 0; k < 4; k++)
        walk(root, level + 1, 2 * x + (k & 1), 2 * y + (k >> 1), levels + 1, 4 * at + k);
}
walk(subtree(0, 0, 0), 0, 0, 0, 0, 0);
check(named.sort().join() === tiles.map(({place}) => place.join('/')).sort().join(), 'the tileset has the tiles', named.length);

// ---- Errors ----

const refused = spawnSync(tool, ['tiles', input, '--format', 'glb', '--keep-empty', '-o', join(folder, 'no/')], {encoding: 'utf8'});
check(refused.status === 2 && refused.stderr.includes('--keep-empty'), 'empty tiles are refused', refused.stderr);
process.exit(failures ? 1 : 0);
