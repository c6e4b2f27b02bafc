"""table.py [LINES]: draws lines of a GeoDataFrame, coloured by a column, and compares with other libraries.

Each library gets the same GeoDataFrame, of 500,000 lines unless LINES says otherwise, and makes a picture of 1024 x 1024
pixels. datashader is used if it is installed. Then camber counts how many tracks of 10 million points cross each pixel of
2048 x 2048. Each time is the median of three runs.
"""

import sys
import time

import geopandas
import numpy
from shapely.geometry import LineString

import camber

SIZE = 1024
COUNT = int(sys.argv[1]) if sys.argv[1:] else 500000
random = numpy.random.default_rng(4)
steps = numpy.cumsum(random.normal(0, 0.003, (COUNT, 6, 2)), axis=1)
places = random.normal((24.9, 60.2), (0.3, 0.12), (COUNT, 1, 2)) + steps
streets = geopandas.GeoDataFrame({"speed": random.gamma(4, 12, COUNT)}, geometry=[LineString(line) for line in places],
                                 crs="EPSG:4326").to_crs(3857)


def by_camber():
    return camber.plot(streets, column="speed", cmap="viridis", width=1, size=(SIZE, SIZE)).picture


def by_matplotlib():
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    figure = Figure(figsize=(SIZE / 100, SIZE / 100), dpi=100)
    canvas = FigureCanvasAgg(figure)
    streets.plot("speed", cmap="viridis", linewidth=0.72, legend=True, ax=figure.add_axes((0, 0, 1, 1)))
    canvas.draw()
    return numpy.asarray(canvas.buffer_rgba())


def by_datashader():
    import datashader
    import spatialpandas
    table = spatialpandas.GeoDataFrame(streets)
    values = datashader.Canvas(SIZE, SIZE).line(table, geometry="geometry", agg=datashader.max("speed"))
    return datashader.transfer_functions.shade(values, cmap="viridis").to_pil()


def time_of(draw):
    times = []
    for _ in range(3):
        begun = time.perf_counter()
        draw()
        times.append(time.perf_counter() - begun)
    return 1e3 * sorted(times)[1]


print("%d lines, %d x %d px" % (COUNT, SIZE, SIZE))
camber.plot(streets[:10], column="speed")  # the first picture opens the device
print("camber: %.0f ms" % time_of(by_camber))
for name, draw in ("matplotlib", by_matplotlib), ("datashader", by_datashader):
    try:
        print("%s: %.0f ms" % (name, time_of(draw)))
    except ImportError as error:
        print("%s is left out: %s" % (name, error))

tracks = numpy.cumsum(random.normal(0, 1, (100 * COUNT // 500, 100, 2)), axis=1) + random.normal(0, 400, (COUNT // 5, 1, 2))
points, offsets = tracks.reshape(-1, 2), numpy.arange(0, tracks.size // 2 + 1, 100)
print("density: %.0f ms, of %d points" % (time_of(lambda: camber.density(points, offsets, size=(2048, 2048))), len(points)))
