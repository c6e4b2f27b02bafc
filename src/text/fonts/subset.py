#!/usr/bin/python3
"""Makes the fonts that camber ships from Debian's Noto Sans (fonts-noto-core). subset.py FOLDER writes them there.

They have Latin, Greek, Cyrillic, punctuation, currency signs and arrows, with the tables that shape them, but no hints,
because camber draws outlines. The same input gives the same bytes (fonttools 4.38)."""
import os
import sys

from fontTools import subset
from fontTools.ttLib import TTFont

SOURCES = "/usr/share/fonts/truetype/noto"
FONTS = {"NotoSans-Regular.ttf": "regular.ttf", "NotoSans-Bold.ttf": "bold.ttf", "NotoSans-Italic.ttf": "italic.ttf"}
RANGES = ((0x20, 0x7e), (0xa0, 0x17f), (0x18f, 0x18f), (0x192, 0x192), (0x1a0, 0x1a1), (0x1af, 0x1b0), (0x1cd, 0x1dc),
          (0x1e6, 0x1e7), (0x1ea, 0x1eb), (0x1fa, 0x21b), (0x259, 0x259), (0x2b9, 0x2bf), (0x2c6, 0x2dd),
          (0x300, 0x304), (0x306, 0x30c), (0x31b, 0x31b), (0x323, 0x323), (0x326, 0x328), (0x331, 0x331),
          (0x370, 0x3e1), (0x400, 0x52f), (0x1e00, 0x1eff), (0x2010, 0x2027), (0x202f, 0x203a), (0x2044, 0x2044),
          (0x2070, 0x208e), (0x20a0, 0x20bf), (0x2113, 0x2122), (0x2150, 0x215e), (0x2190, 0x2199), (0x2212, 0x2212),
          (0x25cc, 0x25cc), (0xfb01, 0xfb02), (0xfffd, 0xfffd))


def main(folder):
    options = subset.Options()
    options.hinting = False
    options.name_IDs = [0, 1, 2, 3, 4, 5, 6, 13, 14]
    options.notdef_outline = True
    options.layout_features = ["ccmp", "locl", "mark", "mkmk", "kern", "liga"]
    options.drop_tables += ["MATH", "STAT"]
    codes = [code for first, last in RANGES for code in range(first, last + 1)]
    for source, made in FONTS.items():
        with TTFont(os.path.join(SOURCES, source), recalcTimestamp=False) as font:
            subsetter = subset.Subsetter(options)
            subsetter.populate(unicodes=codes)
            subsetter.subset(font)
            font.save(os.path.join(folder, made))


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
