"""Tests the example's own drawing, and that other libraries draw the same lines in the same way. ./dev bench measures
the times."""

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
    off = re.search(r"matplotlib: .* by ([\d.]+) of 255", told).group(1)
    assert float(off) < 2, told


def test_the_example(city, tmp_path):
    run(city, tmp_path)


def test_the_example_of_a_table():
    pytest.importorskip("matplotlib")
    pytest.importorskip("geopandas")
    told = subprocess.run([sys.executable, os.path.join(TREE, "examples/table.py"), "500"], check=True,
                          capture_output=True, text=True).stdout
    assert re.search(r"^500 lines.*^camber: \d+ ms.*^matplotlib: \d+ ms.*^density: \d+ ms, of 10000 points$", told,
                     re.S | re.M), told


@pytest.mark.skipif(not os.path.exists(PORTO), reason="CAMBER_DATA has no data/porto_portugal.osm.pbf")
def test_the_example_of_a_large_city(tmp_path):
    run(PORTO, tmp_path)
