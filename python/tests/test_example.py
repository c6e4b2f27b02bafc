"""The example: what it draws, and how long others take for the same lines."""

import os
import re
import shutil
import subprocess
import sys

import pytest

from conftest import TREE

PORTO = os.path.join(os.environ.get("CAMBER_DATA", "/nowhere"), "data/porto_portugal.osm.pbf")


def run(path, out, *before):
    pytest.importorskip("matplotlib")
    told = subprocess.run([*before, sys.executable, os.path.join(TREE, "examples/city.py"), path, out], check=True,
                          capture_output=True, text=True).stdout
    assert (out / "city-camber.png").stat().st_size > 1000 and (out / "city-matplotlib.png").exists()
    times, off = re.search(r"matplotlib: [\d.]+ ms, ([\d.]+) times .* by ([\d.]+) of 255", told).groups()
    assert float(off) < 2, told
    return float(times), told


def test_the_example(city, tmp_path):
    run(city, tmp_path)


@pytest.mark.skipif(not os.path.exists(PORTO), reason="CAMBER_DATA has no data/porto_portugal.osm.pbf")
@pytest.mark.skipif("san" in os.environ.get("LD_PRELOAD", ""), reason="a sanitizer slows camber alone")
def test_it_is_20_times_as_fast_as_matplotlib(tmp_path):
    at_once = shutil.which("chrt"), "-f", "10"  # what else runs here waits
    if not at_once[0] or subprocess.run([*at_once, "true"], capture_output=True).returncode:
        pytest.skip("no right to a real-time priority, without which other programs take part in the times")
    tries = []
    while len(tries) < 4 and max(tries, default=(0,))[0] <= 20:  # other programs still take the memory's time
        tries.append(run(PORTO, tmp_path, *at_once))
    assert max(tries)[0] > 20, tries
