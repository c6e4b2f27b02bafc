"""Arrays over the library's memory, types of its structs, and colours."""

import numpy

from ._core import ArgumentError, ffi

KINDS = {"float": "f4", "double": "f8", "int16_t": "i2", "uint16_t": "u2", "int32_t": "i4", "uint32_t": "u4",
         "uint8_t": "u1", "size_t": "u8"}


def dtype_of(name):
    """Returns numpy's type of a C struct: its numeric fields, at the offsets that the compiler chose."""
    names, formats, offsets = [], [], []
    for field, about in ffi.typeof(name).fields:
        kind = KINDS.get(about.type.cname) or ("u4" if about.type.kind == "enum" else None)
        if about.type.kind == "struct":
            kind = dtype_of(about.type.cname)
        if kind:
            names.append(field)
            formats.append(kind)
            offsets.append(about.offset)
    return numpy.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": ffi.sizeof(name)})


def view(pointer, name, count, owner):
    """Returns a structured array that uses the library's memory, without a copy. owner frees the memory."""
    if pointer == ffi.NULL or count == 0:
        return numpy.zeros(0, name if isinstance(name, numpy.dtype) else numpy.dtype(name))
    dtype = numpy.dtype(name)
    kept = ffi.gc(ffi.cast("char *", pointer), lambda _, owner=owner: None)
    return numpy.frombuffer(ffi.buffer(kept, count * dtype.itemsize), dtype)


# ---- Colours and styles ----


def parse_color(color):
    """Parses "#rgb", "#rgba", "#rrggbb", "#rrggbbaa", or three or four numbers from 0 to 1; returns four floats from 0
    to 1."""
    if isinstance(color, str):
        digits = color[1:]
        if len(digits) in (3, 4):
            digits = "".join(digit * 2 for digit in digits)
        try:
            if color[:1] == "#" and len(digits) in (6, 8) and digits.isalnum():
                return tuple(byte / 255 for byte in bytes.fromhex(digits)) + (1.0,) * (len(digits) == 6)
        except ValueError:
            pass
    else:
        try:
            values = tuple(float(value) for value in color)
        except (TypeError, ValueError):
            values = ()
        if len(values) in (3, 4) and all(0 <= value <= 1 for value in values):
            return values + (1.0,) * (len(values) == 3)
    raise ArgumentError("%r is not a colour; give \"#rgb\", \"#rrggbb\", either followed by alpha, or three or four "
                        "numbers from 0 to 1" % (color,))


def as_colors(color):
    """Returns n x 4 floats, and whether several colours were given: an array, or a list of values for parse_color."""
    if isinstance(color, str) or (numpy.ndim(color) == 1 and len(color) and not isinstance(color[0], str)):
        return numpy.array([parse_color(color)], numpy.float32), False
    array = numpy.asarray(color)
    if array.size == 0:
        return numpy.zeros((0, 4), numpy.float32), True
    if array.dtype == numpy.uint8:
        array = array / numpy.float32(255)
    if array.dtype.kind != "f":
        return numpy.array([parse_color(each) for each in color], numpy.float32).reshape(-1, 4), True
    if array.ndim != 2 or array.shape[1] not in (3, 4) or not ((array >= 0) & (array <= 1)).all():
        raise ArgumentError("colours have the shape %s; give n x 3 or n x 4, numbers from 0 to 1 or bytes"
                            % (array.shape,))
    colors = numpy.ones((len(array), 4), numpy.float32)
    colors[:, :array.shape[1]] = array
    return colors, True
