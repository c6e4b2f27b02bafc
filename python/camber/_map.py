"""Maps: files drawn with a style, into arrays or archives of tiles."""

import json
import os

import numpy

from ._core import ArgumentError, NotFoundError, as_path, as_text, default, ffi, lib, pick, text_of
from ._draw import ENCODINGS, METHODS, as_size, render_frame

THEMES = {"light": lib.CAMBER_THEME_LIGHT, "dark": lib.CAMBER_THEME_DARK}
SIMPLIFY_PX = 0.1  # as in camber render


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
    path = as_path(style)
    if not os.path.exists(path):
        size = ffi.new("size_t *")
        text = lib.camber_style_get_text(path, theme, size)
        if text == ffi.NULL:
            raise NotFoundError("%s: neither a file nor a built-in style; name a style document, or one of: %s"
                                % (os.fsdecode(path), ", ".join(styles())))
        return bytes(ffi.buffer(text, size[0])), path, None
    with open(path, "rb") as file:
        return file.read(), path, path


def as_view(center, zoom, bbox, bearing, pitch, size, ratio, own=None):
    """Makes a view. own: the style's view, which is used if neither center nor bbox is given."""
    width, height = as_size(size)
    view = {"width": width, "height": height, "ratio": ratio, "bearing_deg": bearing, "pitch_deg": pitch}
    if bbox is not None:
        if center is not None or zoom is not None:
            raise ArgumentError("a bbox cannot be combined with a center or zoom; give one or the other")
        west, south, east, north = bbox
        view.update(kind=lib.CAMBER_VIEW_BBOX, west=west, south=south, east=east, north=north)
    elif center is not None or own is not None:
        if zoom is None and own is None:
            raise ArgumentError("there is a center without a zoom; give both")
        longitude, latitude = center if center is not None else (own.longitude, own.latitude)
        view.update(kind=lib.CAMBER_VIEW_CENTER, longitude=float(longitude), latitude=float(latitude),
                    zoom=float(zoom if zoom is not None else own.zoom))
    elif zoom is not None:
        raise ArgumentError("there is a zoom without a center; give both")
    return view


def translate(core, text, name, language):
    """Returns a style document that prefers names in a language."""
    made = ffi.new("char **")
    core.check(lib.camber_style_translate(core.pointer, text, len(text), name, as_text(language), made))
    try:
        return ffi.string(made[0])
    finally:
        lib.camber_style_free_text(core.pointer, made[0])


class Map:
    """Files with a style. They are read once; draw() moves the view over them.

    labels: whether the style's symbol layers are drawn. fonts: folders that are searched for fonts before the system's.
    language: the code of the language of names, such as "de"; None: the local names.
    """

    def __init__(self, *inputs, style=None, theme="light", layer=None, where=None, labels=True, fonts=(), language=None,
                 context=None):
        self._context = default(context)
        self._labels, self._fonts = labels, [as_path(folder) for folder in fonts]
        self._inputs = [as_path(path) for path in inputs]
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

    def draw(self, *, center=None, zoom=None, bbox=None, bearing=None, pitch=None, size=(1024, 1024), ratio=1,
             simplify=SIMPLIFY_PX, method="strip", premultiplied=False, out=None):
        """Draws a view into an array. Without center, zoom and bbox it shows everything that the style draws."""
        view = self._view(center, zoom, bbox, bearing, pitch, size, ratio)
        with self._context._core as core:
            device, renderer, _ = self._context._open(core)
            self._move(core, view, simplify, self._once)
            if self._mesh is None:
                self._mesh = core.make(lib.camber_mesh_create, device, renderer)
            core.check(lib.camber_scene_tessellate(self._scene, self._mesh, pick(METHODS, "method", method)))
            frame = ffi.new("camber_frame *")
            frame[0] = lib.camber_scene_get_frame(self._scene, self._mesh)
            return render_frame(core, renderer, frame, out, premultiplied)

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
