"""Texts: the fonts there are, shaped texts with their outlines, and texts to draw. The manual is docs/python.md."""

import math

import numpy

from ._colors import parse_color
from ._core import ArgumentError, as_path, default, ffi, lib, pick, text_of
from ._lines import as_points

ANCHORS = {name: getattr(lib, "CAMBER_ANCHOR_" + name.upper().replace("-", "_"))
           for name in ("center", "left", "right", "top", "bottom", "top-left", "top-right", "bottom-left",
                        "bottom-right")}
ALIGNS = {name: getattr(lib, "CAMBER_JUSTIFY_" + name.upper()) for name in ("center", "left", "right", "auto")}
GLYPH = numpy.dtype([("glyph", "u4"), ("character", "u4"), ("x", "f4"), ("y", "f4"), ("advance", "f4"),
                     ("turned", "?")])
LINE = numpy.dtype([("first", "u8"), ("count", "u8"), ("width", "f4")])


def open_fonts(core, context, folders):
    """Returns the context's set of fonts with these folders."""
    if isinstance(folders, (str, bytes)):
        raise TypeError("fonts is %r; give a list of folders" % (folders,))
    folders = tuple(as_path(folder) for folder in folders)
    if folders not in context._fonts:
        names = [ffi.new("char[]", folder) for folder in folders]
        pointers = ffi.new("char *[]", names)  # which a structure does not keep alive
        desc = ffi.new("camber_fonts_desc *", {"folders": pointers, "folder_count": len(names)})
        context._fonts[folders] = core.make(lib.camber_fonts_create, core.pointer, desc)
    return context._fonts[folders]


def fonts(folders=(), *, context=None):
    """Lists the fonts that texts may name, as dictionaries: the folders' fonts, the shipped ones, the system's."""
    context, found, info = default(context), [], ffi.new("camber_font_info *")
    with context._core as core:
        opened = open_fonts(core, context, folders)
        while True:
            core.check(lib.camber_fonts_list(opened, len(found), info))
            if info.name == ffi.NULL:
                return found
            found.append({"name": text_of(info.name), "path": text_of(info.path), "weight": info.weight,
                          "width": info.width, "italic": info.italic})


class _Words:
    """A text and how it is laid out, in the form that the library needs."""

    def __init__(self, text, size, *, font="Noto Sans", anchor="center", align="center", max_width=0, line_height=1.2,
                 letter_spacing=0, vertical=False, language=None):
        if not isinstance(text, str):
            raise TypeError("the text is %r; give a str" % (text,))
        if not 0 < size <= 16384:
            raise ArgumentError("size is %r; give more than 0 pixels, 16384 at most" % (size,))
        if not all(map(math.isfinite, (max_width, line_height, letter_spacing))) or min(max_width, line_height) < 0:
            raise ArgumentError("max_width is %r, line_height %r and letter_spacing %r; give finite numbers, and 0 or "
                                "more as width and height" % (max_width, line_height, letter_spacing))
        self.size = float(size)
        self.bytes = text.encode("utf-8", "surrogatepass")
        self._names = [ffi.new("char[]", as_path(name)) for name in ([font] if isinstance(font, str) else font)]
        self._kept = [ffi.from_buffer(self.bytes), ffi.new("char *[]", self._names),
                      ffi.NULL if language is None else ffi.new("char[]", as_path(language))]
        self._runs = ffi.new("camber_text_run *", {"text": self._kept[0], "size_bytes": len(self.bytes),
                                                   "fonts": self._kept[1], "font_count": len(self._names)})
        self._desc = ffi.new("camber_text_desc *", {
            "runs": self._runs, "run_count": 1, "max_width_em": max_width / self.size, "line_height_em": line_height,
            "letter_spacing_em": letter_spacing / self.size, "anchor": pick(ANCHORS, "anchor", anchor),
            "justify": pick(ALIGNS, "align", align), "vertical": vertical, "language": self._kept[2]})

    def use(self, core, opened, use):
        """Shapes the text, and calls use with it."""
        made = ffi.new("camber_text **")
        core.check(lib.camber_text_shape(opened, self._desc, made))
        try:
            return use(made[0])
        finally:
            lib.camber_text_destroy(made[0])


# ---- Shaped texts ----


class Shaped:
    """A shaped text, in pixels from its anchor.

    glyphs: an array with the fields glyph (its number in the context's fonts), character (where in the text its cluster
    begins), x, y (its origin), advance and turned. lines: an array with the fields first, count (glyphs) and width.
    box: left, top, right, bottom of all lines. points, offsets: the outlines, as rings that repeat their first point.
    """

    def __init__(self, glyphs, lines, box, points, offsets):
        self.glyphs, self.lines, self.box, self.points, self.offsets = glyphs, lines, box, points, offsets

    @property
    def width(self):
        return self.box[2] - self.box[0]

    @property
    def height(self):
        return self.box[3] - self.box[1]

    def __repr__(self):
        return "<camber.text.Shaped: %d glyphs in %d lines, %.1f x %.1f>" % (len(self.glyphs), len(self.lines), self.width,
                                                                           self.height)


def _copy_glyphs(words, made):
    size, letters = words.size, numpy.frombuffer(words.bytes, numpy.uint8)
    characters = numpy.cumsum((letters & 0xc0) != 0x80) - 1  # by byte
    glyphs, lines = numpy.zeros(made.glyph_count, GLYPH), numpy.zeros(made.line_count, LINE)
    for to, i in zip(glyphs, range(made.glyph_count)):
        of = made.glyphs[i]
        to["glyph"], to["character"], to["turned"] = of.glyph, characters[of.byte], of.turned
        to["x"], to["y"], to["advance"] = of.x * size, of.y * size, of.advance * size
    for to, i in zip(lines, range(made.line_count)):
        of = made.lines[i]
        to["first"], to["count"], to["width"] = of.first, of.count, of.width * size
    return glyphs, lines


def _copy_rings(rings):
    desc = lib.camber_text_rings_get(rings)
    offsets = ffi.buffer(desc.offsets, 4 * (desc.polyline_count + 1))
    points = ffi.buffer(desc.points, 8 * desc.point_count) if desc.point_count else b""
    return (numpy.frombuffer(points, numpy.float32).reshape(-1, 2).copy(), numpy.frombuffer(offsets, numpy.uint32).copy())


def shape(text, *, size=16, fonts=(), context=None, **style):
    """Shapes a text, and returns its glyphs, lines, boxes and outlines."""
    context, words = default(context), _Words(text, size, **style)
    with context._core as core:
        opened = open_fonts(core, context, fonts)
        rings = core.make(lib.camber_text_rings_create, opened)
        position = ffi.new("camber_text_position *", {"size_px": words.size})

        def copy(made):
            core.check(lib.camber_text_rings_add(rings, made, position, ffi.NULL))
            box = tuple(side * words.size for side in (made.left, made.top, made.right, made.bottom))
            return Shaped(*_copy_glyphs(words, made), box, *_copy_rings(rings))

        return words.use(core, opened, copy)


# ---- Texts to draw ----


class Text:
    """A text to draw: x and y are its anchor, in pixels, and angle turns it clockwise. The other arguments are those
    of shape()."""

    _line = None  # the points that it follows

    def __init__(self, x, y, text, *, size=16, color="#000", halo=None, halo_width=1.5, angle=0, **style):
        self._words = _Words(text, size, **style)
        if not 0 <= halo_width <= 4096:
            raise ArgumentError("halo_width is %r; give 0 to 4096 pixels" % (halo_width,))
        if not all(map(math.isfinite, (x, y, angle))):
            raise ArgumentError("x is %r, y %r and angle %r; give finite numbers" % (x, y, angle))
        nothing = (0.0, 0.0, 0.0, 0.0)
        self.look = (parse_color(color), nothing if halo is None else parse_color(halo),
                     0.0 if halo is None else 2.0 * halo_width)
        self._position = ffi.new("camber_text_position *", {"size_px": self._words.size, "x": x, "y": y,
                                                            "turn_deg": angle})

    @classmethod
    def along(cls, points, text, *, shift=0, keep_direction=False, max_turn=45, **style):
        """Makes a text that follows a line, n x 2 points in pixels. Its anchor is in the middle of the line, moved by
        shift pixels; it is not drawn where the line is too short or turns by more than max_turn degrees."""
        made = cls(0, 0, text, **style)
        if not 0 < max_turn <= 180:
            raise ArgumentError("max_turn is %r; give more than 0 degrees, 180 at most" % (max_turn,))
        made._line = as_points(points, numpy.float32)
        made._position.points = ffi.from_buffer("float[]", made._line)
        made._position.point_count = len(made._line)
        made._position.shift_px, made._position.max_turn_deg = shift, max_turn
        made._position.keep_direction = keep_direction
        return made

    def add(self, core, opened, rings, row):
        """Adds the rings of the text; returns the box around them, or None if nothing is drawn."""
        box = ffi.new("camber_text_box *")
        self._position.row = row
        self._words.use(core, opened, lambda made: core.check(
            lib.camber_text_rings_add(rings, made, self._position, box)))
        return (box.left, box.top, box.right, box.bottom) if box.left <= box.right else None


def as_texts(texts):
    texts = [texts] if isinstance(texts, Text) else list(texts)
    for text in texts:
        if not isinstance(text, Text):
            raise TypeError("a text is %r; give camber.Text(x, y, ...)" % (text,))
    return texts


def boxes(texts, *, fonts=(), context=None):
    """Returns left, top, right and bottom of each text as it is drawn, without its halo; NaN if nothing is drawn."""
    context, texts = default(context), as_texts(texts)
    found = numpy.full((len(texts), 4), numpy.nan, numpy.float32)
    with context._core as core:
        opened = open_fonts(core, context, fonts)
        rings = core.make(lib.camber_text_rings_create, opened)
        for box, text in zip(found, texts):
            box[:] = text.add(core, opened, rings, 0) or numpy.nan
            lib.camber_text_rings_clear(rings)
    return found


def add_passes(core, context, frame, passes, mesh, texts, fonts):
    """Draws texts in two passes of a frame: their halos, then the texts. Returns what the frame refers to."""
    opened = open_fonts(core, context, fonts)
    rings = core.make(lib.camber_text_rings_create, opened)
    looks = {}
    for text in texts:
        text.add(core, opened, rings, looks.setdefault(text.look, len(looks)))
    strokes = ffi.new("camber_stroke[]", len(looks))
    halos, paints = ffi.new("camber_paint[]", len(looks)), ffi.new("camber_paint[]", len(looks))
    fills = ffi.new("camber_fill[]", len(looks))
    for row, (color, halo, width) in enumerate(looks):
        strokes[row].width_px = halos[row].width_px = width
        halos[row].color, fills[row].color, paints[row].fill = halo, color, fills + row
    outlines = ffi.new("camber_polylines_desc *", lib.camber_text_rings_get(rings))
    polylines = core.make(lib.camber_polylines_create, core.pointer, outlines)
    companion = ffi.new("camber_mesh **")
    core.check(lib.camber_mesh_get_companion(mesh, companion))
    shape_of = ffi.new("camber_tessellation_desc *", {"strokes": strokes, "stroke_count": len(looks)})
    core.check(lib.camber_mesh_tessellate(companion[0], polylines, shape_of))
    for pass_, of in (passes[1], halos), (passes[2], paints):
        pass_.mesh, pass_.paints, pass_.paint_count = companion[0], of, len(looks)
    frame.pass_count = 3
    return halos, paints, fills
