"""Makes the folder that compare.mjs reads: public styles with their sprites, glyphs and tiles.

usage: prepare.py CAMBER CLONES NODE_MODULES DATA OUT

CLONES has clones of the repositories in the table below, each in a folder NAME or OWNER+NAME/repo; NODE_MODULES has
npm's protomaps-themes-base 4; DATA has the cities' files of OpenStreetMap. Needed: git, node, tilemaker (Debian). The
commits are fixed, so all who make the folder compare the same styles. OUT then has:

    styles/NAME/style.json, sprite.json, sprite.png     {root} stands for OUT in URLs, {city} for a city
    fonts/STACK/RANGE.pbf                               one folder for each stack of fonts that a style names
    tiles/CITY-openmaptiles.pmtiles, CITY-protomaps.pmtiles
"""

import gzip
import json
import pathlib
import subprocess
import sys

COMMITS = {
    "osm-bright-gl-style": ("8af4769692d0f9219d0936711609d580b34bf365", "03a529f9040cfdfd3a30fb6760fc96d0ae41cf39"),
    "positron-gl-style": ("bed9a6349dfb431bd8a6646101d0977b59c591dd", "98f91afa38671a885947d721075bdc88392c1b78"),
    "dark-matter-gl-style": ("d17442cb66bad8c82bda59d199d5dafeead410cf", "9769cd7a3642e607bb867c4c0c18bed714f52f5a"),
    "osm-liberty": ("6be24740ce8569208554848cd59ea903bb27f234",),
    "openfreemap-styles": ("72e1480dfc92858d334647037988bd2591fdb021",),
    "basemaps-assets": ("f12391e9bcf40f9b727c48df01cb5edf2a119d27",),
    "fonts": ("6b25d7976fa5b2d2cf74927dc5624e65a0fb89ad",),
    "font-glyphs": ("db9deb30cd0cea018918bd19eb82a2c48af6426e",),
}
OWNERS = {"osm-liberty": "maputnik", "openfreemap-styles": "hyperknot", "basemaps-assets": "protomaps",
          "font-glyphs": "orangemug"}
OFM_SPRITE = "sprites/sprites/ofm_f384/ofm"
# Style: repository, path of the style, repository's commit that has the sprite, path of the sprite.
STYLES = {
    "osm-bright": ("osm-bright-gl-style", "style.json", 1, "sprite"),
    "positron": ("positron-gl-style", "style.json", 1, "sprite"),
    "dark-matter": ("dark-matter-gl-style", "style.json", 1, "sprite"),
    "liberty": ("osm-liberty", "style.json", 0, "sprites/osm-liberty"),
    "ofm-bright": ("openfreemap-styles", "styles/bright/style.json", 0, OFM_SPRITE),
    "ofm-liberty": ("openfreemap-styles", "styles/liberty/style.json", 0, OFM_SPRITE),
    "ofm-positron": ("openfreemap-styles", "styles/positron/style.json", 0, OFM_SPRITE),
    "ofm-dark": ("openfreemap-styles", "styles/dark/style.json", 0, OFM_SPRITE),
    "ofm-fiord": ("openfreemap-styles", "styles/fiord/style.json", 0, OFM_SPRITE),
}
PROTOMAPS = ("light", "dark")
CITIES = {"porto": "porto_portugal.osm.pbf", "newyork": "nyc.osm.pbf",
          "liechtenstein": "liechtenstein-latest.osm.pbf"}
# Where a font's glyphs are: repository and folder; others are looked for under their names in these repositories.
GLYPHS = {
    "Noto Sans Regular": ("basemaps-assets", "fonts/Noto Sans Regular"),
    "Noto Sans Medium": ("basemaps-assets", "fonts/Noto Sans Medium"),
    "Noto Sans Italic": ("basemaps-assets", "fonts/Noto Sans Italic"),
    "Noto Sans Bold": ("fonts", "Klokantech Noto Sans Bold"),
    "Roboto": ("font-glyphs", "glyphs/{font}"),
    "Metropolis": ("fonts", "{font}"),
}
LAST_ZOOM = 16
RANGES = [range(first, first + 256) for first in range(0, 0x3000, 256)]
THEME = """import(process.argv[1]).then(themes => console.log(JSON.stringify(
    themes.layers('protomaps', themes.namedTheme(process.argv[2]), {lang: 'en'}))))"""


def git_folder(clones, repository):
    owner = OWNERS.get(repository, "openmaptiles")
    for folder in (clones / repository, clones / f"{owner}+{repository}" / "repo"):
        if folder.is_dir():
            return folder
    sys.exit(f"{clones} has no clone of {owner}/{repository}")


def read_blob(clones, repository, path, commit=0):
    """A file of a repository, None if it has none."""
    command = ["git", "-C", git_folder(clones, repository), "show", f"{COMMITS[repository][commit]}:{path}"]
    done = subprocess.run(command, capture_output=True, check=False)
    return done.stdout if done.returncode == 0 else None


def write_style(folder, style, tiles, sprite):
    """Writes a style whose tiles, sprite and glyphs are files of the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    for extension, data in sprite.items():
        (folder / f"sprite.{extension}").write_bytes(data)
    for source in style["sources"].values():
        if source["type"] == "vector":
            source["url"] = f"pmtiles://{{root}}/tiles/{{city}}-{tiles}.pmtiles"
    style["sprite"] = f"{{root}}/styles/{folder.name}/sprite"
    style["glyphs"] = "{root}/fonts/{fontstack}/{range}.pbf"
    (folder / "style.json").write_text(json.dumps(style, indent=1))


def read_sprite(clones, repository, path, commit):
    return {extension: read_blob(clones, repository, f"{path}.{extension}", commit) for extension in ("json", "png")}


def write_styles(clones, modules, out):
    for name, (repository, path, commit, sprite) in STYLES.items():
        style = json.loads(read_blob(clones, repository, path))
        files = read_sprite(clones, repository, sprite, commit)
        write_style(out / "styles" / name, style, "openmaptiles", files)
    module = modules / "protomaps-themes-base" / "dist" / "esm" / "index.js"
    for theme in PROTOMAPS:
        command = ["node", "-e", THEME, module.resolve(), theme]
        layers = json.loads(subprocess.run(command, capture_output=True, check=True).stdout)
        style = {"version": 8, "sources": {"protomaps": {"type": "vector"}}, "layers": layers}
        files = read_sprite(clones, "basemaps-assets", f"sprites/v4/{theme}", 0)
        write_style(out / "styles" / f"protomaps-{theme}", style, "protomaps", files)


# ---- Glyphs ----


def find_stacks(value, stacks):
    """Adds all arrays of names that may be stacks of fonts, in an expression or an option of it."""
    if isinstance(value, list):
        names = [name for name in value if isinstance(name, str)]
        if names and len(names) == len(value) and all(name[0].isupper() for name in names):
            stacks.add(tuple(names))
        for item in value:
            find_stacks(item, stacks)
    elif isinstance(value, dict):
        for item in value.values():
            find_stacks(item, stacks)


def fields_of(data):
    """The fields of a message: number, its value (bytes or an integer), all its bytes."""
    at = 0
    while at < len(data):
        begin = at
        key, at = read_varint(data, at)
        if key & 7 == 2:
            size, at = read_varint(data, at)
            yield key >> 3, data[at : at + size], data[begin : at + size]
            at += size
        elif key & 7 == 0:
            value, at = read_varint(data, at)
            yield key >> 3, value, data[begin:at]
        else:
            raise ValueError(f"a glyph's field of type {key & 7}")


def read_varint(data, at):
    value = shift = 0
    while True:
        value |= (data[at] & 127) << shift
        shift += 7
        at += 1
        if data[at - 1] < 128:
            return value, at


def varint(value):
    out = bytearray()
    while value > 127:
        out.append(value & 127 | 128)
        value >>= 7
    return bytes(out + bytes([value]))


def message(number, data):
    return varint(number << 3 | 2) + varint(len(data)) + data


def combine(stack, span, files):
    """A range of a stack of fonts: each glyph of the first font that has it."""
    glyphs = {}
    for data in files:
        for _, font, _ in fields_of(data):
            for number, glyph, whole in fields_of(font):
                if number == 3:
                    code = next(value for field, value, _ in fields_of(glyph) if field == 1)
                    glyphs.setdefault(code, whole)
    head = message(1, ", ".join(stack).encode()) + message(2, f"{span[0]}-{span[-1]}".encode())
    return message(1, head + b"".join(glyphs[code] for code in sorted(glyphs)))


def write_glyphs(clones, out):
    stacks = set()
    for path in out.glob("styles/*/style.json"):
        for layer in json.loads(path.read_text())["layers"]:
            layout = layer.get("layout", {})
            find_stacks(layout.get("text-font", []), stacks)
            find_stacks(layout.get("text-field", []), stacks)
    for stack in sorted(stacks):
        places = []
        for font in stack:
            key = font if font in GLYPHS else font.split()[0]
            if key in GLYPHS:
                places.append((GLYPHS[key][0], GLYPHS[key][1].format(font=font)))
        if len(places) != len(stack):
            continue  # no fonts, or one that no text of these cities needs
        folder = out / "fonts" / ",".join(stack)
        folder.mkdir(parents=True, exist_ok=True)
        for span in RANGES:
            name = f"{span[0]}-{span[-1]}.pbf"
            files = [read_blob(clones, repository, f"{path}/{name}") for repository, path in places]
            (folder / name).write_bytes(combine(stack, span, [unzip(data) for data in files if data]))
        print(f"{', '.join(stack)}")


def unzip(data):
    return gzip.decompress(data) if data[:2] == b"\x1f\x8b" else data


# ---- Tiles ----


def make_tiles(camber, city, config, profile, out):
    """Layers of shapefiles, such as the sea, are left out. Tiles go on to zoom 16, so that neither side has to draw
    tiles of another zoom."""
    document = json.loads(config.read_text())
    layers = {name: layer for name, layer in document["layers"].items() if "source" not in layer}
    for layer in layers.values():
        layer["maxzoom"] = LAST_ZOOM if layer["maxzoom"] >= document["settings"]["maxzoom"] else layer["maxzoom"]
    document["layers"] = layers
    document["settings"] |= {"maxzoom": LAST_ZOOM, "basezoom": LAST_ZOOM}
    settings, made = out.with_suffix(".json"), out.with_suffix(".mbtiles")
    settings.write_text(json.dumps(document))
    made.unlink(missing_ok=True)
    command = ["tilemaker", "--input", city, "--output", made, "--config", settings, "--process", profile]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    subprocess.run([camber, "tiles", "merge", "-q", "-f", made, "-o", out], check=True)
    made.unlink()
    settings.unlink()


def main(camber, clones, modules, data, out):
    clones, modules, data, out = (pathlib.Path(path) for path in (clones, modules, data, out))
    own, examples = pathlib.Path(__file__).parent, pathlib.Path("/usr/share/doc/tilemaker/examples")
    write_styles(clones, modules, out)
    write_glyphs(clones, out)
    (out / "tiles").mkdir(exist_ok=True)
    for name, file in CITIES.items():
        for schema, folder, stem in (("openmaptiles", examples, "-openmaptiles"), ("protomaps", own, "")):
            config = folder / ("config-openmaptiles.json" if stem else "protomaps.json")
            profile = folder / ("process-openmaptiles.lua" if stem else "protomaps.lua")
            make_tiles(camber, data / file, config, profile, out / "tiles" / f"{name}-{schema}.pmtiles")


if __name__ == "__main__":
    main(*sys.argv[1:])
