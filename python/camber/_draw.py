"""Pictures and meshes of lines in pixels, and of networks seen by a camera."""

import collections
import operator
import warnings

import numpy

from ._arrays import dtype_of, view
from ._colors import NAMES, as_colors, parse_color
from ._core import ArgumentError, check_memory, default, lib, ffi, pick
from ._lines import as_lines, as_whole, columns_of
from ._text import add_passes, as_texts

JOINS = {"round": lib.CAMBER_JOIN_ROUND, "miter": lib.CAMBER_JOIN_MITER, "bevel": lib.CAMBER_JOIN_BEVEL}
CAPS = {"butt": lib.CAMBER_CAP_BUTT, "round": lib.CAMBER_CAP_ROUND, "square": lib.CAMBER_CAP_SQUARE}
OVERLAPS = {"flatten": lib.CAMBER_OVERLAP_FLATTEN, "accumulate": lib.CAMBER_OVERLAP_ACCUMULATE,
            "unite": lib.CAMBER_OVERLAP_UNITE}
METHODS = {"strip": lib.CAMBER_METHOD_STRIP, "kite": lib.CAMBER_METHOD_KITE, "fan": lib.CAMBER_METHOD_FAN}
ENCODINGS = {"png": lib.CAMBER_ENCODING_PNG, "png8": lib.CAMBER_ENCODING_PNG8, "webp": lib.CAMBER_ENCODING_WEBP}
TAKE_ROWS = ffi.addressof(lib, "camber_python_take_rows")
STROKE, PAINT, RECORD, VERTEX = (dtype_of("camber_" + name) for name in ("stroke", "paint", "record", "vertex"))


# ---- Styles ----


def as_rows(rows, lines):
    """Returns the row of each line, from one row per line or per geometry. None if no rows were given."""
    if rows is None:
        return None
    rows = as_whole(rows, numpy.uint32, "rows")
    if len(rows) != lines.origin_count:
        raise ArgumentError("there are %d rows and %d lines; give one for each" % (len(rows), lines.origin_count))
    return rows if lines.origins is None else rows[lines.origins]


STYLE = ("width", "color", "rows", "size", "background", "join", "cap", "miter_limit", "offset", "gap", "blur", "dash",
         "overlap", "opacity", "pitch")


def explain_unknown(name):
    """Says what to give instead of an argument that there is not."""
    if name in ("column", "cmap", "legend", "vmin", "vmax"):
        return "%s= colours lines by a column; camber.plot(data, column=...) does that" % name
    if name in ("crs", "bbox"):
        return "%s= is for data with a CRS; camber.plot(data, ...) projects it, and here lines are in pixels" % name
    near = {"linewidth": "width", "lw": "width", "colors": "color", "colour": "color", "alpha": "opacity",
            "figsize": "size", "linestyle": "dash"}.get(name)
    return "there is no argument %r; %s" % (name, "give %s=" % near if near else "styles have %s" % ", ".join(STYLE))


class Table:
    """Strokes and paints by row, and the row of each line, in the form that the library needs.

    rows is the result of as_rows. lines is None if the lines already have rows, or all have row 0.
    """

    def __init__(self, width, color, rows, lines, *, join="round", cap="butt", miter_limit=0, offset=0, gap=0, blur=0,
                 dash=None, **unknown):
        if unknown:
            raise TypeError(explain_unknown(next(iter(unknown))))
        if not (0 <= gap < float("inf") and 0 <= blur < float("inf")):
            raise ArgumentError("gap is %r and blur %r; give 0 or more pixels" % (gap, blur))
        colors, has_colors = as_colors(color)
        widths = numpy.asarray(width)
        if widths.dtype.kind not in "fiu" or widths.ndim > 1:
            raise TypeError("width has the type %s and the shape %s; give a number, or one for each line"
                            % (widths.dtype, widths.shape))
        counts = {len(colors)} if has_colors else set()
        counts |= {len(widths)} if widths.ndim else set()
        if rows is None and lines is None and counts - {1}:
            raise ArgumentError("there are several widths or colours, and the network was made without rows; give it "
                                "rows=range(n) to have one for each line")
        wanted = None if rows is not None or lines is None else lines.origin_count
        if len(counts) > 1 or (wanted is not None and counts and counts != {wanted}):
            raise ArgumentError("there are %s widths and colours, and %s"
                                % (" and ".join(map(str, sorted(counts))),
                                   "%d lines; give one for each, or rows" % wanted if wanted is not None
                                   else "both are chosen by row; give the same number of each"))
        if not counts and rows is not None and len(rows):  # one width and colour for all rows
            counts = {int(rows.max()) + 1}
            colors = numpy.broadcast_to(colors, (max(counts), 4))
        self.count = counts.pop() if counts else 1
        self.rows = rows
        if rows is not None and len(rows) and int(rows.max()) >= self.count:
            raise ArgumentError("row %d has no width and colour: there are %d" % (rows.max(), self.count))
        if rows is None and self.count > 1:
            self.rows = as_rows(range(self.count), lines)
        if self.count == 0:  # without lines there is one row that nothing uses
            colors, widths = numpy.zeros((1, 4)), numpy.zeros(())
        self.strokes = numpy.zeros(max(self.count, 1), STROKE)
        self.strokes["width_px"] = 2 * widths + gap if gap else widths
        self.strokes["join"], self.strokes["cap"] = pick(JOINS, "join", join), pick(CAPS, "cap", cap)
        self.strokes["miter_limit"], self.strokes["offset_px"] = miter_limit, offset
        self.paints = numpy.zeros(max(self.count, 1), PAINT)
        self.paints["width_px"], self.paints["gap_px"], self.paints["blur_px"] = widths, gap, blur
        for i, channel in enumerate("rgba"):
            self.paints["color"][channel] = colors[:, i]
        self.pointers = [ffi.from_buffer("camber_stroke[]", self.strokes),
                         ffi.from_buffer("camber_paint[]", self.paints)]
        self.dash = None
        if dash is not None:
            lengths = ffi.new("float[]", [float(length) for length in dash])
            self.dash = ffi.new("camber_dash *", {"lengths": lengths, "count": len(lengths)})
            self.pointers.append(lengths)
            for paint in self.pointers[1]:
                paint.dash = self.dash

    def tessellation(self, method="strip", fan_tolerance=0):
        return ffi.new("camber_tessellation_desc *", {
            "strokes": self.pointers[0], "stroke_count": len(self.strokes), "method": pick(METHODS, "method", method),
            "fan_tolerance_px": fan_tolerance, "has_arc_length": self.dash is not None})


# ---- Pictures ----


def warn_outside(lines, given, widths, size):
    """Warns if no line can be in the picture, or if all of them are in one pixel."""
    if not len(lines.points):
        return
    x, y = lines.points[:, 0], lines.points[:, 1]
    low, high = (x.min(), y.min()), (x.max(), y.max())
    if not numpy.isfinite((low, high)).all():
        return
    reach = float(numpy.max(widths, initial=0)) + 1
    told = "camber.plot(...) fits lines into a picture, and here they are in pixels, with y down"
    if any(high[i] < -reach or low[i] > size[i] + reach for i in (0, 1)):
        warnings.warn("the picture is empty: the lines are at %g, %g to %g, %g, and it is %d x %d px; %s"
                      % (*low, *high, *size, told), stacklevel=3)
    elif hasattr(given, "crs") and high[0] - low[0] < 2 and high[1] - low[1] < 2:
        warnings.warn("all lines are in %g x %g px; %s" % (high[0] - low[0], high[1] - low[1], told), stacklevel=3)


def refuse_column(points, color):
    """Refuses a colour that is the name of a column."""
    if isinstance(color, str) and color in columns_of(points) and color not in NAMES:
        raise ArgumentError("color=%r is a column of the data; camber.plot(data, column=%r) colours lines by it"
                            % (color, color))


def as_size(size):
    try:
        width, height = (operator.index(side) for side in size)
    except (TypeError, ValueError):
        raise ArgumentError("size is %r; give width and height as whole numbers of pixels" % (size,)) from None
    if not (1 <= width <= 65535 and 1 <= height <= 65535):
        raise ArgumentError("size is %d x %d; give 1 to 65535 pixels each" % (width, height))
    return width, height


def as_output(out, width, height):
    """Returns the array that receives a picture. Its rows may have gaps between them, but the bytes of a row may
    not."""
    if out is None:  # memory that kernels can write to directly
        step, size = lib.CAMBER_PIXELS_ALIGNMENT, height * width * 4
        check_memory(2 * size)  # drawing takes about the same amount again
        block = numpy.empty(size + step, numpy.uint8)
        first = -block.ctypes.data % step
        return block[first:first + size].reshape(height, width, 4)
    if not isinstance(out, numpy.ndarray) or out.dtype != numpy.uint8 or out.shape != (height, width, 4):
        raise ArgumentError("out is not a uint8 array of %d x %d x 4" % (height, width))
    if not out.flags.writeable:
        raise ArgumentError("out is read-only")
    if out.strides[1:] != (4, 1) or out.strides[0] < 4 * width:
        raise ArgumentError("out has the strides %s; each row must be contiguous, and rows must not overlap"
                            % (out.strides,))
    return out


def render_frame(core, renderer, frame, out, premultiplied):
    """Draws a frame into an array, without holding Python's lock."""
    out = as_output(out, frame.width, frame.height)
    rgba = ffi.cast("uint8_t *", out.ctypes.data)
    if premultiplied or frame.background.a >= 1:  # straight and premultiplied alpha are the same in opaque pictures
        core.check(lib.camber_renderer_render_into(renderer, frame, rgba, out.strides[0], ffi.NULL))
        return out
    picture = ffi.new("camber_python_picture *", {
        "rgba": rgba, "stride_bytes": out.strides[0], "width": frame.width})
    core.check(lib.camber_renderer_render(renderer, frame, TAKE_ROWS, picture, ffi.NULL))
    return out


def frame_of(table, mesh, size, background, overlap, opacity, pitch=0):
    if not 0 < opacity <= 1:
        raise ArgumentError("opacity is %r; give more than 0, 1 at most" % (opacity,))
    width, height = size
    passes = ffi.new("camber_pass[3]", [{
        "mesh": mesh, "paints": table.pointers[1], "paint_count": len(table.paints),
        "overlap": pick(OVERLAPS, "overlap", overlap), "opacity": 0 if opacity == 1 else opacity}])
    frame = ffi.new("camber_frame *", {"width": width, "height": height, "passes": passes, "pass_count": 1,
                                       "pitch_deg": pitch})
    if background is not None:
        frame.background = parse_color(background)
    return frame, passes


def make_polylines(core, lines, rows, keep_open):
    desc = ffi.new("camber_polylines_desc *", {
        "points": ffi.from_buffer("float[]", lines.points), "point_count": len(lines.points),
        "offsets": ffi.from_buffer("uint32_t[]", lines.offsets), "polyline_count": len(lines),
        "rows": ffi.NULL if rows is None else ffi.from_buffer("uint32_t[]", rows), "keep_open": keep_open})
    return core.make(lib.camber_polylines_create, core.pointer, desc)


def draw(points, offsets=None, *, width=8, color="#336", size=(1024, 1024), rows=None, background=None,
         overlap="flatten", opacity=1, pitch=0, keep_open=False, premultiplied=False, out=None, texts=(), fonts=(),
         context=None, **style):
    """Draws lines in pixels, and texts over them; returns a uint8 array of height x width x 4."""
    context, texts = default(context), as_texts(texts)
    refuse_column(points, color)
    lines = as_lines(points, offsets, numpy.float32, numpy.uint32)
    table = Table(width, color, as_rows(rows, lines), lines, **style)
    size = as_size(size)
    warn_outside(lines, points, table.strokes["width_px"] + abs(table.strokes["offset_px"]), size)
    with context._core as core:
        _, renderer, mesh = context._open(core)
        polylines = make_polylines(core, lines, table.rows, keep_open)
        core.check(lib.camber_mesh_tessellate(mesh, polylines, table.tessellation()))
        frame, passes = frame_of(table, mesh, size, background, overlap, opacity, pitch)
        kept = add_passes(core, context, frame, passes, mesh, texts, fonts) if texts else None
        picture = render_frame(core, renderer, frame, out, premultiplied)
        del kept  # the frame refers to it
        return picture


def as_sums(width, height):
    """Returns an array of floats that kernels can write to directly, one per pixel."""
    return as_output(None, width, height).reshape(height, width * 4).view(numpy.float32)


def sum_lines(lines, *, width, weights, size, context, camera=None, **style):
    """Returns how many origins of lines cover each pixel, each times its weight; lines are in pixels, or, with a camera
    (x, y, scale), in its units."""
    if lines.origins is None:
        rows = numpy.arange(len(lines), dtype=numpy.uint32)
    else:
        rows = lines.origins.astype(numpy.uint32)
    table = Table(width, "#000", rows, None, **style)
    if weights is not None and len(rows):
        table.paints["color"]["r"] = weights[:len(table.paints)]
    else:
        table.paints["color"]["r"] = 1
    sums = as_sums(*size)
    with context._core as core:
        _, renderer, mesh = context._open_summing(core)
        if camera is None:
            polylines = make_polylines(core, lines, rows, False)
            core.check(lib.camber_mesh_tessellate(mesh, polylines, table.tessellation()))
        else:
            desc, kept = describe_network(lines, rows)
            desc.has_arc_length = table.dash is not None
            desc.step = 1 / (4096 * camera[2])  # so that a line's points do not depend on the other lines
            network = core.make(lib.camber_network_create, core.pointer, desc)
            view = ffi.new("camber_camera *", {"x": camera[0], "y": camera[1], "scale_px": camera[2], "width": size[0],
                                               "height": size[1]})
            core.check(lib.camber_mesh_tessellate_network(mesh, network, view, table.tessellation()))
            del kept
        frame, passes = frame_of(table, mesh, size, None, "flatten", 1)
        core.check(lib.camber_renderer_sum(renderer, frame, ffi.from_buffer("float[]", sums), sums.strides[0], ffi.NULL))
        del passes
    return sums


Mesh = collections.namedtuple("Mesh", "method strips records vertices indices")


def tessellate(points, offsets=None, *, width=8, rows=None, method="strip", fan_tolerance=0, keep_open=False,
               context=None, **style):
    """Returns the mesh of lines in pixels, as arrays that use the library's memory."""
    context = default(context)
    lines = as_lines(points, offsets, numpy.float32, numpy.uint32)
    table = Table(width, "#000", as_rows(rows, lines), lines, **style)
    with context._core as core:
        device = context._open(core)[0]
        polylines = make_polylines(core, lines, table.rows, keep_open)
        mesh = core.make(lib.camber_mesh_create, device, ffi.NULL)
        core.check(lib.camber_mesh_tessellate(mesh, polylines, table.tessellation(method, fan_tolerance)))
        data = ffi.new("camber_mesh_data *")
        core.check(lib.camber_mesh_read(mesh, data))
        owner = core.own(data, lib.camber_mesh_data_destroy)
    info = data.info
    return Mesh(method, bool(info.strips), view(data.records, RECORD, info.record_count, owner),
                view(data.vertices, VERTEX, info.vertex_count, owner),
                view(data.indices, "u4", info.index_count, owner))


def importance(points, offsets=None, *, context=None):
    """Returns the importance of each point of lines, as Network takes it: the largest tolerance that keeps the point."""
    lines = as_lines(points, offsets, numpy.float64, numpy.uint64)
    made = numpy.empty(len(lines.points), numpy.float32)
    with default(context)._core as core:
        core.check(lib.camber_importance_weigh(
            core.pointer, ffi.from_buffer("double[]", lines.points),
            ffi.cast("size_t *", ffi.from_buffer("uint64_t[]", lines.offsets)), len(lines),
            ffi.from_buffer("float[]", made)))
    return made


def describe_network(lines, rows):
    """Returns a description of a network, and what it refers to."""
    entries = numpy.zeros(len(lines), dtype_of("camber_network_entry"))
    entries["polyline"] = numpy.arange(len(lines))
    entries["row"] = 0 if rows is None else rows
    kept = [ffi.from_buffer("double[]", lines.points), ffi.from_buffer("uint64_t[]", lines.offsets),
            ffi.from_buffer("camber_network_entry[]", entries)]
    return ffi.new("camber_network_desc *", {
        "points": kept[0], "offsets": ffi.cast("size_t *", kept[1]), "polyline_count": len(lines), "entries": kept[2],
        "entry_count": len(entries)}), kept


class Network:
    """Lines in world units, which stay on the device while a camera moves over them. y points down."""

    _warns = True  # of empty pictures

    def __init__(self, points, offsets=None, *, rows=None, importance=None, keep_open=False, dashed=False,
                 context=None, **unknown):
        if unknown:
            name = next(iter(unknown))
            raise TypeError("%s= is an argument of draw()" % name if name in STYLE else explain_unknown(name))
        self._context = default(context)
        lines = as_lines(points, offsets, numpy.float64, numpy.uint64)
        self._rows = as_rows(rows, lines)
        desc, kept = describe_network(lines, self._rows)
        desc.keep_open, desc.has_arc_length = keep_open, dashed
        self._dashed, self._has_importance = dashed, importance is not None or not len(lines)
        if importance is not None:
            importance = numpy.require(importance, numpy.float32, "CA")
            if importance.shape != (len(lines.points),):
                raise ArgumentError("importance has the shape %s; give one number for each of the %d points"
                                    % (importance.shape, len(lines.points)))
            desc.importance = ffi.from_buffer("float[]", importance)
        finite = lines.points[numpy.isfinite(lines.points).all(axis=1)]
        self._has_points = len(finite) > 0
        self.bounds = tuple(finite.min(axis=0)) + tuple(finite.max(axis=0)) if len(finite) else (0.0, 0.0, 1.0, 1.0)
        with self._context._core as core:
            device, renderer, _ = self._context._open(core)
            self._network = core.make(lib.camber_network_create, core.pointer, desc)
            self._mesh = core.make(lib.camber_mesh_create, device, renderer)

    def _camera(self, center, scale, size):
        west, north, east, south = self.bounds
        if center is None:
            center = ((west + east) / 2, (north + south) / 2)
        if scale is None:  # show everything, with a margin of 2 %
            sides = [side / length for side, length in zip(size, (east - west, south - north)) if length > 0]
            scale = 0.96 * min(sides, default=1.0)
        return float(center[0]), float(center[1]), float(scale)

    def _warn_outside(self, x, y, scale, width, size):
        """Warns if the camera looks past the lines, however it is turned."""
        west, north, east, south = self.bounds
        away = numpy.hypot(max(west - x, x - east, 0), max(north - y, y - south, 0)) * scale
        if self._has_points and numpy.isfinite(away) and away > numpy.hypot(*size) + width:
            warnings.warn("the picture is empty: it shows %g, %g, and the lines are at %g, %g to %g, %g"
                          % (x, y, *self.bounds), stacklevel=3)

    def draw(self, *, center=None, scale=None, bearing=0, pitch=0, simplify=0, width=8, color="#336",
             size=(1024, 1024), background=None, overlap="flatten", opacity=1, premultiplied=False, out=None, **style):
        """Draws what a camera sees. scale is in pixels per world unit; without center and scale everything is shown."""
        size = as_size(size)
        table = Table(width, color, self._rows, None, **style)
        if table.dash is not None and not self._dashed:
            raise ArgumentError("dashes need a network that was made with dashed=True")
        if simplify and not self._has_importance:
            raise ArgumentError("simplify=%r needs the importance of each point; make the network with "
                                "importance=camber.importance(points, offsets)" % simplify)
        x, y, scale = self._camera(center, scale, size)
        if self._warns:
            self._warn_outside(x, y, scale, numpy.max(table.strokes["width_px"]), size)
        camera = ffi.new("camber_camera *", {
            "x": x, "y": y, "scale_px": scale, "bearing_deg": bearing, "width": size[0], "height": size[1],
            "simplify_px": simplify, "pitch_deg": pitch})
        with self._context._core as core:
            renderer = self._context._open(core)[1]
            core.check(lib.camber_mesh_tessellate_network(self._mesh, self._network, camera, table.tessellation()))
            frame, _ = frame_of(table, self._mesh, size, background, overlap, opacity)
            return render_frame(core, renderer, frame, out, premultiplied)


def encode(picture, format="png", *, quality=None, premultiplied=False, dpi=0, context=None):
    """Returns a picture encoded as PNG or WebP, as bytes. dpi: what a PNG says of its size on paper."""
    picture = numpy.asarray(picture)
    if picture.dtype != numpy.uint8 or picture.ndim != 3 or picture.shape[2] != 4 or not picture.size:
        raise ArgumentError("the picture has the type %s and the shape %s; give uint8, height x width x 4"
                            % (picture.dtype, picture.shape))
    picture = numpy.ascontiguousarray(picture)
    height, width = picture.shape[:2]
    pixels = ffi.from_buffer("uint8_t[]", picture)
    desc = ffi.new("camber_encoder_desc *", {"encoding": pick(ENCODINGS, "format", format), "quality": quality or 0,
                                           "dpi": dpi})
    with default(context)._core as core:
        encoder = core.make(lib.camber_encoder_create, core.pointer, desc)
        if not premultiplied:
            straight, pixels = pixels, ffi.from_buffer("uint8_t[]", numpy.empty_like(picture))
            lib.camber_python_premultiply(straight, pixels, width * height)
        image = ffi.new("camber_pixels *", {"rgba": pixels, "width": width, "height": height})
        made, size = ffi.new("uint8_t **"), ffi.new("size_t *")
        core.check(lib.camber_encoder_encode(encoder, image, made, size))
        return bytes(ffi.buffer(made[0], size[0]))
