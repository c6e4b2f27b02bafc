"""Maps and tiles from files, and the errors that they raise."""

import json
import subprocess

import numpy
import pytest

import camber


def test_a_map_that_moves(city):
    shown = camber.Map(city, theme="dark")
    west, south, east, north = shown.bounds
    assert -122.2 < west < east < -121.8 and 36.9 < south < north < 37.1
    whole = shown.draw(size=(200, 150))
    near = shown.draw(center=(-122.03, 36.97), zoom=13, bearing=20, pitch=40, size=(200, 150))
    assert (near != whole).any() and (shown.draw(size=(200, 150)) == whole).all()
    assert (camber.Map(city, theme="dark").draw(center=(-122.03, 36.97), zoom=13, bearing=20, pitch=40, size=(200, 150))
            == near).all()
    boxed = shown.draw(bbox=(-122.05, 36.95, -122.0, 37.0), size=(200, 150), ratio=1)
    assert (boxed != whole).any()
    points, offsets = shown.lines(size=(200, 150))
    assert points.dtype == numpy.float32 and offsets[0] == 0 and offsets[-1] == len(points) > 100
    assert camber.draw(points, offsets, size=(200, 150), width=1).any()


def test_a_style_of_ones_own(city):
    style = {"version": 8, "sources": {}, "layers": [
        {"id": "paper", "type": "background", "paint": {"background-color": "#123456"}},
        {"id": "roads", "type": "line", "paint": {"line-color": "#ff0000", "line-width": 3}}]}
    picture = camber.render(city, style=style, size=(200, 150))
    assert {tuple(each) for each in picture.reshape(-1, 4)} > {(0x12, 0x34, 0x56, 255), (255, 0, 0, 255)}


def test_a_style_with_sources_of_its_own(tmp_path):
    line = {"type": "LineString", "coordinates": [[-1, -1], [1, 1]]}
    (tmp_path / "line.geojson").write_text(json.dumps(line))
    style = tmp_path / "style.json"
    style.write_text(json.dumps({
        "version": 8, "center": [0, 0], "zoom": 5, "sources": {"line": {"type": "geojson", "data": "line.geojson"}},
        "layers": [{"id": "line", "type": "line", "source": "line", "paint": {"line-width": 4}}]}))
    shown = camber.Map(style=style)
    near = shown.draw(size=(64, 64))
    assert near[32, 32, 3] == 255 and not shown.draw(center=(90, 0), size=(64, 64)).any()
    assert (shown.draw(size=(64, 64)) == near).all()


def test_tiles(city, tool, tmp_path):
    out = tmp_path / "city.pmtiles"
    counts = camber.tiles(city, output=out, max_zoom=11, min_zoom=10, attribution="(c) somebody")
    assert counts["tiles"] > 0 and counts["bytes"] > 0 and not counts["done"]
    mine = json.loads(subprocess.run([tool, "tiles", "show", out, "--json"], check=True, capture_output=True).stdout)
    subprocess.run([tool, "tiles", city, "-o", tmp_path / "theirs.pmtiles", "--min-zoom", "10", "--max-zoom", "11",
                    "--attribution", "(c) somebody", "--name", "city.pmtiles"], check=True, capture_output=True)
    assert mine["tiles"] == counts["tiles"]
    subprocess.run([tool, "tiles", "verify", out], check=True, capture_output=True)
    with pytest.raises(OSError):
        camber.tiles(city, output=out, max_zoom=11)
    assert camber.tiles(city, output=out, max_zoom=11, min_zoom=10, attribution="(c) somebody", resume=True)["done"]


def test_tiles_of_a_context_that_nobody_keeps(city, tmp_path):
    for turn in range(3):  # the device and the renderer must outlive the engine, which a sanitizer checks
        counts = camber.Map(city, context=camber.Context()).tiles(tmp_path / ("%d.pmtiles" % turn), max_zoom=3)
        assert counts["tiles"] > 0


@pytest.mark.parametrize("call, error", [
    (lambda city: camber.render("/nowhere.osm.pbf"), FileNotFoundError),
    (lambda city: camber.render(__file__), camber.InputError),
    (lambda city: camber.render(city, style="/nowhere.json"), FileNotFoundError),
    (lambda city: camber.render(city, style="no such style"), FileNotFoundError),
    (lambda city: camber.render(city, style={"version": 7}), ValueError),
    (lambda city: camber.render(city, where="no sql at all ("), ValueError),
    (lambda city: camber.render(city, theme="blue"), ValueError),
    (lambda city: camber.render(city, center=(0, 0)), ValueError),
    (lambda city: camber.render(city, zoom=3), ValueError),
    (lambda city: camber.render(city, zoom=3, center=(0, 0), bbox=(0, 0, 1, 1)), ValueError),
    (lambda city: camber.render(city, zoom=float("nan"), center=(0, 0)), ValueError),
    (lambda city: camber.render(city, bbox=(0, 0, 1)), (ValueError, TypeError)),
    (lambda city: camber.render(city, method="cone"), ValueError),
    *((call, ValueError) for call in (
        lambda city: camber.render(city.encode() + b"\0b"), lambda city: camber.render(city, style="light\0"),
        lambda city: camber.render(city, layer="roads\0"), lambda city: camber.render(city, where="1=1\0"),
        lambda city: camber.tiles(city, output="x.pmtiles\0", max_zoom=1),
        lambda city: camber.Context(cache_dir="/tmp\0"), lambda city: camber.Context(root="/tmp\0"))),
    (lambda city: camber.Context("cpu\0").device, ValueError),
    (lambda city: camber.render(7), TypeError),
    (lambda city: camber.tiles(city, output="/nowhere/at/all.pmtiles"), OSError),
    (lambda city: camber.tiles(city, output="x.pmtiles", max_zoom=99), ValueError),
    (lambda city: camber.tiles(city, output="x.pmtiles", tile_size=100), ValueError),
    (lambda city: camber.Context("no such device").device, camber.DeviceError),
    (lambda city: camber.Context(draw="pen"), ValueError),
    (lambda city: camber.Context(memory=1).device, ValueError),
])
def test_errors_say_what_is_wrong(city, call, error, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(error) as told:
        call(city)
    assert len(str(told.value)) > 5
