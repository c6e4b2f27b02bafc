"""Arrays over the library's memory, and types of its structs."""

import numpy

from ._core import ffi

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
