"""Pictures of tables of lines: fitted, y up, coloured by a column, with a legend. The manual is docs/python.md."""

import difflib
import math
import os
import warnings

import numpy

from ._colors import CATEGORIES, SHADES, as_colors, parse_color, sample
from ._core import ArgumentError, ffi, lib
from ._draw import Network, as_size, draw, encode
from ._lines import Lines, as_lines, as_points, as_values, columns_of
from ._text import Text

MARGIN = 0.02  # of the picture, on each side
LONGEST = 1000  # px, the longer side of a picture whose size is not given
FLATTEST = 4  # the most that one side of such a picture is longer than the other
LISTED = 12  # categories in a legend
MERCATOR_RADIUS, MERCATOR_LATITUDE = 6378137.0, 85.051129


# ---- Tables ----


def crs_of(data, lines):
    """Returns the CRS of a GeoDataFrame, a GeoSeries or GeoArrow as pyproj has it, or None."""
    crs = getattr(data, "crs", None)
    if hasattr(crs, "is_geographic"):
        return crs
    if lines.crs is None:
        return None
    from pyproj import CRS
    return CRS.from_user_input(lines.crs)


def find_column(data, column, count):
    """Returns the values of a column, one per row of the data; column is its name, or values."""
    if not isinstance(column, str):
        values = as_values(column)
        if values.ndim != 1 or len(values) != count:
            raise ArgumentError("column has the shape %s; give the name of a column, or one value for each of the %d lines"
                                % (values.shape, count))
        return values
    names = columns_of(data)
    if not names:
        raise ArgumentError("column=%r names a column, and the data is no table (%s); give a GeoDataFrame, or one value for "
                            "each line" % (column, type(data).__name__))
    if column not in names:
        near = difflib.get_close_matches(column, names, 1)
        raise ArgumentError("there is no column %r; %s" % (column, "is it %r?" % near[0] if near else
                                                           "the data has %s" % ", ".join(map(repr, names))))
    values = as_values(data[column])
    if values.ndim != 1:
        raise ArgumentError("several columns have the name %r; give one of them another name" % column)
    return values


# ---- Projection ----


def project(points, crs, wanted):
    """Projects points. Without a wanted CRS, degrees become Web Mercator, and other units stay as they are."""
    if crs is None:
        if wanted is not None:
            raise ArgumentError("crs=%r is given, and the data does not say its own; tell it first, as in "
                                "data.set_crs(\"EPSG:4326\")" % (wanted,))
        return points
    if wanted is None and not crs.is_geographic:
        return points
    if wanted is None and all(axis.unit_name == "degree" for axis in crs.axis_info[:2]):
        radians = numpy.radians(points)
        numpy.clip(radians[:, 1], -math.radians(MERCATOR_LATITUDE), math.radians(MERCATOR_LATITUDE), out=radians[:, 1])
        radians[:, 1] = numpy.arctanh(numpy.sin(radians[:, 1]))
        radians *= MERCATOR_RADIUS
        return radians
    from pyproj import Transformer
    x, y = Transformer.from_crs(crs, "EPSG:3857" if wanted is None else wanted, always_xy=True).transform(
        points[:, 0], points[:, 1])
    return numpy.stack([x, y], axis=1)


def project_box(bbox, crs, wanted):
    """Returns the box around a projected box, whose sides may be curved."""
    try:
        west, south, east, north = map(float, bbox)
    except (TypeError, ValueError):
        raise ArgumentError("bbox is %r; give four numbers: west, south, east, north" % (bbox,)) from None
    if not (west <= east and south <= north):
        raise ArgumentError("bbox is %r; give west, south, east, north, with west at most east and south at most north"
                            % (bbox,))
    t = numpy.linspace(0, 1, 21)
    x, y = west + t * (east - west), south + t * (north - south)
    sides = [numpy.c_[x, numpy.full(21, side)] for side in (south, north)] + \
        [numpy.c_[numpy.full(21, side), y] for side in (west, east)]
    return box_of(project(numpy.concatenate(sides), crs, wanted))


def box_of(points):
    """Returns the box around the finite points: west, south, east, north. None: there are none."""
    points = as_points(points, numpy.float64)
    box = ffi.new("double[4]", [math.inf, math.inf, -math.inf, -math.inf])
    lib.camber_python_bound(ffi.from_buffer("double[]", points), len(points), box)
    return tuple(box) if box[0] <= box[2] else None


class Fit:
    """How world coordinates with y up become pixels: size, and (x, y) * (scale, -scale) + shift."""

    def __init__(self, box, size, margin=MARGIN):
        width, height = box[2] - box[0], box[3] - box[1]
        if not (math.isfinite(width) and math.isfinite(height)):
            raise ArgumentError("the picture would go from %g, %g to %g, %g, which is too far for its scale" % box)
        if size is None or isinstance(size, (int, numpy.integer)):
            longest = LONGEST if size is None else as_size((size, size))[0]
            most = max(width, height)
            ratios = [max(side / most, 1 / FLATTEST) if most > 0 else 1.0 for side in (width, height)]
            size = [max(round(longest * ratio), 1) for ratio in ratios]
        self.size = as_size(size)
        scales = [(1 - 2 * margin) * side / length for side, length in zip(self.size, (width, height)) if length > 0]
        self.scale = min(scales, default=1.0)
        self.center = (box[0] + box[2]) / 2, (box[1] + box[3]) / 2

    @property
    def bounds(self):
        half = [side / 2 / self.scale for side in self.size]
        return tuple(center + sign * side for sign in (-1, 1) for center, side in zip(self.center, half))

    def to_pixels(self, points):
        points, pixels = as_points(points, numpy.float64), numpy.empty(points.shape, numpy.float32)
        lib.camber_python_fit(ffi.from_buffer("double[]", points), len(points),
                              [*self.center, self.scale, self.size[0] / 2, self.size[1] / 2],
                              ffi.from_buffer("float[]", pixels))
        return pixels


# ---- Colours and their legend ----


def format_number(value, step):
    """Formats a tick of an axis whose ticks are a step apart."""
    if abs(value) >= 1e7 or 0 < step < 1e-4:
        return "%.4g" % value
    return "{:,.{}f}".format(value, max(0, -math.floor(math.log10(step) + 1e-9)) if step > 0 else 0)


def find_ticks(low, high):
    """Returns three to six round numbers from low to high, and how far they are apart."""
    if not high - low > 1e-290:
        return [low], 0 if low == round(low) else 10.0 ** math.floor(math.log10(abs(low)) - 2)
    rough = (high - low) / 4
    unit = 10.0 ** math.floor(math.log10(rough))
    step = min((unit * factor for factor in (1, 2, 2.5, 5, 10)), key=lambda step: abs(step - rough))
    return [n * step for n in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)], step


def as_moment(value, unit):
    """Returns a limit of a column of dates or of differences of dates as a number in the column's unit."""
    try:
        return float(numpy.asarray(value, unit).astype(numpy.int64))
    except (TypeError, ValueError):
        raise ArgumentError("vmin or vmax is %r, and the column has %s" % (
            value, "dates; give a date, such as \"2026-01-31\"" if unit.kind == "M" else
            "differences of dates; give one, such as numpy.timedelta64(3, \"h\")")) from None


class Scale:
    """Numbers or dates as shades of a colour map. rows: one per value; colors: one per row; the last is for missing
    values."""

    def __init__(self, values, cmap, low, high, missing):
        self.unit = values.dtype if values.dtype.kind in "mM" else None
        numbers = values
        if self.unit is not None:
            numbers = values.astype(numpy.int64).astype(numpy.float64)
            numbers[numpy.isnat(values)] = numpy.nan
            low, high = (None if each is None else as_moment(each, values.dtype) for each in (low, high))
        finite = numpy.isfinite(numbers)
        shown = numbers[finite]
        if any(isinstance(each, str) for each in (low, high)):
            raise ArgumentError("vmin is %r and vmax %r, and the column has numbers; give numbers" % (low, high))
        self.low = float(low if low is not None else shown.min() if len(shown) else 0)
        self.high = float(high if high is not None else shown.max() if len(shown) else 1)
        if not self.low <= self.high:
            raise ArgumentError("vmin is %g and vmax %g; vmin must not be the larger one" % (self.low, self.high))
        span = self.high - self.low or 1.0
        if not math.isfinite(span):
            raise ArgumentError("the colours would go from %g to %g, which is too far; give vmin and vmax"
                                % (self.low, self.high))
        with numpy.errstate(invalid="ignore", over="ignore"):
            shades = numpy.clip((numbers - self.low) / span * SHADES, 0, SHADES - 1)
        self.rows = numpy.where(finite, shades, SHADES).astype(numpy.uint32)
        self.colors = numpy.concatenate([sample("viridis" if cmap is None else cmap), [parse_color(missing)]])
        self.has_missing = not finite.all()

    def tick(self, value, step):
        if self.unit is None:
            return format_number(value, step)
        moment = numpy.int64(value).astype(self.unit)
        return str(moment.astype("M8[D]") if self.unit.kind == "M" else moment)


class Categories:
    """Texts or booleans as colours, in the order of their names; like Scale."""

    def __init__(self, values, cmap, missing):
        missing_at = numpy.array([value is None for value in values], bool)
        self.names, rows = numpy.unique(values[~missing_at].astype(str), return_inverse=True)
        count = len(self.names)
        self.rows = numpy.full(len(values), count, numpy.uint32)
        self.rows[~missing_at] = rows
        if cmap is None:
            colors = as_colors(["#" + digits for digits in CATEGORIES])[0]
            colors = colors[numpy.arange(count) % len(colors)]
        elif isinstance(cmap, dict):
            cmap = {str(name): color for name, color in cmap.items()}  # booleans are texts here
            colors = as_colors([cmap.get(name, missing) for name in self.names])[0]
        else:
            colors = sample(cmap, count) if isinstance(cmap, str) or callable(cmap) else as_colors(cmap)[0]
            if count and not len(colors):
                raise ArgumentError("the colour map is an empty list; give at least one colour")
            colors = colors[numpy.arange(count) % max(len(colors), 1)]
        self.colors = numpy.concatenate([colors.reshape(-1, 4), [parse_color(missing)]])
        self.has_missing = bool(missing_at.any())


def draw_scale(scale, title, ink, paper, context):
    """Draws a bar of colours with its ticks."""
    length, thick, left, top = SHADES, 12, 16, 34 if title else 14
    ticks, step = find_ticks(scale.low, scale.high)
    if scale.unit is not None:
        ticks, step = [scale.low, scale.high] if scale.high > scale.low else [scale.low], 0
    texts = [Text(left, 17, title, size=14, anchor="left", color=ink)] if title else []
    lines = [[(left + length * i / SHADES, top + thick / 2), (left + length * (i + 1) / SHADES, top + thick / 2)]
             for i in range(SHADES)]
    colors = [tuple(color) for color in scale.colors[:SHADES]]
    widths = [thick] * SHADES
    for tick in ticks:
        x = left + length * (tick - scale.low) / (scale.high - scale.low or 1.0)
        lines.append([(x, top + thick), (x, top + thick + 4)])
        colors.append(parse_color(ink))
        widths.append(1)
        texts.append(Text(x, top + thick + 13, scale.tick(tick, step), size=12, color=ink))
    size = length + 2 * left + 8, top + thick + 26
    if scale.has_missing:
        texts.append(Text(left + 16, size[1] + 4, "no value", size=12, anchor="left", color=ink))
        lines.append([(left, size[1] + 4), (left + 12, size[1] + 4)])
        colors.append(tuple(scale.colors[-1]))
        widths.append(thick)
        size = size[0], size[1] + 18
    return draw(lines, width=widths, color=colors, size=size, background=paper, texts=texts, overlap="accumulate",
                context=context)


def draw_categories(categories, title, ink, paper, context):
    """Draws a list of colours with their names."""
    names = [(name[:39] + "…" if len(name) > 40 else name, row) for row, name in enumerate(categories.names)]
    more = len(names) - LISTED
    names = names[:LISTED] + ([("no value", len(names))] if categories.has_missing else [])
    top, step, left = 34 if title else 14, 18, 14
    texts = [Text(left, 17, title, size=14, anchor="left", color=ink)] if title else []
    lines, colors = [], []
    for i, (name, row) in enumerate(names):
        y = top + step * i + 4
        lines.append([(left, y), (left + 18, y)])
        colors.append(tuple(categories.colors[row]))
        texts.append(Text(left + 26, y, name, size=12, anchor="left", color=ink))
    height = top + step * len(names)
    if more > 0:
        texts.append(Text(left, height + 4, "and %d more" % more, size=12, anchor="left", color=ink))
        height += step
    longest = max([len(name) for name, _ in names] + [len(title or "")], default=0)
    return draw(lines, width=10, color=colors, size=(60 + int(7.5 * longest), height + 4), background=paper, texts=texts,
                context=context)


def put_over(picture, over, x, y):
    """Composites a picture onto another, both with straight alpha. What does not fit is cut off."""
    height, width = (min(sides) for sides in zip(over.shape[:2], (picture.shape[0] - y, picture.shape[1] - x)))
    if height <= 0 or width <= 0:
        return
    below, over = picture[y:y + height, x:x + width].astype(numpy.float32), over[:height, :width].astype(numpy.float32)
    a, b = over[..., 3:] / 255, below[..., 3:] / 255
    alpha = a + b * (1 - a)
    mixed = (over[..., :3] * a + below[..., :3] * b * (1 - a)) / numpy.maximum(alpha, 1e-6)
    picture[y:y + height, x:x + width] = numpy.concatenate([mixed, 255 * alpha], axis=2) + 0.5


def add_legend(picture, colored, title, background, context):
    """Puts the legend into the lower left corner."""
    red, green, blue, alpha = parse_color(background) if background is not None else (1, 1, 1, 0)
    ink = "#222" if alpha < 0.5 or 0.3 * red + 0.59 * green + 0.11 * blue > 0.5 else "#eee"
    paper = (red, green, blue, 0.85) if alpha > 0 else (1, 1, 1, 0.85)
    made = (draw_scale if isinstance(colored, Scale) else draw_categories)(colored, title, ink, paper, context)
    put_over(picture, made, 10, max(picture.shape[0] - made.shape[0] - 10, 0))


# ---- Plots ----


def as_array(array, dtype, copy):
    """Returns an array as numpy asks for it by __array__: copy is None if it may be shared."""
    if copy is False and dtype is not None and array.dtype != dtype:
        raise ValueError("an array of %s cannot be had as %s without a copy" % (array.dtype, dtype))
    return array.astype(array.dtype if dtype is None else dtype, copy=bool(copy))


class Plot:
    """A picture of lines: an array (picture) that notebooks show. bounds: what it shows, in the CRS crs."""

    def __init__(self, picture, bounds, crs, context):
        self.picture, self.bounds, self.crs, self._context = picture, bounds, crs, context

    def __array__(self, dtype=None, copy=None):
        return as_array(self.picture, dtype, copy)

    def _repr_png_(self):
        return encode(self.picture, context=self._context)

    def save(self, path):
        """Writes the picture into a file: .png or .webp."""
        save_picture(self.picture, path, self._context)

    def __repr__(self):
        return "<camber.Plot: %d x %d px>" % (self.picture.shape[1], self.picture.shape[0])


def save_picture(picture, path, context):
    ending = os.path.splitext(os.fsdecode(path))[1].lower()
    if ending not in (".png", ".webp"):
        raise ArgumentError("%s: a picture is saved as .png or .webp" % os.fsdecode(path))
    data = encode(picture, ending[1:], context=context)
    with open(path, "wb") as file:
        file.write(data)


def check_color(data, color, column):
    """Refuses a colour that is meant as a column, and a column together with a colour."""
    if isinstance(color, str) and color in columns_of(data):
        try:
            parse_color(color)
        except ArgumentError:
            raise ArgumentError("color=%r is a column of the data; give column=%r to colour the lines by it"
                                % (color, color)) from None
    if column is not None and color is not None:
        raise ArgumentError("both column and color are given; give one of them")


def find_colors(data, column, cmap, limits, missing, count):
    """Returns a Scale or Categories."""
    values = find_column(data, column, count)
    if values.dtype != object:
        return Scale(values, cmap, *limits, missing)
    if any(limit is not None for limit in limits):
        raise ArgumentError("vmin and vmax are for numbers, and the column has texts or booleans")
    return Categories(values, cmap, missing)


def warn_of_nothing(lines, box, bbox):
    if box is None:
        warnings.warn("the picture is empty: %d rows, and none of them has a line or a point" % lines.origin_count,
                      stacklevel=3)
    elif bbox is not None and (bbox[0] > box[2] or box[0] > bbox[2] or bbox[1] > box[3] or box[1] > bbox[3]):
        warnings.warn("the picture is empty: the bbox shows %g, %g to %g, %g, and the lines are at %g, %g to %g, %g "
                      "(projected)" % (*bbox, *box), stacklevel=3)


def plot(data, column=None, *, cmap=None, vmin=None, vmax=None, color=None, missing="#bbb", width=1, size=None, bbox=None,
         crs=None, background="#fff", legend=True, title=None, context=None, **style):
    """Draws the lines of a table into a picture that shows all of them, with y up; returns a Plot.

    data: a GeoDataFrame, a GeoSeries, or anything that draw() takes. column: its name, or one value for each row. bbox:
    west, south, east and north, in the data's CRS. crs: the CRS to draw in. The style is that of draw().
    """
    check_color(data, color, column)
    if cmap is not None and column is None:
        raise ArgumentError("cmap=%r colours the values of a column; give column= too" % (cmap,))
    if isinstance(width, str):
        raise ArgumentError("width=%r; give pixels, or one number for each line, such as data[%r]" % (width, width))
    lines = as_lines(data, None, numpy.float64, numpy.int64, dots=True)
    own_crs = crs_of(data, lines)
    points = project(lines.points, own_crs, crs)
    box = box_of(points)
    shown = None if bbox is None else project_box(bbox, own_crs, crs)
    warn_of_nothing(lines, box, shown)
    fit = Fit(shown or box or (0.0, 0.0, 1.0, 1.0), size, 0 if shown else MARGIN)
    colored = None
    if column is not None:
        colored = find_colors(data, column, cmap, (vmin, vmax), missing, lines.origin_count)
    style = {"cap": "round", **style, "width": width, "size": fit.size, "background": background}
    style["color"] = "#336" if color is None else color
    if colored is not None:
        style["color"], style["rows"] = colored.colors, colored.rows
        if numpy.ndim(width):
            style["color"], style["rows"] = colored.colors[colored.rows], None
    if bbox is None:
        picture = draw(Lines(fit.to_pixels(points), lines.offsets, lines.origins, lines.origin_count), context=context,
                       **style)
    else:  # a network is cut at the picture's edges
        rows = style.pop("rows", None)
        if rows is None and (numpy.ndim(width) or as_colors(style["color"])[1]):
            rows = range(lines.origin_count)
        if len(style.pop("texts", ())):
            raise ArgumentError("texts are drawn without a bbox only")
        style.pop("fonts", None)
        network = Network(Lines(points * (1, -1), lines.offsets, lines.origins, lines.origin_count), rows=rows,
                          keep_open=style.pop("keep_open", False), dashed=style.get("dash") is not None, context=context)
        network._warns = False  # warn_of_nothing has told
        picture = network.draw(center=(fit.center[0], -fit.center[1]), scale=fit.scale, **style)
    if colored is not None and legend:
        add_legend(picture, colored, title if title is not None else column if isinstance(column, str) else None,
                   background, context)
    return Plot(picture, fit.bounds, crs if crs is not None else own_crs, context)
