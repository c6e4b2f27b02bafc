"""city.py FILE [PICTURES]: draws a city's streets, and compares with other libraries that draw the same lines.

Each library gets the same arrays and returns an array of pixels. The time is the median of five runs. If a folder for
PICTURES is given, the pictures are saved there. matplotlib draws with its LineCollection; datashader is used if it is
installed.
"""

import sys
import time

import numpy

import camber

SIZE, WIDTH = 1024, 2


def by_camber(points, offsets):
    return camber.draw(points, offsets, width=WIDTH, color="#336", background="#fff", size=(SIZE, SIZE))


lines = camber.Map(sys.argv[1]).lines(size=(SIZE, SIZE))  # points in pixels, and where each line begins
if sys.argv[2:]:
    with open(sys.argv[2] + "/city-camber.png", "wb") as file:
        file.write(camber.encode(by_camber(*lines)))

# The city has been drawn. Below, other libraries draw it.


def by_matplotlib(points, offsets):
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.collections import LineCollection
    from matplotlib.figure import Figure
    figure = Figure(figsize=(SIZE / 100, SIZE / 100), dpi=100)
    axes = figure.add_axes((0, 0, 1, 1), xlim=(0, SIZE), ylim=(SIZE, 0))
    axes.axis("off")
    axes.add_collection(LineCollection(numpy.split(points, offsets[1:-1]), linewidths=WIDTH * 72 / 100, colors="#336",
                                       capstyle="butt", joinstyle="round"))
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return numpy.asarray(canvas.buffer_rgba())


def by_datashader(points, offsets):
    import datashader
    import pandas
    ends = numpy.insert(points, offsets[1:-1], numpy.nan, axis=0)  # datashader draws lines of a pixel or more, without joins
    canvas = datashader.Canvas(SIZE, SIZE, (0, SIZE), (0, SIZE))
    counts = canvas.line(pandas.DataFrame(ends, columns=["x", "y"]), "x", "y", agg=datashader.any(), line_width=WIDTH)
    shaded = datashader.transfer_functions.shade(counts, cmap="#333366", how="linear", span=(0, 1), min_alpha=0)
    return numpy.array(datashader.transfer_functions.set_background(shaded, "white").to_pil(origin="upper"))


def time_of(draw):
    times = []
    for _ in range(6):
        begun = time.perf_counter()
        picture = draw(*lines)
        times.append(time.perf_counter() - begun)
    return sorted(times[1:])[2], picture


ours, picture = time_of(by_camber)
print("%d lines, %d points, %d x %d px" % (len(lines[1]) - 1, len(lines[0]), SIZE, SIZE))
print("camber: %.1f ms" % (1e3 * ours))
for name, draw in ("matplotlib", by_matplotlib), ("datashader", by_datashader):
    try:
        theirs, other = time_of(draw)
    except ImportError as error:
        print("%s: %s" % (name, error))
        continue
    off = numpy.abs(picture[..., :3].astype(int) - other[..., :3]).mean()
    print("%s: %.1f ms, %.1f times as long; its pixels differ by %.2f of 255 in the mean"
          % (name, 1e3 * theirs, theirs / ours, off))
    if sys.argv[2:]:
        with open("%s/city-%s.png" % (sys.argv[2], name), "wb") as file:
            file.write(camber.encode(numpy.ascontiguousarray(other)))
