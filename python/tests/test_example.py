"""The example: what it draws, and how long others take for the same lines."""

import os
import re
import subprocess
import sys

import pytest

from conftest import TREE

PORTO = os.path.join(os.environ.get("CAMBER_DATA", "/nowhere"), "data/porto_portugal.osm.pbf")


def run(path, out):
    pytest.importorskip("matplotlib")
    told = subprocess.run([sys.executable, os.path.join(TREE, "examples/city.py"), path, out], check=True,
                          capture_output=True, text=True).stdout
    assert (out / "city-camber.png").stat().st_size > 1000 and (out / "city-matplotlib.png").exists()
    times, off = re.search(r"matplotlib: [\d.]+ ms, ([\d.]+) times .* by ([\d.]+) of 255", told).groups()
    assert float(off) < 2, told
    return float(times), told


def test_the_example(city, tmp_path):
    run(city, tmp_path)


@pytest.mark.skipif(not os.path.exists(PORTO), reason="CAMBER_DATA has no data/porto_portugal.osm.pbf")
def test_it_is_faster_than_matplotlib(tmp_path):
    times, told = run(PORTO, tmp_path)
    assert times > 8, told  # 24 on a machine that does nothing else
