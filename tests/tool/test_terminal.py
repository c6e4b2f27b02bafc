#!/usr/bin/env python3
"""What a run says on a terminal: progress with counts, which other lines erase; colours; one line at the end. In a pipe it
says only that line.

    test_terminal.py CAMBER MAP

MAP is drawn. Exits with 77, and a reason, where there are no terminals. Nothing depends on how fast the machine is: a
stage's first line is always drawn.
"""

import fcntl
import os
import pty
import re
import struct
import subprocess
import sys
import tempfile
import termios

TOOL, MAP = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
ERASE = "\r\x1b[K"
SIZE = r"[\d.,]+ (?:bytes|KB|MB)"


def check(good, what):
    if not good:
        sys.exit(f"FAILED: {what!r}")


def read_all(terminal):
    got = b""
    while True:
        try:
            block = os.read(terminal, 65536)
        except OSError: # Linux's answer where the other end is closed
            return got.decode().replace("\r\n", "\n")
        if not block:
            return got.decode().replace("\r\n", "\n")
        got += block


def on_terminal(*arguments, columns=120, both=False, status=0, **variables):
    """What the run writes to a terminal of so many columns: its standard error, or both of its streams."""
    terminal, end = pty.openpty()
    fcntl.ioctl(end, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    environment = {name: value for name, value in os.environ.items() if name != "NO_COLOR"}
    with subprocess.Popen([TOOL, *map(str, arguments)], stdin=subprocess.DEVNULL, stdout=end if both else subprocess.DEVNULL,
                          stderr=end, env={**environment, "TERM": "xterm", **variables}) as run:
        os.close(end)
        said = read_all(terminal)
    os.close(terminal)
    check(run.returncode == status, (arguments, run.returncode, said))
    return said


def shown(said):
    """The lines that a person has before them in the end, and all that were there for a while."""
    said = re.sub(r"\x1b\[\d*m", "", said)
    whiles = [part for part in said.split(ERASE)[1:] if part and "\n" not in part]
    kept = re.sub(r"[^\n]*\r\x1b\[K", "", said)
    return kept.split("\n")[:-1], whiles


def test_bar():
    said = on_terminal("tiles", MAP, "-o", "a.pmtiles", "--max-zoom", 13)
    kept, whiles = shown(said)
    bar = re.compile(r"drawing tiles   \[#* *\] +\d+ %  [\d,]+ of [\d,]+ tiles(?:, [\d.,]+/s)?(?:, [\d:]+ left)?")
    check(any(bar.fullmatch(line) for line in whiles), said)
    check(any(re.match(r"finding where lines are \[", line) for line in whiles), said)
    check(re.fullmatch(r"a.pmtiles: \d+ tiles, zooms \d+ to \d+, " + SIZE + r", [\d.]+ s", kept[-1]), said)
    check(not any("[" in line for line in kept), said)
    for line in whiles: # the count is as far as the bar, also where a file is read several times
        read = re.match(r"reading .* (\d+) %  (\d+) of (\d+) blocks", line)
        check(not read or abs(int(read[1]) / 100 * int(read[3]) - int(read[2])) <= 1, line)
    # A run that finds its tiles done, merge and verify end with a line, too.
    for arguments, last in ((["tiles", MAP, "-o", "a.pmtiles", "--max-zoom", 13, "--resume"], "a.pmtiles: is complete; nothing to do, "),
                            (["tiles", "verify", "a.pmtiles"], "a.pmtiles: no problem found in "),
                            (["tiles", "merge", "a.pmtiles", "-o", "b/"], "b/: 1 part with "),
                            (["render", MAP, "-o", "a.png", "--size", "64x64"], "a.png: 64 x 64 px, "),
                            (["bench", MAP, "--runs", 1, "--size", "64x64"], "bench: 1 run of 64 x 64 px, "),
                            (["style", "check", "city"], "city: no error in "), (["info"], "info: ")):
        kept, _ = shown(on_terminal(*arguments))
        check(kept[-1].startswith(last) and re.search(r", [\d.]+ s$", kept[-1]), (arguments, kept))


def test_narrow():
    for columns in (20, 40, 60):
        _, whiles = shown(on_terminal("tiles", MAP, "-o", "a.pmtiles", "-f", "--max-zoom", 12, columns=columns))
        check(whiles and all(len(line) < columns for line in whiles), (columns, whiles))


def test_results():
    """Lines of results on the same terminal are whole, and the bar comes back below them."""
    said = on_terminal("validate", "--only", "roads", "--method", "strip", "--windows", 8, "--draw", "cl", both=True)
    kept, whiles = shown(said)
    check(any(re.fullmatch(r"checking        \[#* *\] +\d+ %  \d+ of \d+ scenes.*", line) for line in whiles), said)
    check(not any(line.startswith("drawing") for line in whiles), "one bar, and not that of each picture")
    results = [line for line in kept if line.startswith("ok ")]
    check(results and kept[0] == "TAP version 14" and kept[-1].startswith("validate: "), said)
    check(not any("checking" in line for line in kept), said)


def test_quiet():
    check(on_terminal("tiles", MAP, "-o", "a.pmtiles", "-fq", "--max-zoom", 12) == "", "something with -q")
    kept = subprocess.run([TOOL, "tiles", MAP, "-o", "a.pmtiles", "-f", "--max-zoom", "12"], stderr=subprocess.PIPE, text=True,
                          check=True).stderr
    check("\x1b" not in kept and "\r" not in kept and kept.count("\n") == 1, kept)


def test_colors():
    wrong = ("render", "nothere.pbf", "-o", "c.png")
    check("\x1b[31mcamber: \x1b[0m" in on_terminal(*wrong, status=66), "an error is red")
    done = ("render", MAP, "-o", "c.png", "-f", "--size", "64x64")
    check("\x1b[32mc.png\x1b[0m: " in on_terminal(*done), "the last line begins in green")
    check("\x1b[33mcamber: warning: \x1b[0m" in on_terminal(*done, "--bbox", "10,10,11,11"), "a warning is yellow")
    for variables in ({"NO_COLOR": "1"}, {"TERM": "dumb"}, {"TERM": ""}):
        said = on_terminal(*done, **variables)
        check("\x1b[3" not in said and "c.png: " in said, (variables, said))
    check("\x1b[32m" in on_terminal(*done, NO_COLOR=""), "an empty NO_COLOR does not count: no-color.org")
    # The name of a file sends nothing to the terminal.
    said = on_terminal("render", MAP, "-o", "a\x1b[31mb.png", "--size", "8x8")
    check("a\x1b" not in said and "a?[31mb.png" in said, said)


def main():
    try:
        for end in os.openpty():
            os.close(end)
    except OSError:
        print("no terminals here (/dev/pts)")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for test in (test_bar, test_narrow, test_results, test_quiet, test_colors):
            test()
        os.chdir("/")


main()
