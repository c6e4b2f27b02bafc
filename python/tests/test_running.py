"""Threads, processes, the log, and thousands of calls, after which memory must not have grown."""

import gc
import logging
import os
import subprocess
import sys
import threading
import time

import numpy
import pytest

import camber

POINTS = numpy.random.default_rng(1).uniform(0, 64, (200, 2)).astype(numpy.float32)
OFFSETS = numpy.arange(0, 201, 10)


def test_two_threads_with_two_contexts_draw_at_once():
    wanted, wrong, done = camber.draw(POINTS, OFFSETS, size=(64, 64)), [], []

    def draw(context):
        for _ in range(50):
            if not (camber.draw(POINTS, OFFSETS, size=(64, 64), context=context) == wanted).all():
                wrong.append(context)
        done.append(context)

    for contexts in (None, None), (camber.Context(), camber.Context()), (camber.Context(),) * 2:
        threads = [threading.Thread(target=draw, args=(context,)) for context in contexts]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    assert len(done) == 6 and not wrong


BIG = numpy.random.default_rng(2).uniform(0, 2000, (400000, 2)).astype(numpy.float32)
BIG_OFFSETS = numpy.arange(0, 400001, 4, dtype=numpy.uint32)
DRAWS_MAX = 500  # a limit that is reached only if drawing lets no other thread run


def steps_within_a_draw(step, wanted):
    """Draws a lot, repeatedly, while another thread takes steps. Returns how many steps, up to `wanted`, it takes
    during one of the draws. The switch interval is long, so the other thread can only run while C code has released
    Python's lock."""
    network, stop, count = camber.Network(BIG, BIG_OFFSETS, context=camber.Context()), threading.Event(), [0]
    interval, most = sys.getswitchinterval(), 0

    def run():
        while not stop.is_set():
            step()
            count[0] += 1

    thread = threading.Thread(target=run)
    sys.setswitchinterval(1000)
    thread.start()
    try:
        for _ in range(DRAWS_MAX):
            before = count[0]
            network.draw(size=(2000, 2000))
            most = max(most, count[0] - before)
            if most >= wanted:
                break
    finally:
        sys.setswitchinterval(interval)
        stop.set()
        thread.join()
    return most


def test_draws_of_two_contexts_overlap():
    small = camber.Context()
    # Two steps, because the first one may have begun before the draw.
    assert steps_within_a_draw(lambda: camber.draw(POINTS, OFFSETS, size=(64, 64), context=small), 2) >= 2


def gl_context(**about):
    try:
        camber.Context(draw="gl").device
    except camber.DeviceError as error:
        pytest.skip("no GL: %s" % error)
    return camber.Context(draw="gl", **about)


def test_gl_is_free_for_the_next_thread():
    context, kept = gl_context(), []

    def draw():
        kept.append(camber.Network(POINTS, OFFSETS, context=context))
        kept.append(kept[0].draw(size=(64, 64)))

    def run():
        thread = threading.Thread(target=draw)
        thread.start()
        thread.join()
        return kept.pop()

    first = run()
    kept.clear()  # frees its mesh here, which requires its GL context to be current
    assert (run() == first).all() and len(kept) == 1


def test_a_device_that_does_not_open_leaves_no_surface():
    context = gl_context(memory=1)
    for _ in range(3):
        with pytest.raises(ValueError):
            context.device
        gc.collect()
        # This opens no surface. A sanitizer notices if the call uses the freed surface.
        assert camber.encode(numpy.zeros((4, 4, 4), numpy.uint8), context=context)


def test_python_goes_on_while_it_draws():
    assert steps_within_a_draw(lambda: time.sleep(0), 2) >= 2


def test_objects_go_in_any_order(city):
    context = camber.Context()
    network, shown = camber.Network(POINTS, OFFSETS, context=context), camber.Map(city, context=context)
    mesh = camber.tessellate(POINTS, OFFSETS, context=context)
    network.draw(size=(9, 9)), shown.draw(size=(9, 9))
    records, kept = mesh.records, mesh.records.copy()
    del context, mesh
    gc.collect()
    assert network.draw(size=(64, 64)).any() and shown.draw(size=(64, 64)).any()
    del network
    thread = threading.Thread(target=lambda: shown.draw(size=(9, 9)))
    thread.start()
    thread.join()
    del shown
    gc.collect()
    assert (records == kept).all()


def test_the_log(caplog, tmp_path):
    (tmp_path / "bad.geojson").write_text('{"type": "LineString", "coordinates": [[0, 0], [1, 1]]}')
    style = {"version": 8, "sources": {}, "layers": [{"id": "a", "type": "heatmap"}]}
    with caplog.at_level(logging.DEBUG, "camber"):
        camber.render(tmp_path / "bad.geojson", style=style, size=(9, 9))
        with pytest.raises(FileNotFoundError) as told:
            camber.render("/nowhere")
    assert any(record.levelno == logging.WARNING and "heatmap" in record.message for record in caplog.records)
    assert any(record.levelno == logging.DEBUG and record.message == str(told.value) for record in caplog.records)


def test_a_log_handler_that_draws_is_told(city, tmp_path):
    context, told = camber.Context(), []

    class Handler(logging.Handler):
        def emit(self, record):
            try:
                camber.draw(POINTS, context=context)
            except RuntimeError as error:
                told.append(str(error))

    handler, logger = Handler(), logging.getLogger("camber")
    logger.addHandler(handler)
    logger.setLevel(logging.DEBUG)  # failures are logged at this level
    try:
        with pytest.raises(FileNotFoundError):
            camber.render("/nowhere", context=context)
    finally:
        logger.setLevel(logging.NOTSET)
        logger.removeHandler(handler)
    assert told and "in a call already" in told[0]
    assert camber.draw(POINTS, OFFSETS, size=(64, 64), context=context).any()


def test_a_context_is_a_context():
    for wrong in (5, "cpu", object()):
        with pytest.raises(TypeError, match="camber.Context"):
            camber.draw(POINTS, size=(9, 9), context=wrong)
        with pytest.raises(TypeError, match="camber.Context"):
            camber.Map("map.json", context=wrong)


def test_a_picture_has_a_budget():
    with open("/proc/meminfo", encoding="ascii") as file:
        free = next(int(line.split()[1]) << 10 for line in file if line.startswith("MemAvailable"))
    side = 65535
    if free > 16 * side * side:
        pytest.skip("this machine has room for it")
    with pytest.raises(camber.OutOfMemoryError, match="draw it in parts"):
        camber.draw(POINTS, size=(side, side))


def test_a_forked_process_is_told():
    camber.draw(POINTS, size=(9, 9))
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            camber.draw(POINTS, size=(9, 9))
        except camber.Error as error:
            os.write(write, str(error).encode())
        finally:
            os._exit(0)
    os.close(write)
    with os.fdopen(read) as file:
        assert "forked" in file.read()
    os.waitpid(child, 0)


def test_a_program_ends_well():
    program = ("import numpy, camber, threading\n"
               "keep = camber.Network(numpy.eye(2)), camber.Map(), camber.tessellate(numpy.eye(2))\n"
               "t = threading.Thread(target=lambda: camber.draw(numpy.eye(2), size=(9, 9))); t.start(); t.join()\n"
               "print(keep[0].draw(size=(9, 9)).shape)")
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "(9, 9, 4)\n", "")


def resident_bytes():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


CALLS = int(os.environ.get("CAMBER_CALLS", "2000"))  # tests/tool/test_python.sh sets a higher number with a sanitizer


def test_thousands_of_calls():
    network = camber.Network(POINTS, OFFSETS)
    context = camber.Context()
    held = None
    for call in range(CALLS):
        kind = call % 5
        if kind == 0:
            camber.draw(POINTS, OFFSETS, size=(32, 32), width=numpy.full(20, 2.0), color=["#123"] * 20)
        elif kind == 1:
            network.draw(size=(32, 32), bearing=call, dash=None)
        elif kind == 2:
            camber.tessellate(POINTS, OFFSETS, context=context).records.sum
        elif kind == 3:
            with pytest.raises(ValueError):
                camber.draw(POINTS, OFFSETS, size=(32, 32), width=-1)
        else:
            camber.encode(camber.draw(POINTS, OFFSETS, size=(32, 32), dash=[3, 2], context=context), context=context)
        if call == CALLS * 2 // 5:
            gc.collect()
            held = resident_bytes(), len(os.listdir("/proc/self/fd")), threading.active_count()
    gc.collect()
    assert (len(os.listdir("/proc/self/fd")), threading.active_count()) == held[1:]
    grown = resident_bytes() - held[0]
    assert grown < 4 << 20, "%d bytes more after %d calls" % (grown, CALLS * 3 // 5)
