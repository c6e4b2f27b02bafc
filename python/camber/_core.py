"""Contexts: a device, a lock, and the log. Every call of the library goes through this module.

A context serves one thread at a time, so each has a lock. A call holds it while Python's own lock is released. If
Python drops an object while another thread is in a call, the object waits in a queue until the call ends.
"""

import atexit
import collections
import functools
import logging
import os
import re
import tempfile
import threading

from ._library import ffi, lib

logger = logging.getLogger("camber")


class Error(Exception):
    """A call of the library failed. The text is the library's message: what failed, where, and what to do."""


class ArgumentError(Error, ValueError):
    """A value is out of range or cannot be parsed."""


class InputError(Error, ValueError):
    """The input does not have the expected format, or is truncated."""


class NotFoundError(Error, FileNotFoundError):
    """The file does not exist."""


class DeviceError(Error, RuntimeError):
    """There is no usable device, or a kernel cannot be compiled."""


class FileError(Error, OSError):
    """Reading or writing failed."""


class LimitError(Error, OverflowError):
    """Something exceeds the limit of a buffer, a picture or a memory budget."""


class OutOfMemoryError(Error, MemoryError):
    """Memory could not be allocated, or the memory budget is exhausted."""


ERRORS = {
    lib.CAMBER_ERROR_MEMORY: OutOfMemoryError,
    lib.CAMBER_ERROR_ARGUMENT: ArgumentError,
    lib.CAMBER_ERROR_INPUT: InputError,
    lib.CAMBER_ERROR_NOT_FOUND: NotFoundError,
    lib.CAMBER_ERROR_DEVICE: DeviceError,
    lib.CAMBER_ERROR_IO: FileError,
    lib.CAMBER_ERROR_LIMIT: LimitError,
}
LEVELS = {lib.CAMBER_LOG_ERROR: logging.DEBUG, lib.CAMBER_LOG_WARNING: logging.WARNING,
          lib.CAMBER_LOG_INFO: logging.INFO}


def text_of(pointer):
    """Returns the text of a C string; None if it is NULL."""
    return None if pointer == ffi.NULL else ffi.string(pointer).decode("utf-8", "replace")


def as_path(path):
    """Returns a path or text as bytes. Refuses a NUL character, because the library would end the text there."""
    path = os.fsencode(path)
    if b"\0" in path:
        raise ArgumentError("%r contains a NUL character" % path)
    return path


def as_text(text):
    return ffi.NULL if text is None else ffi.new("char[]", as_path(text))


def version():
    return text_of(lib.camber_version())


def _is_object(value):
    """Whether this is a pointer to an opaque object of the library."""
    kind = ffi.typeof(value) if isinstance(value, ffi.CData) else None
    return bool(kind and kind.kind == "pointer" and kind.item.kind == "struct" and kind.item.fields is None)


TABLE_PREFIX = "camber-table-"  # of temporary files


def name_tables(text):
    """Calls a GeoDataFrame the data, and not by the temporary file that the library reads in its place."""
    folder = re.escape(os.path.join(os.path.abspath(tempfile.gettempdir()), TABLE_PREFIX))
    return re.sub(folder + r"\w+\.geojson", "the data", text)


class _Log:
    """Keeps the message of the last failure for the exception, and also logs it at level DEBUG."""

    message = None


@ffi.def_extern()
def camber_python_log(user, level, message):
    text = name_tables(text_of(message))
    if level == lib.CAMBER_LOG_ERROR:
        ffi.from_handle(user).message = text
    logger.log(LEVELS.get(level, logging.DEBUG), "%s", text)


class Keeper:
    """Frees the objects of a context one at a time, and none before the objects that were made from it.

    Python drops the objects of a reference cycle in any order. So a dropped object waits until its children are freed.
    """

    def __init__(self):
        self.lock = threading.Lock()
        self.process = os.getpid()
        self.surface = ffi.NULL  # a call or a destructor leaves its GL context current on the thread
        # address -> [pointer, destroy, addresses of parents, number of children, whether it is dropped]
        self._held = {}
        self._dropped = collections.deque()

    def own(self, pointer, destroy, parents=()):
        """Returns the pointer. destroy frees it after Python has dropped it."""
        address = int(ffi.cast("uintptr_t", pointer))
        parents = [int(ffi.cast("uintptr_t", parent)) for parent in parents]
        self._held[address] = [pointer, destroy, parents, 0, False]
        for parent in parents:
            self._held[parent][3] += 1
        return ffi.gc(pointer, functools.partial(self._drop, address))

    def _drop(self, address, _):
        self._dropped.append(address)
        self.free_dropped()

    def free_dropped(self):
        """Frees the objects that wait. If a call is in progress, they are freed when it ends."""
        while self._dropped and self.process == os.getpid() and self.lock.acquire(blocking=False):
            try:
                while self._dropped:
                    address = self._dropped.popleft()
                    self._held[address][4] = True
                    self._free(address)
            finally:
                self.release()

    def release(self):
        """Releases the surface and then the lock, so that another thread can use both."""
        if self.surface != ffi.NULL:
            lib.camber_surface_release(self.surface)
        self.lock.release()

    def _free(self, address):
        pointer, destroy, parents, children, is_dropped = self._held[address]
        if is_dropped and children == 0:
            destroy(pointer)
            if pointer == self.surface:
                self.surface = ffi.NULL
            del self._held[address]
            for parent in parents:
                self._held[parent][3] -= 1
                self._free(parent)


class Core:
    """A C context with its lock. Use `with core:` around calls, and core.check(status) for each that can fail."""

    opened_in = None  # the process that created the first Core

    def __init__(self, access, cache_dir):
        self._refuse_fork(Core.opened_in)
        Core.opened_in = os.getpid()
        self._keeper = Keeper()
        self._owner = None
        self._log = _Log()
        handle = ffi.new_handle(self._log)
        desc = ffi.new("camber_context_desc *", {"log": lib.camber_python_log, "log_user": handle})
        texts = as_text(cache_dir), as_text(access["root"])
        desc.cache_dir, desc.access.root = texts
        desc.access.remote, desc.access.vrt = access["remote"], access["vrt"]
        made = ffi.new("camber_context **")
        self.check(lib.camber_context_create(desc, made))

        def destroy(pointer, handle=handle):  # the handle of the log must live as long as the context
            lib.camber_context_destroy(pointer)

        self.pointer = self._keeper.own(made[0], destroy)

    @staticmethod
    def _refuse_fork(process):
        if process not in (None, os.getpid()):
            raise DeviceError("camber was used before this process was forked, and its threads do not survive a fork; "
                              "use multiprocessing's start method spawn or forkserver")

    def __enter__(self):
        self._refuse_fork(self._keeper.process)
        if self._owner == threading.get_ident():
            raise RuntimeError("camber: this context is in a call already; a log handler needs a context of its own")
        self._keeper.lock.acquire()
        self._owner = threading.get_ident()
        self._log.message = None
        return self

    def __exit__(self, *_):
        self._owner = None
        self._keeper.release()
        self._keeper.free_dropped()

    def check(self, status):
        if status != lib.CAMBER_OK:
            message = self._log.message or text_of(lib.camber_status_get_name(status))
            raise ERRORS.get(status, Error)(message)

    def own(self, pointer, destroy, parents=()):
        return self._keeper.own(pointer, destroy, [self.pointer, *parents])

    def make(self, function, *arguments, parents=()):
        """Calls X_create, whose last parameter receives the object. X_destroy is called after Python has dropped it.

        Objects among the arguments are freed after the new object, and so are the parents, to which a desc refers.
        """
        made = ffi.new(ffi.typeof(function).args[-1])
        self.check(function(*arguments, made))
        name = function.__name__
        destroy = getattr(lib, name[:name.rindex("_")] + "_destroy", None) or DESTROYERS[name]
        made = self.own(made[0], destroy, [*parents, *(each for each in arguments
                                                       if _is_object(each) and each != self.pointer)])
        if function is lib.camber_surface_create:
            self._keeper.surface = ffi.cast("camber_surface *", made)  # without ownership: the keeper frees it
        return made


DESTROYERS = {"camber_style_create_builtin": lib.camber_style_destroy}

RASTERIZERS = {"auto": lib.CAMBER_RASTERIZER_AUTO, "gl": lib.CAMBER_RASTERIZER_GL, "cl": lib.CAMBER_RASTERIZER_OPENCL}


def pick(table, what, name):
    """Returns the value of a name in a table, or raises an error that lists the names."""
    try:
        return table[name]
    except (KeyError, TypeError):
        raise ArgumentError("%s is %r; choose one of: %s" % (what, name, ", ".join(table))) from None


class Context:
    """A device to draw with, and everything that is cached for it. Threads that draw at the same time need one each."""

    def __init__(self, device=None, *, draw="auto", memory=0, cache_dir=None, root=None, allow_remote=False,
                 allow_vrt=False):
        rasterizer = pick(RASTERIZERS, "draw", draw)
        self._core = Core({"root": root, "remote": allow_remote, "vrt": allow_vrt}, cache_dir)
        self._desc = ffi.new("camber_device_desc *", {"memory_bytes": memory})
        self._match = as_text(device or None)
        self._desc.match = self._match
        self._rasterizer = rasterizer
        self._opened = self._summing = None
        self._fonts = {}  # by their folders

    def _open(self, core):
        """Returns (device, renderer, a mesh for temporary pictures), opened by the first call that needs them."""
        if self._opened:
            return self._opened
        surface = ffi.NULL
        if self._rasterizer == lib.CAMBER_RASTERIZER_GL or (
                self._rasterizer == lib.CAMBER_RASTERIZER_AUTO and lib.camber_surface_may_be_hardware(ffi.NULL)):
            surface = core.make(lib.camber_surface_create, core.pointer, ffi.NULL)
            self._desc.gl = lib.camber_surface_get_handles(surface)
        device = core.make(lib.camber_device_create, core.pointer, self._desc)
        desc = ffi.new("camber_renderer_desc *", {"rasterizer": self._rasterizer})
        renderer = core.make(lib.camber_renderer_create, device, surface, desc)
        mesh = core.make(lib.camber_mesh_create, device, renderer)
        self._opened = (device, renderer, mesh)
        self._surface = surface
        return self._opened

    def _open_summing(self, core):
        """Returns (device, renderer, mesh) like _open, for sums, which only OpenCL draws."""
        if self._summing is None:
            self._summing = self._open(core)
            device, renderer, _ = self._summing
            if lib.camber_renderer_get_rasterizer(renderer) != lib.CAMBER_RASTERIZER_OPENCL:
                desc = ffi.new("camber_renderer_desc *", {"rasterizer": lib.CAMBER_RASTERIZER_OPENCL})
                renderer = core.make(lib.camber_renderer_create, device, ffi.NULL, desc)
                self._summing = device, renderer, core.make(lib.camber_mesh_create, device, renderer)
        return self._summing

    @property
    def device(self):
        """A description of the device that draws, as a dictionary."""
        with self._core as core:
            info = lib.camber_device_get_info(self._open(core)[0])
            return _describe(info)


def _describe(info):
    return {"name": text_of(info.name), "platform": text_of(info.platform), "version": text_of(info.version),
            "driver": text_of(info.driver), "type": ("other", "cpu", "gpu")[info.type],
            "compute_units": info.compute_units, "memory_bytes": info.memory_bytes}


def devices():
    """Lists the available OpenCL devices, each as a dictionary."""
    found, info = [], ffi.new("camber_device_info **")
    with default()._core as core:
        while True:
            core.check(lib.camber_device_list(core.pointer, ffi.NULL, len(found), info))
            if info[0] == ffi.NULL:
                return found
            found.append(_describe(info[0]))


def check_memory(size):
    """Refuses to use more memory than the library's own default limit: three quarters of the free memory."""
    if size < 64 << 20:
        return
    budget = ffi.new("camber_budget **")
    if lib.camber_budget_create(ffi.new("camber_budget_desc *"), budget) != lib.CAMBER_OK:
        raise OutOfMemoryError("a budget: out of memory")
    most = lib.camber_budget_get_most_bytes(budget[0])
    lib.camber_budget_destroy(budget[0])
    if size > most:
        raise OutOfMemoryError("drawing the picture takes %.1f MB, and %.1f MB are allowed; draw it in parts"
                               % (size / 1e6, most / 1e6))


_defaults = threading.local()


def default(context=None):
    """Returns the given context, or this thread's own."""
    if context is not None:
        if not isinstance(context, Context):
            raise TypeError("context is %r; give a camber.Context" % (context,))
        return context
    if not hasattr(_defaults, "context"):
        _defaults.context = Context()
    return _defaults.context


atexit.register(lambda: _defaults.__dict__.clear())  # frees the last thread's context before drivers are shut down
