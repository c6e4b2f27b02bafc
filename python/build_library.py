"""The extension camber._library: cffi reads the public headers, and the compiler checks its declarations.

No declaration is copied, so after a change to a header the extension either follows it or does not build. The headers
and libraries are those of the build folder in CAMBER_BUILD and of its source tree, or those that pkg-config finds, or
else those that build_inside.py builds.
"""

import os
import re
import shlex
import subprocess
import sys

from cffi import FFI

import build_inside

HEADERS = ("camber.h", "camber_files.h", "camber_network.h", "camber_proof.h", "camber_text.h",
           "camber_map.h", "camber_tiles.h", "camber_print.h")

# Rows with straight (not premultiplied) alpha are written to an array by C code, and pages to a file, without Python and
# its lock. Points are read once for their box, and once to become pixels: numpy would read pairs six times.
# And lines are read from GEOS, for Shapely 1, which hands them out one by one.
HELPERS = """
typedef struct camber_python_picture {
    uint8_t *rgba;
    size_t stride_bytes;
    uint32_t width;
} camber_python_picture;
bool camber_python_take_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count);
void camber_python_premultiply(const uint8_t *from, uint8_t *to, size_t count);
void *camber_python_open(const char *path);
bool camber_python_write(void *file, const void *bytes, size_t size_bytes);
bool camber_python_close(void *file);
void camber_python_bound(const double *points, size_t count, double box[4]);
void camber_python_fit(const double *points, size_t count, const double to[5], float *pixels);
typedef struct camber_python_geos {
    void *handle;
    int (*get_type)(void *handle, const void *geometry);
    const void *(*get_sequence)(void *handle, const void *geometry);
    int (*get_size)(void *handle, const void *sequence, unsigned *size);
    int (*copy)(void *handle, const void *sequence, double *to, int has_z, int has_m);
} camber_python_geos;
bool camber_python_count(const camber_python_geos *geos, const uintptr_t *lines, size_t count, uint64_t *offsets);
bool camber_python_copy(const camber_python_geos *geos, const uintptr_t *lines, size_t count, const uint64_t *offsets,
                        double *points);
"""

SOURCE = """
#include <stdio.h>
#include <string.h>
""" + "".join("#include <%s>\n" % name for name in HEADERS) + HELPERS + """
bool camber_python_take_rows(void *user, const uint8_t *rgba, uint32_t first_row, uint32_t row_count) {
    const camber_python_picture *picture = user;
    for (uint32_t y = 0; y < row_count; y++) {
        const uint8_t *from = rgba + 4 * (size_t)picture->width * y;
        uint8_t *to = picture->rgba + picture->stride_bytes * (first_row + y);
        memcpy(to, from, 4 * (size_t)picture->width);
        for (uint32_t x = 0; x < picture->width; x++, from += 4, to += 4)
            for (int c = 0; c < 3 && from[3] != 255 && from[3] != 0; c++) {
                const unsigned straight = (from[c] * 255u + from[3] / 2) / from[3];
                to[c] = (uint8_t)(straight < 255 ? straight : 255);
            }
    }
    return true;
}

void camber_python_premultiply(const uint8_t *from, uint8_t *to, size_t count) {
    for (size_t i = 0; i < count; i++, from += 4, to += 4) {
        for (int c = 0; c < 3; c++)
            to[c] = (uint8_t)((from[c] * from[3] + 127) / 255);
        to[3] = from[3];
    }
}

void *camber_python_open(const char *path) {
    return fopen(path, "wb");
}

bool camber_python_write(void *file, const void *bytes, size_t size_bytes) {
    return fwrite(bytes, 1, size_bytes, file) == size_bytes;
}

bool camber_python_close(void *file) {
    return fclose(file) == 0;
}

/* Extends a box (west, south, east, north) to the points whose x and y are both finite. */
void camber_python_bound(const double *points, size_t count, double box[4]) {
    double west = box[0], south = box[1], east = box[2], north = box[3];
    for (size_t i = 0; i < count; i++) {
        const double x = points[2 * i], y = points[2 * i + 1];
        const bool is_finite = x - x + (y - y) == 0;
        west = is_finite && x < west ? x : west;
        south = is_finite && y < south ? y : south;
        east = is_finite && x > east ? x : east;
        north = is_finite && y > north ? y : north;
    }
    box[0] = west, box[1] = south, box[2] = east, box[3] = north;
}

/* to: the centre, pixels per unit, half the picture's width and height. y points up in the points, down in the pixels. */
void camber_python_fit(const double *points, size_t count, const double to[5], float *pixels) {
    for (size_t i = 0; i < count; i++) {
        pixels[2 * i] = (float)((points[2 * i] - to[0]) * to[2] + to[3]);
        pixels[2 * i + 1] = (float)((points[2 * i + 1] - to[1]) * -to[2] + to[4]);
    }
}

/* Reads GEOS's lines: first where each of them begins, then their points. Shapely's empty line is a collection. False:
 * GEOS failed. */
bool camber_python_count(const camber_python_geos *geos, const uintptr_t *lines, size_t count, uint64_t *offsets) {
    bool is_read = true;
    offsets[0] = 0;
    for (size_t i = 0; i < count && is_read; i++) {
        const void *line = (const void *)lines[i];
        unsigned size = 0;
        if (geos->get_type(geos->handle, line) == 1) {
            const void *sequence = geos->get_sequence(geos->handle, line);
            is_read = sequence && geos->get_size(geos->handle, sequence, &size);
        }
        offsets[i + 1] = offsets[i] + size;
    }
    return is_read;
}

bool camber_python_copy(const camber_python_geos *geos, const uintptr_t *lines, size_t count, const uint64_t *offsets,
                        double *points) {
    bool is_read = true;
    for (size_t i = 0; i < count && is_read; i++)
        if (offsets[i] < offsets[i + 1])
            is_read = geos->copy(geos->handle, geos->get_sequence(geos->handle, (const void *)lines[i]),
                                 points + 2 * offsets[i], 0, 0);
    return is_read;
}
"""

# Arrow's C data interface, copied from its specification.
ARROW = """
struct ArrowSchema {
    const char *format, *name, *metadata;
    int64_t flags, n_children;
    struct ArrowSchema **children, *dictionary;
    void (*release)(struct ArrowSchema *);
    void *private_data;
};
struct ArrowArray {
    int64_t length, null_count, offset, n_buffers, n_children;
    const void **buffers;
    struct ArrowArray **children, *dictionary;
    void (*release)(struct ArrowArray *);
    void *private_data;
};
struct ArrowArrayStream {
    int (*get_schema)(struct ArrowArrayStream *, struct ArrowSchema *);
    int (*get_next)(struct ArrowArrayStream *, struct ArrowArray *);
    const char *(*get_last_error)(struct ArrowArrayStream *);
    void (*release)(struct ArrowArrayStream *);
    void *private_data;
};
"""

CALLBACKS = 'extern "Python" void camber_python_log(void *user, camber_log_level level, const char *message);'


def declarations(text):
    """Prepares a header for cffi: removes comments, directives, and constants that are not whole numbers."""
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
    text = re.sub(r"^#ifdef __cplusplus.*?^#endif", "", text, flags=re.M | re.S)
    text = re.sub(r"^(#define \w+ \w+?)u$", r"\1", text, flags=re.M)
    text = re.sub(r"^#(?!define \w+ (?:\d+|0x[0-9a-f]+)$).*\n", "", text, flags=re.M)
    return text.replace("CAMBER_API ", "")


def pkg_config(*arguments):
    command = [os.environ.get("PKG_CONFIG", "pkg-config"), *arguments, "camber-map"]
    try:
        return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError) as error:
        sys.exit("camber: %s failed: install the C library with its headers first (Debian: libcamber-dev), or set "
                 "CAMBER_BUILD to a build folder\n%s" % (shlex.join(command), getattr(error, "stderr", "")))


def locate():
    """Returns (folder of the headers, folder of the libraries, folders that the loader searches besides its own)."""
    build = os.environ.get("CAMBER_BUILD")
    if build:
        with open(os.path.join(build, "CMakeCache.txt"), encoding="utf-8") as file:
            tree = re.search(r"^CMAKE_HOME_DIRECTORY:INTERNAL=(.*)$", file.read(), re.M).group(1)
        return os.path.join(tree, "src"), os.path.join(os.path.abspath(build), "src"), []
    if build_inside.is_wanted():
        return "src", build_inside.LIBRARIES, [build_inside.RUN_PATH]
    libraries = pkg_config("--variable=libdir")
    return pkg_config("--variable=includedir"), libraries, [] if libraries.startswith("/usr/lib") else [libraries]


def make_builder():
    include, libraries, searched = locate()
    made = FFI()
    for name in HEADERS:
        with open(os.path.join(include, name), encoding="utf-8") as file:
            made.cdef(declarations(file.read()))
    made.cdef(re.sub(r"/\*.*?\*/", "", HELPERS) + ARROW + CALLBACKS)
    made.set_source("camber._library", ARROW + SOURCE, include_dirs=[include], library_dirs=[libraries],
                    libraries=["camber-map", "camber"], runtime_library_dirs=searched,
                    extra_compile_args=["-std=c11"])
    return made


builder = make_builder()
