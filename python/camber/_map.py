"""Maps: files drawn with a style, into arrays, pages or archives of tiles."""

import difflib
import importlib
import json
import math
import os
import re
import sys
import tempfile
import warnings

import numpy

from ._core import (TABLE_PREFIX, ArgumentError, FileError, NotFoundError, as_path, as_text, default, ffi, lib, pick,
                    text_of)
from ._draw import ENCODINGS, METHODS, TAKE_ROWS, as_output, as_size, encode, render_frame

THEMES = {"light": lib.CAMBER_THEME_LIGHT, "dark": lib.CAMBER_THEME_DARK}
SIMPLIFY_PX = 0.1  # as in camber render
PAGES = {".pdf": lib.CAMBER_PAGE_PDF, ".svg": lib.CAMBER_PAGE_SVG}
PICTURES = {".png": "png", ".webp": "webp"}
FITS = {"contain": False, "cover": True}
MARGIN_SHARE, PRINTED_DPI = 0.04, 300  # as in camber render
PLOTTED = ("column", "cmap", "vmin", "vmax", "legend", "color", "width", "missing")  # arguments of camber.plot
VIEWED = ("center", "zoom", "bbox", "bearing", "pitch", "size", "ratio", "simplify", "method", "premultiplied", "out")
WRITE = ffi.addressof(lib, "camber_python_write")


def styles():
    """Returns the names of the built-in styles."""
    names = []
    while (name := text_of(lib.camber_style_list(len(names)))) is not None:
        names.append(name)
    return names


def read_style(style, theme):
    """Returns (document as bytes, its name in messages, the file that its paths are relative to)."""
    if isinstance(style, dict):
        return json.dumps(style).encode(), b"style", None
    try:
        path = as_path(style)
    except TypeError:
        raise TypeError("style is of type %s; give a file, a dictionary, or the name of a built-in style: %s"
                        % (type(style).__name__, ", ".join(styles()))) from None
    if not os.path.exists(path):
        size = ffi.new("size_t *")
        text = lib.camber_style_get_text(path, theme, size)
        if text == ffi.NULL:
            raise NotFoundError("%s: neither a file nor a built-in style; name a style document, or one of: %s"
                                % (os.fsdecode(path), ", ".join(styles())))
        return bytes(ffi.buffer(text, size[0])), path, None
    with open(path, "rb") as file:
        return file.read(), path, path


def refuse_unknown(unknown, known):
    """Refuses arguments that a map does not have."""
    for name in unknown:
        if name in PLOTTED:
            raise TypeError("%s= is for lines without a style: camber.plot(data, %s=...); a map looks as its style= says"
                            % (name, name))
        near = difflib.get_close_matches(name, known, 1)
        raise TypeError("there is no argument %r; %s" % (name, "is it %s=?" % near[0] if near else "give %s"
                                                         % ", ".join(known)))


def as_numbers(values, what, names):
    """Returns numbers, one for each name."""
    try:
        numbers = [float(each) for each in values]
    except (TypeError, ValueError):
        numbers = []
    if len(numbers) != len(names):
        raise ArgumentError("%s is %r; give %s: %s" % (what, values, ("two numbers", "four numbers")[len(names) > 2],
                                                       ", ".join(names)))
    return numbers


def as_view(center, zoom, bbox, bearing, pitch, size, ratio, own=None):
    """Makes a view. own: the style's view, which is used if neither center nor bbox is given."""
    width, height = as_size(size)
    view = {"width": width, "height": height, "ratio": ratio, "bearing_deg": bearing, "pitch_deg": pitch}
    if bbox is not None:
        if center is not None or zoom is not None:
            raise ArgumentError("a bbox cannot be combined with a center or zoom; give one or the other")
        west, south, east, north = as_numbers(bbox, "bbox", ("west", "south", "east", "north"))
        view.update(kind=lib.CAMBER_VIEW_BBOX, west=west, south=south, east=east, north=north)
    elif center is not None or own is not None:
        if zoom is None and own is None:
            raise ArgumentError("there is a center without a zoom; give both")
        longitude, latitude = (own.longitude, own.latitude) if center is None else as_numbers(
            center, "center", ("longitude", "latitude"))
        view.update(kind=lib.CAMBER_VIEW_CENTER, longitude=float(longitude), latitude=float(latitude),
                    zoom=float(zoom if zoom is not None else own.zoom))
    elif zoom is not None:
        raise ArgumentError("there is a zoom without a center; give both")
    return view


def as_paper(paper, size, landscape):
    """Returns the width and height of a sheet in mm: by its name, by millimetres, or of a picture of a size in CSS px."""
    if paper is None and size is not None:
        width, height = (25.4 / 96 * side for side in as_size(size))
    elif paper is None or isinstance(paper, str):
        found = ffi.new("double[2]")
        if not lib.camber_paper_find(as_text("A4" if paper is None else paper), found, found + 1):
            raise ArgumentError("paper is %r; give A0 to A6, B0 to B6, Letter, Legal, Tabloid, or width and height in mm"
                                % paper)
        width, height = found
    else:
        try:
            width, height = map(float, paper)
        except (TypeError, ValueError):
            raise ArgumentError("paper is %r; give a name like \"A4\", or width and height in mm" % (paper,)) from None
    return (height, width) if landscape and width < height else (width, height)


def translate(core, text, name, language):
    """Returns a style document that prefers names in a language."""
    made = ffi.new("char **")
    core.check(lib.camber_style_translate(core.pointer, text, len(text), name, as_text(language), made))
    try:
        return ffi.string(made[0])
    finally:
        lib.camber_style_free_text(core.pointer, made[0])


def as_json(value):
    """Makes a value of a column fit for JSON: numpy's numbers, dates; None if it is missing or infinite."""
    if isinstance(value, numpy.generic) and value.dtype.kind in "biuf":
        value = value.item()
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if value is None or isinstance(value, (bool, int, str)):
        return value
    pandas = sys.modules.get("pandas")
    return None if pandas and (value is pandas.NA or value is pandas.NaT) else str(value)


def find_geojson(geometries):
    """Returns each geometry as GeoJSON."""
    try:
        return importlib.import_module("shapely").to_geojson(numpy.asarray(geometries, dtype=object))
    except (ImportError, AttributeError):  # Shapely 1
        return [None if each is None else json.dumps(each.__geo_interface__) for each in geometries]


def write_frame(frame, file):
    """Writes a GeoDataFrame or a GeoSeries as GeoJSON."""
    crs = getattr(frame, "crs", None)
    if crs is None:
        raise ArgumentError("the data does not say its CRS; tell it first, as in data.set_crs(\"EPSG:4326\")")
    if len(frame) and (frame.geometry.isna() | frame.geometry.is_empty).all():
        raise ArgumentError("none of the data's %d rows has a geometry" % len(frame))
    if not (crs.is_geographic and crs.to_epsg() == 4326):
        frame = frame.to_crs(4326)
    columns = [(str(name), frame.iloc[:, i].tolist()) for i, name in enumerate(getattr(frame, "columns", ()))
               if name != frame.geometry.name]  # by number, because names may occur twice
    file.write('{"type":"FeatureCollection","name":"data","features":[\n')
    for i, geometry in enumerate(find_geojson(frame.geometry.values)):
        properties = {name: as_json(column[i]) for name, column in columns}
        file.write('%s{"type":"Feature","properties":%s,"geometry":%s}\n'
                   % ("," if i else "", json.dumps(properties), geometry or "null"))
    file.write("]}\n")


class Map:
    """Files with a style, or GeoDataFrames. They are read once; draw() moves the view over them.

    labels: whether the style's symbol layers are drawn. fonts: folders that are searched for fonts before the system's.
    language: the code of the language of names, such as "de"; None: the local names.
    """

    def __init__(self, *inputs, style=None, theme="light", layer=None, where=None, labels=True, fonts=(), language=None,
                 context=None, **unknown):
        refuse_unknown(unknown, ("style", "theme", "layer", "where", "labels", "fonts", "language", "context"))
        if isinstance(fonts, (str, bytes, os.PathLike)):
            fonts = (fonts,)
        self._context = default(context)
        self._labels, self._fonts = labels, [as_path(folder) for folder in fonts]
        self._kept = []  # temporary files, which are deleted with the map
        self._inputs = [self._as_file(each) for each in inputs]
        self._layer, self._where = as_text(layer), as_text(where)
        self._scene = self._mesh = self._features = None
        self._read_for = None  # the view that the features were read for; None: everything was read
        self._once = False
        theme = pick(THEMES, "theme", theme)
        if style is None and language is not None:
            style = styles()[0]
        text, name, self._base = (None, None, None) if style is None else read_style(style, theme)
        with self._context._core as core:
            if text is None:
                self._style = core.make(lib.camber_style_create_builtin, core.pointer, theme)
            else:
                text = text if language is None else translate(core, text, name, language)
                self._style = core.make(lib.camber_style_parse, core.pointer, text, len(text), name)

    def _as_file(self, given):
        """Returns the path of a file; a GeoDataFrame becomes one."""
        if not hasattr(given, "geom_type") or not hasattr(given, "to_crs"):
            try:
                return as_path(given)
            except TypeError:
                raise TypeError("an input is of type %s; give a file, or a GeoDataFrame. camber.plot(data) draws lines of "
                                "other kinds" % type(given).__name__) from None
        file = tempfile.NamedTemporaryFile("w", prefix=TABLE_PREFIX, suffix=".geojson", encoding="utf-8")
        self._kept.append(file)
        write_frame(given, file)
        file.flush()
        return as_path(file.name)

    def _read(self, core, view, once):
        """Reads the files, completely or for one view; or the style's own sources, for this view."""
        wanted = None if self._inputs and not once else view
        if self._features is not None and self._read_for in (None, wanted):
            return
        self._scene = None
        self._features = None
        features = core.make(lib.camber_features_create, core.pointer, self._style)
        base = ffi.NULL if self._base is None else self._base
        if self._labels:
            folders = [ffi.new("char[]", folder) for folder in self._fonts]
            pointers = ffi.new("char *[]", folders)  # which a structure does not keep alive
            fonts = ffi.new("camber_fonts_desc *", {"folders": pointers, "folder_count": len(folders)})
            core.check(lib.camber_features_read_fonts(features, fonts, base))
        if self._inputs and once:
            desc = ffi.new("camber_scene_desc *", {"view": view, "simplify_px": SIMPLIFY_PX})
            core.check(lib.camber_features_read_for(features, desc))
        for path in self._inputs:
            path = ffi.new("char[]", path)
            desc = ffi.new("camber_source_desc *", {"path": path, "layer": self._layer, "where": self._where})
            core.check(lib.camber_features_read(features, desc))
        if not self._inputs:
            core.check(lib.camber_features_read_sources(features, ffi.new("camber_view_desc *", view), base))
        core.check(lib.camber_features_read_sprites(features, (view or {"ratio": 1})["ratio"], base))
        self._features, self._read_for = features, wanted

    def _move(self, core, view, simplify, once=False):
        """Moves the scene to a view."""
        self._read(core, view, once)
        if self._scene is not None and self._simplify == simplify:
            core.check(lib.camber_scene_move(self._scene, ffi.new("camber_view_desc *", view)))
            return
        desc = ffi.new("camber_scene_desc *", {"view": view, "simplify_px": simplify,
                                               "use": lib.CAMBER_SCENE_ONE_VIEW if once else lib.CAMBER_SCENE_VIEWS})
        self._scene = core.make(lib.camber_scene_create, self._features, desc)
        self._simplify = simplify

    def _view(self, center, zoom, bbox, bearing, pitch, size, ratio):
        own = None if self._inputs else lib.camber_style_get_view(self._style)
        if own is not None:
            bearing = own.bearing_deg if bearing is None else bearing
            pitch = own.pitch_deg if pitch is None else pitch
        return as_view(center, zoom, bbox, bearing or 0, pitch or 0, size, ratio, own)

    def _warn_of_nothing(self):
        """Says why a picture is empty, if it is."""
        info = lib.camber_scene_get_info(self._scene)
        if lib.camber_mesh_get_info(self._mesh).bytes or info.labels:
            return
        text = ffi.new("char[1024]")
        lib.camber_features_explain_nothing(self._features, info.zoom, info.zoom, text, len(text))
        why = re.sub(r"--bbox ([-+.,e\d]+)", r"bbox=(\1)", text_of(text))
        warnings.warn("the picture is empty: %s" % re.sub(r"--(\w+)", r"\1=", why), stacklevel=3)

    def draw(self, *, center=None, zoom=None, bbox=None, bearing=None, pitch=None, size=(1024, 1024), ratio=1,
             simplify=SIMPLIFY_PX, method="strip", premultiplied=False, out=None, **unknown):
        """Draws a view into an array. Without center, zoom and bbox it shows everything that the style draws."""
        refuse_unknown(unknown, VIEWED)
        view = self._view(center, zoom, bbox, bearing, pitch, size, ratio)
        with self._context._core as core:
            device, renderer, _ = self._context._open(core)
            self._move(core, view, simplify, self._once)
            if self._mesh is None:
                self._mesh = core.make(lib.camber_mesh_create, device, renderer)
            core.check(lib.camber_scene_tessellate(self._scene, self._mesh, pick(METHODS, "method", method)))
            self._warn_of_nothing()
            frame = ffi.new("camber_frame *")
            frame[0] = lib.camber_scene_get_frame(self._scene, self._mesh)
            return render_frame(core, renderer, frame, out, premultiplied)

    def _repr_png_(self):
        return encode(self.draw(), context=self._context)

    def save(self, path, *, paper=None, landscape=False, margin=None, dpi=None, title=None, subtitle=None, scale_bar=False,
             north_arrow=False, grid=False, fit=None, size=None, ratio=None, quality=None, simplify=SIMPLIFY_PX, **view):
        """Draws a view into a file: a picture (.png, .webp), or a sheet of paper (.pdf, .svg, or .png with paper=).

        paper: "A4" and other names, or width and height in mm. margin: in mm. fit: without a center, "cover" fills the
        sheet, and "contain" shows everything. The view is that of draw().
        """
        ending = os.path.splitext(os.fsdecode(path))[1].lower()
        sheet = {"title": title, "subtitle": subtitle, "scale_bar": scale_bar, "north_arrow": north_arrow, "grid": grid}
        if ending not in PAGES and ending not in PICTURES:
            raise ArgumentError("%s: a map is saved as %s" % (os.fsdecode(path), ", ".join([*PICTURES, *PAGES])))
        if ending not in PAGES and paper is None:
            asked = [name for name, value in {**sheet, "landscape": landscape, "margin": margin, "fit": fit}.items() if value]
            if asked:
                raise ArgumentError("%s= needs a sheet; give paper=\"A4\", or save a .pdf" % asked[0])
            picture = self.draw(size=size or (1024, 1024), ratio=ratio or 1, simplify=simplify, **view)
            return self._write(path, encode(picture, PICTURES[ending], quality=quality, dpi=dpi or 0, context=self._context))
        if paper is not None and size is not None:
            raise ArgumentError("both paper and size are given; give one of them")
        dpi = PRINTED_DPI if dpi is None else dpi
        width, height = as_paper(paper, size, landscape)
        if margin is None:
            margin = 0 if size is not None and not (title or subtitle) else MARGIN_SHARE * min(width, height)
        texts = {name: as_text(sheet[name]) for name in ("title", "subtitle")}
        folders = [ffi.new("char[]", folder) for folder in self._fonts]
        pointers = ffi.new("char *[]", folders)
        fonts = ffi.new("camber_fonts_desc *", {"folders": pointers, "folder_count": len(folders)})
        desc = ffi.new("camber_page_desc *", {**sheet, **texts, "fonts": fonts, "width_mm": width, "height_mm": height,
                                              "margin_mm": margin, "dpi": dpi, "ratio": ratio or 0})
        made = self._print(path, PAGES.get(ending), desc, fit, simplify, view)
        if made is not None:
            self._write(path, encode(made, PICTURES[ending], quality=quality, dpi=dpi, context=self._context))

    @staticmethod
    def _write(path, data):
        with open(path, "wb") as file:
            file.write(data)

    def _print(self, path, format, desc, fit, simplify, asked):
        """Writes a page into a file; without a format, returns it as a picture."""
        asked = {"center": None, "zoom": None, "bbox": None, "bearing": None, "pitch": None, **asked}
        unknown = [name for name in asked if name not in ("center", "zoom", "bbox", "bearing", "pitch")]
        refuse_unknown(unknown, VIEWED[:5])
        if fit is not None and asked["center"] is not None:
            raise ArgumentError("center and zoom already say what is shown; leave fit out")
        view = self._view(**asked, size=(1024, 1024), ratio=1)
        is_fitted = "kind" not in view
        view["cover"] = is_fitted if fit is None else pick(FITS, "fit", fit)
        with self._context._core as core:
            device, renderer, _ = self._context._open(core)
            page = core.make(lib.camber_page_create, core.pointer, desc)
            sized = ffi.new("camber_view_desc *", view)
            lib.camber_page_set_view(page, sized)
            view.update(width=sized.width, height=sized.height, ratio=sized.ratio)
            self._move(core, view, simplify)
            core.check(lib.camber_page_set_credit(page, lib.camber_features_get_attribution(self._features)))
            mesh = core.make(lib.camber_mesh_create, device, renderer)
            if format is None:
                return self._print_picture(core, page, renderer, mesh)
            part = as_path(path) + b".part"
            file = lib.camber_python_open(part)
            if file == ffi.NULL:
                raise FileError("%s: cannot be written: %s" % (os.fsdecode(path), os.strerror(ffi.errno)))
            try:
                try:
                    core.check(lib.camber_page_write(page, self._scene, renderer, mesh, format,
                                                     {"write": WRITE, "user": file}))
                finally:
                    is_written = lib.camber_python_close(file)
                if not is_written:
                    raise FileError("%s: cannot be written: %s" % (os.fsdecode(path), os.strerror(ffi.errno)))
                os.replace(part, as_path(path))
            except BaseException:
                os.unlink(part)
                raise

    def _print_picture(self, core, page, renderer, mesh):
        info = lib.camber_page_get_info(page)
        out = as_output(None, info.width, info.height)
        picture = ffi.new("camber_python_picture *", {"rgba": ffi.cast("uint8_t *", out.ctypes.data),
                                                      "stride_bytes": out.strides[0], "width": info.width})
        core.check(lib.camber_scene_tessellate(self._scene, mesh, METHODS["strip"]))
        core.check(lib.camber_page_render(page, self._scene, renderer, mesh, TAKE_ROWS, picture, ffi.NULL))
        return out

    def lines(self, *, center=None, zoom=None, bbox=None, bearing=None, size=(1024, 1024), ratio=1,
              simplify=SIMPLIFY_PX):
        """Returns the points and offsets, in pixels, of the lines in a view, as the function draw() takes them."""
        view = self._view(center, zoom, bbox, bearing, 0, size, ratio)
        with self._context._core as core:
            self._move(core, view, simplify)
            core.check(lib.camber_scene_project(self._scene))
            lines = lib.camber_scene_get_lines(self._scene)
            points = numpy.frombuffer(ffi.buffer(lines.points, 8 * lines.point_count), numpy.float32) \
                if lines.point_count else numpy.zeros(0, numpy.float32)
            offsets = numpy.frombuffer(ffi.buffer(lines.offsets, 4 * (lines.polyline_count + 1)), numpy.uint32) \
                if lines.polyline_count else numpy.zeros(1, numpy.uint32)
            made = points.reshape(-1, 2).copy(), offsets.copy()  # the scene frees its own arrays when it moves
            lib.camber_scene_release_lines(self._scene)
            return made

    @property
    def attribution(self):
        """The credit to show next to a picture; None if it is unknown."""
        with self._context._core as core:
            self._read_all(core)
            return text_of(lib.camber_features_get_attribution(self._features))

    @property
    def bounds(self):
        """West, south, east and north of all lines, in degrees; None if there are no lines."""
        box = ffi.new("double[4]")
        with self._context._core as core:
            self._read_all(core)
            return tuple(box) if lib.camber_features_get_bounds(self._features, box) else None

    def _read_all(self, core):
        if self._features is None:
            self._read(core, as_view(None, None, None, 0, 0, (1024, 1024), 1), False)

    def tiles(self, output, *, min_zoom=0, max_zoom=14, bbox=None, tile_size=256, ratio=1, format="png", quality=None,
              simplify=SIMPLIFY_PX, threads=0, keep_empty=False, force=False, resume=False, dry_run=False, name=None,
              description=None, attribution=None):
        """Draws a pyramid of tiles into an archive, and returns its counts as a dictionary."""
        texts = {"output": as_text(output), "name": as_text(name), "description": as_text(description),
                 "attribution": as_text(attribution)}
        engine_desc = {"tile_size": tile_size, "ratio": ratio, "simplify_px": simplify, "threads": threads}
        desc = ffi.new("camber_tiles_draw_desc *", {
            "min_zoom": min_zoom, "max_zoom": max_zoom, "encoding": pick(ENCODINGS, "format", format),
            "quality": quality or 0, "keep_empty": keep_empty, "force": force, "resume": resume, "dry_run": dry_run,
            "has_bbox": bbox is not None, "bbox": [0.0] * 4 if bbox is None else [float(side) for side in bbox],
            **texts})
        stats = ffi.new("camber_tiles_stats *")
        with self._context._core as core:
            device, renderer, _ = self._context._open(core)
            self._read_all(core)
            engine = core.make(lib.camber_tiles_engine_create, self._features,
                               ffi.new("camber_tiles_engine_desc *",
                                       {"renderer": renderer, "device": device, **engine_desc}),
                               parents=[renderer, device])
            core.check(lib.camber_tiles_draw(engine, desc, stats))
        return {field: getattr(stats, field) for field, _ in ffi.typeof("camber_tiles_stats").fields}


def render(*inputs, style=None, theme="light", layer=None, where=None, labels=True, fonts=(), language=None, context=None,
           **view):
    """Draws files once, into an array. Only the part of indexed files that the view needs is read."""
    shown = Map(*inputs, style=style, theme=theme, layer=layer, where=where, labels=labels, fonts=fonts,
                language=language, context=context)
    shown._once = True
    return shown.draw(**view)


def tiles(*inputs, output, style=None, theme="light", layer=None, where=None, context=None, **pyramid):
    """Draws a pyramid of tiles from files into an archive, and returns its counts as a dictionary."""
    return Map(*inputs, style=style, theme=theme, layer=layer, where=where, labels=False, context=context).tiles(
        output, **pyramid)
