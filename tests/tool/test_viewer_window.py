#!/usr/bin/env python3
"""The example with a window, on a screen: Xvfb's, with openbox as the window manager and xdotool as the user.

    test_viewer_window.py VIEWER TOOL CITY OUT

Each step acts as a user does, waits until the picture stays, and compares what the screen shows with `camber render` of
the view that the window's title names, or with the picture before. The screenshots stay in OUT. Exit status 1: the first
failure, on standard error; 77: a program is missing.
"""

import json
import os
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import zlib

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "fixtures"))

import png_rows  # noqa: E402

VIEWER, TOOL, CITY, OUT = (os.path.abspath(argument) for argument in sys.argv[1:5])
WIDTH, HEIGHT = 480, 320
PATIENCE_S = 300  # for what happens at once on an idle machine: only what hangs takes longer
# The title's digits say where the camera is to some thousandths of a px; in a few pixels a point stays or goes by that.
MOST_LEVELS, MOST_OTHERS = 2, 1e-4

# Windows without a frame, and a key that closes them.
MANAGER = """<openbox_config xmlns="http://openbox.org/3.4/rc">
  <theme><keepBorder>no</keepBorder></theme>
  <keyboard><keybind key="A-F4"><action name="Close"/></keybind></keyboard>
  <applications><application class="*"><decor>no</decor></application></applications>
</openbox_config>"""


def expect(condition, message):
    if not condition:
        sys.exit(f"test_viewer_window: {message}")


def write_png(path, rows):
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    raw = b"".join(b"\0" + row for row in rows)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]) // 4, len(rows), 8, 6, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(raw, 1)) + chunk(b"IEND", b""))


def share_beyond(one, other, levels):
    """The share of bytes of two pictures that differ by more."""
    others = sum(sum(abs(p - q) > levels for p, q in zip(a, b)) for a, b in zip(one, other) if a != b)
    return others / (len(one) * len(one[0]))


def mean_difference(one, other):
    """The mean difference of two pictures of one size, in levels."""
    expect(len(one) == len(other) and len(one[0]) == len(other[0]), "two pictures of different sizes")
    total = sum(sum(abs(p - q) for p, q in zip(a, b)) for a, b in zip(one, other) if a != b)
    return total / (len(one) * len(one[0]) * 0.75)


class Screen:
    """A screen without a device: the server keeps its pixels in a file of the folder, in the format of xwd."""

    def __init__(self, folder):
        self.file = os.path.join(folder, "Xvfb_screen0")
        read, write = os.pipe()
        self.server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "1000x700x24", "-fbdir", folder,
                                        "-nolisten", "tcp", "-nocursor"], pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as file:
            number = file.readline().strip()
        expect(number, "Xvfb does not start")
        self.environment = dict(os.environ, DISPLAY=f":{number}", SDL_VIDEODRIVER="x11")
        with open(os.path.join(folder, "rc.xml"), "w", encoding="utf-8") as file:
            file.write(MANAGER)
        self.manager = subprocess.Popen(["openbox", "--config-file", file.name], env=self.environment, stderr=subprocess.DEVNULL)
        self.wait_for_manager()

    def wait_for_manager(self):
        """A window that is opened while the manager starts may never be shown, for which SDL waits for ever."""
        begin = time.monotonic()
        while subprocess.run(["xdotool", "get_num_desktops"], env=self.environment, capture_output=True).returncode != 0:
            expect(time.monotonic() - begin < PATIENCE_S, "openbox does not start")
            time.sleep(0.1)

    def close(self):
        for process in (self.manager, self.server):
            process.send_signal(signal.SIGTERM)
            process.wait()

    def rows(self, left, top, width, height):
        with open(self.file, "rb") as file:
            data = file.read()
        head = struct.unpack(">25I", data[:100])
        line_bytes, begin = head[12], head[0] + 12 * head[19]
        rows = []
        for y in range(top, top + height):
            at = begin + y * line_bytes + 4 * left
            row = bytearray(data[at:at + 4 * width])
            row[0::4], row[2::4], row[3::4] = row[2::4], row[0::4], b"\xff" * width
            rows.append(bytes(row))
        return rows


class Window:
    """A viewer, and the user's hands on it."""

    def __init__(self, screen, *arguments):
        self.screen, self.shown = screen, None
        self.process = subprocess.Popen([VIEWER, CITY, "--size", f"{WIDTH}x{HEIGHT}", *arguments], env=screen.environment)
        self.id = self.wait("no window", lambda: self.ask("search", "--onlyvisible", "--pid", str(self.process.pid)))
        self.id = self.id.split()[-1]
        self.settle("start")

    def ask(self, *arguments):
        done = subprocess.run(["xdotool", *arguments], env=self.screen.environment, capture_output=True, text=True)
        return done.stdout.strip() if done.returncode == 0 else ""

    def wait(self, message, condition):
        begin = time.monotonic()
        while time.monotonic() - begin < PATIENCE_S:
            found = condition()
            if found:
                return found
            expect(self.process.poll() is None, f"the viewer has ended with {self.process.poll()}")
            time.sleep(0.1)
        return expect(False, message)

    def title(self):
        words = self.ask("getwindowname", self.id).split()
        return words[:8] if len(words) >= 8 else None  # whom to name comes behind

    def shot(self):
        place = dict(line.split("=") for line in self.ask("getwindowgeometry", "--shell", self.id).split())
        return self.screen.rows(*(int(place[key]) for key in ("X", "Y", "WIDTH", "HEIGHT")))

    def rest(self, name, other=None):
        """The picture that stays for half a second, and is another one than that."""
        last, since = None, time.monotonic()

        def is_still():
            nonlocal last, since
            rows, title = self.shot(), self.title()
            if (rows, title) != last or not title:
                last, since = (rows, title), time.monotonic()
            return time.monotonic() - since > 0.5 and rows != other
        self.wait(f"{name}: the picture does not come to rest", is_still)
        return last[0]

    def settle(self, name, is_other=True):
        self.before, self.shown = self.shown, self.rest(name, self.shown if is_other else None)
        write_png(os.path.join(OUT, f"{name}.png"), self.shown)

    def expect_view(self, name, *options):
        """What is shown is what `camber render` draws of the view in the title, or comes to be: tiles may still be read."""
        path, begin = os.path.join(OUT, "rendered.png"), time.monotonic()
        while True:
            title = self.title()
            _, centre, _, zoom, _, bearing, _, pitch = title
            subprocess.run([TOOL, "render", CITY, "-q", "--no-labels", "-f", "-o", path, "--size", f"{len(self.shown[0]) // 4}x{len(self.shown)}",
                            f"--center={centre}", "--zoom", zoom, f"--bearing={bearing}", "--pitch", pitch, *options], check=True)
            with open(path, "rb") as file:
                share = share_beyond(self.shown, png_rows.decode(file.read()), MOST_LEVELS)
            if share <= MOST_OTHERS:
                return
            expect(time.monotonic() - begin < PATIENCE_S, f"{name}: {100 * share:g} % are not as camber render draws {title}")
            self.shown = self.rest(name)

    def drag(self, button, right, down):
        self.ask("mousemove", "--window", self.id, "200", "200", "mousedown", str(button))
        for i in range(1, 11):
            self.ask("mousemove", "--window", self.id, str(200 + right * i // 10), str(200 + down * i // 10))
        self.ask("mouseup", str(button))

    def press(self, *keys):
        self.ask("windowfocus", "--sync", self.id, "key", *keys)


def look_around(screen, draw, drawn):
    """Pans, zooms, turns, tilts, changes the theme, shows the graph, resizes, minimises and closes."""
    window = Window(screen, "--draw", draw)
    window.expect_view(f"{draw}: start", *drawn)
    start = window.shown
    window.drag(1, 60, 40)
    window.settle(f"{draw}-pan")
    window.expect_view(f"{draw}: pan", *drawn)
    def has_followed():
        moved = [row[240:] for row in window.shot()[40:]]
        return mean_difference(moved, [row[:-240] for row in start[:-40]]) < 1
    window.wait(f"{draw}: the map did not follow the pointer", has_followed)
    window.settle(f"{draw}-panned", is_other=False)
    window.ask("mousemove", "--window", window.id, "300", "100", *["click", "4"] * 6)
    window.settle(f"{draw}-zoom")
    window.expect_view(f"{draw}: zoom", *drawn)
    expect(mean_difference(window.before, window.shown) > 3, f"{draw}: the wheel zooms nothing")
    window.drag(3, 90, -110)
    window.wait(f"{draw}: it does not turn to 36 and tilt to 33 degrees",
                lambda: (window.title() or [""] * 8)[5::2] == ["36.00", "33.00"])
    window.settle(f"{draw}-turn")
    window.expect_view(f"{draw}: turn", *drawn)
    window.press("t")
    window.settle(f"{draw}-dark")
    window.expect_view(f"{draw}: dark", "--theme", "dark", *drawn)
    window.press("g")
    window.settle(f"{draw}-graph")
    rest = [row[4 * 240:] for row in window.before]
    expect(mean_difference(rest, [row[4 * 240:] for row in window.shown]) == 0, f"{draw}: the graph is not in its corner")
    expect(mean_difference(window.before, window.shown) > 0.2, f"{draw}: no graph")
    window.press("g")
    window.ask("windowsize", "--sync", window.id, "610", "370")
    window.settle(f"{draw}-resized")
    expect((len(window.shown[0]) // 4, len(window.shown)) == (610, 370), f"{draw}: not resized")
    window.expect_view(f"{draw}: resized", "--theme", "dark", *drawn)
    window.ask("windowminimize", "--sync", window.id)
    window.wait(f"{draw}: minimised, but the screen is not empty", lambda: len(set(screen.rows(100, 100, 200, 200))) == 1)
    window.ask("windowactivate", "--sync", window.id)
    window.wait(f"{draw}: restored, the picture is another", lambda: window.shot() == window.shown)
    window.settle(f"{draw}-restored", is_other=False)
    expect(mean_difference(window.before, window.shown) == 0, f"{draw}: restored, the picture is another")
    window.press("alt+F4")
    expect(window.process.wait(timeout=PATIENCE_S) == 0, f"{draw}: closed, the viewer ends with {window.process.returncode}")


def edit_style(screen, folder):
    """The style's file is written while the viewer runs; what is no style leaves the picture as it is."""
    path = os.path.join(folder, "style.json")

    def write(background, width):
        layers = [{"id": "b", "type": "background", "paint": {"background-color": background}},
                  {"id": "l", "type": "line", "source": "s", "paint": {"line-color": "#a02020", "line-width": width}}]
        with open(path, "w", encoding="utf-8") as file:
            json.dump({"version": 8, "sources": {"s": {"type": "geojson"}}, "layers": layers}, file)
    write("#e0e0e0", 2)
    window = Window(screen, "--draw", "cl", "--style", path)
    window.expect_view("style", "--style", path)
    write("#203040", 5)
    window.wait("the style is not read again", lambda: window.shot()[0] != window.shown[0])
    window.settle("edited")
    window.expect_view("edited", "--style", path)
    with open(path, "w", encoding="utf-8") as file:
        file.write("{")
    time.sleep(1)  # it may look at the file meanwhile, and keeps what it has
    window.settle("broken", is_other=False)
    expect(mean_difference(window.before, window.shown) == 0, "a broken style changes the picture")
    window.press("Escape")
    expect(window.process.wait(timeout=PATIENCE_S) == 0, f"the viewer ends with {window.process.returncode}")


def main():
    for program in ("Xvfb", "openbox", "xdotool"):
        if not shutil.which(program):
            print(f"no {program} here")
            sys.exit(77)
    os.makedirs(OUT, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        screen = Screen(folder)
        try:
            look_around(screen, "cl", ["--draw", "cl"])
            look_around(screen, "gl", ["--draw", "gl"])
            edit_style(screen, folder)
        finally:
            screen.close()


main()
