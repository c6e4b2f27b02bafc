"""How many lines cross each pixel, in floats, and pictures of that. The manual is docs/python.md."""

import numpy

from ._colors import parse_color, sample
from ._core import ArgumentError, default
from ._draw import sum_lines
from ._lines import Lines, as_lines
from ._plot import MARGIN, Fit, Plot, as_array, box_of, crs_of, find_column, project, project_box, warn_of_nothing

LEVELS = 65536  # of a histogram


def equalize(counts):
    """Returns the share of the pixels with something in them that have less: 0 to 1, and NaN where there is nothing."""
    shown = counts > 0
    values = counts[shown]
    made = numpy.full(counts.shape, numpy.nan, numpy.float32)
    if not len(values):
        return made
    low, high = float(values.min()), float(values.max())
    if high <= low:
        made[shown] = 1
        return made
    levels = numpy.linspace(low, high, LEVELS) if high / low < 100 else numpy.geomspace(low, high, LEVELS)
    histogram = numpy.histogram(values, levels)[0]
    below = numpy.concatenate([[0], numpy.cumsum(histogram)]).astype(numpy.float64)
    below = (below - below[1]) / max(below[-1] - below[1], 1)
    made[shown] = numpy.interp(values, levels, numpy.clip(below, 0, 1))
    return made


def stretch(counts, scale, span):
    """Returns counts from 0 to 1 by a function; NaN where there is nothing."""
    values = numpy.where(counts > 0, counts, numpy.nan).astype(numpy.float64)
    if not (counts > 0).any():
        return values
    try:
        low, high = (numpy.nanmin(values), numpy.nanmax(values)) if span is None else map(float, span)
    except (TypeError, ValueError):
        raise ArgumentError("span is %r; give two numbers, the least and the largest count" % (span,)) from None
    low, high = scale(low), scale(high)
    with numpy.errstate(invalid="ignore"):
        return numpy.clip((scale(values) - low) / ((high - low) or 1.0), 0, 1)


SCALES = {"linear": lambda values: values, "log": numpy.log1p, "cbrt": numpy.cbrt}


class Density:
    """How many lines cross each pixel: counts, a float32 array of height x width. bounds: what it shows, in the CRS crs."""

    def __init__(self, counts, bounds, crs, context):
        self.counts, self.bounds, self.crs, self._context = counts, bounds, crs, context

    def __array__(self, dtype=None, copy=None):
        return as_array(self.counts, dtype, copy)

    def shade(self, cmap="inferno", how="eq_hist", *, background="#000", span=None):
        """Returns a Plot of the counts. how: "eq_hist" gives each colour the same number of pixels; "log", "cbrt" and
        "linear" go from the least to the largest count, or over span."""
        if how == "eq_hist":
            if span is not None:
                raise ArgumentError("span is for how=\"log\", \"cbrt\" and \"linear\"; a histogram has its own")
            shares = equalize(self.counts)
        elif how in SCALES:
            shares = stretch(self.counts, SCALES[how], span)
        else:
            raise ArgumentError("how is %r; choose one of: eq_hist, %s" % (how, ", ".join(SCALES)))
        colors = numpy.concatenate([sample(cmap), [(0, 0, 0, 0) if background is None else parse_color(background)]])
        last = len(colors) - 2
        with numpy.errstate(invalid="ignore"):
            rows = numpy.where(numpy.isnan(shares), last + 1, shares * last + 0.5).astype(numpy.int64)
        return Plot((colors * 255 + 0.5).astype(numpy.uint8)[rows], self.bounds, self.crs, self._context)

    def _repr_png_(self):
        return self.shade()._repr_png_()

    def __repr__(self):
        return "<camber.Density: %d x %d px, up to %g>" % (self.counts.shape[1], self.counts.shape[0],
                                                          self.counts.max(initial=0))


def density(data, offsets=None, *, weights=None, width=1, size=None, bbox=None, crs=None, context=None, **style):
    """Counts how many lines cross each pixel, each weighted by the area of the pixel that it covers; returns a Density.

    data: as for plot(); a line that crosses itself counts once, and a geometry of several lines is one. weights: the
    name of a column, or one value for each line; a line whose value is missing is not counted. The other arguments are those of plot().
    """
    wrong = [name for name in ("color", "cmap", "background", "opacity", "overlap") if name in style]
    if wrong:
        raise ArgumentError("%s= is for pictures, and a density is numbers; camber.density(...).shade(cmap, "
                            "background=...) colours them" % wrong[0])
    lines = as_lines(data, offsets, numpy.float64, numpy.int64, dots=True)
    own_crs = crs_of(data, lines)
    points = project(lines.points, own_crs, crs)
    box = box_of(points)
    shown = None if bbox is None else project_box(bbox, own_crs, crs)
    warn_of_nothing(lines, box, shown)
    fit = Fit(shown or box or (0.0, 0.0, 1.0, 1.0), size, 0 if shown else MARGIN)
    if weights is not None:
        weights = find_column(data, weights, lines.origin_count)
        if weights.dtype.kind != "f":
            raise ArgumentError("weights are %s; give numbers" % weights.dtype)
        weights = numpy.where(numpy.isnan(weights), 0, weights)
        if (numpy.abs(weights) > numpy.finfo(numpy.float32).max).any():
            raise ArgumentError("weights go from %g to %g, which is too far for 32 bits" % (weights.min(), weights.max()))
    if numpy.ndim(width):
        raise ArgumentError("width has several values; a density has lines of one width, and weights= for each")
    style = {"cap": "round", **style, "width": width, "weights": weights, "size": fit.size, "context": default(context)}
    if bbox is None:
        drawn = as_lines(Lines(fit.to_pixels(points), lines.offsets, lines.origins, lines.origin_count), None,
                         numpy.float32, numpy.uint32)
        counts = sum_lines(drawn, **style)
    else:
        drawn = as_lines(Lines(points * (1, -1), lines.offsets, lines.origins, lines.origin_count), None, numpy.float64,
                         numpy.uint64)
        counts = sum_lines(drawn, camera=(fit.center[0], -fit.center[1], fit.scale), **style)
    return Density(counts, fit.bounds, crs if crs is not None else own_crs, context)
