"""Colours: their names in CSS, parsing, and colour maps."""

import difflib
import importlib

import numpy

from ._core import ArgumentError

# Each name and its six digits.
_NAMES = """
    aliceblue f0f8ff antiquewhite faebd7 aqua 00ffff aquamarine 7fffd4 azure f0ffff beige f5f5dc bisque ffe4c4 black
    000000 blanchedalmond ffebcd blue 0000ff blueviolet 8a2be2 brown a52a2a burlywood deb887 cadetblue 5f9ea0
    chartreuse 7fff00 chocolate d2691e coral ff7f50 cornflowerblue 6495ed cornsilk fff8dc crimson dc143c cyan 00ffff
    darkblue 00008b darkcyan 008b8b darkgoldenrod b8860b darkgray a9a9a9 darkgreen 006400 darkkhaki bdb76b darkmagenta
    8b008b darkolivegreen 556b2f darkorange ff8c00 darkorchid 9932cc darkred 8b0000 darksalmon e9967a darkseagreen
    8fbc8f darkslateblue 483d8b darkslategray 2f4f4f darkturquoise 00ced1 darkviolet 9400d3 deeppink ff1493
    deepskyblue 00bfff dimgray 696969 dodgerblue 1e90ff firebrick b22222 floralwhite fffaf0 forestgreen 228b22 fuchsia
    ff00ff gainsboro dcdcdc ghostwhite f8f8ff gold ffd700 goldenrod daa520 gray 808080 green 008000 greenyellow adff2f
    honeydew f0fff0 hotpink ff69b4 indianred cd5c5c indigo 4b0082 ivory fffff0 khaki f0e68c lavender e6e6fa
    lavenderblush fff0f5 lawngreen 7cfc00 lemonchiffon fffacd lightblue add8e6 lightcoral f08080 lightcyan e0ffff
    lightgoldenrodyellow fafad2 lightgreen 90ee90 lightgray d3d3d3 lightpink ffb6c1 lightsalmon ffa07a lightseagreen
    20b2aa lightskyblue 87cefa lightslategray 778899 lightsteelblue b0c4de lightyellow ffffe0 lime 00ff00 limegreen
    32cd32 linen faf0e6 magenta ff00ff maroon 800000 mediumaquamarine 66cdaa mediumblue 0000cd mediumorchid ba55d3
    mediumpurple 9370db mediumseagreen 3cb371 mediumslateblue 7b68ee mediumspringgreen 00fa9a mediumturquoise 48d1cc
    mediumvioletred c71585 midnightblue 191970 mintcream f5fffa mistyrose ffe4e1 moccasin ffe4b5 navajowhite ffdead
    navy 000080 oldlace fdf5e6 olive 808000 olivedrab 6b8e23 orange ffa500 orangered ff4500 orchid da70d6
    palegoldenrod eee8aa palegreen 98fb98 paleturquoise afeeee palevioletred db7093 papayawhip ffefd5 peachpuff ffdab9
    peru cd853f pink ffc0cb plum dda0dd powderblue b0e0e6 purple 800080 rebeccapurple 663399 red ff0000 rosybrown
    bc8f8f royalblue 4169e1 saddlebrown 8b4513 salmon fa8072 sandybrown f4a460 seagreen 2e8b57 seashell fff5ee sienna
    a0522d silver c0c0c0 skyblue 87ceeb slateblue 6a5acd slategray 708090 snow fffafa springgreen 00ff7f steelblue
    4682b4 tan d2b48c teal 008080 thistle d8bfd8 tomato ff6347 turquoise 40e0d0 violet ee82ee wheat f5deb3 white
    ffffff whitesmoke f5f5f5 yellow ffff00 yellowgreen 9acd32""".split()
NAMES = {name: "#" + digits for name, digits in zip(_NAMES[::2], _NAMES[1::2])}

# The colours of matplotlib's maps at equal distances; they are interpolated.
COLORMAPS = {name: stops.split() for name, stops in {
    "viridis": """
        440154 48186a 472d7b 424086 3b528b 33638d 2c728e 26828e 21918c 1fa088 28ae80 3fbc73 5ec962 84d44b addc30
        d8e219 fde725""",
    "plasma": """
        0d0887 310597 4c02a1 6600a7 7e03a8 9511a1 aa2395 bc3587 cc4778 da5a6a e66c5c f0804e f89540 fdac33 fdc527
        f8df25 f0f921""",
    "inferno": """
        000004 0b0724 210c4a 3d0965 57106e 71196e 8a226a a32c61 bc3754 d24644 e45a31 f1731d f98e09 fcac11 f9cb35
        f2ea69 fcffa4""",
    "magma": """
        000004 0a0822 1d1147 36106b 51127c 6a1c81 832681 9c2e7f b73779 d0416f e75263 f56b5c fc8961 fea772 fec488
        fde2a3 fcfdbf""",
    "cividis": """
        00224e 002e6a 1a386f 32436d 434e6c 535a6d 61656f 6f7073 7d7c78 8c8878 9b9476 aba072 bcae6c cdbb63 dec958
        f0d846 fee838""",
    "turbo": """
        30123b 4040a2 466be3 4294ff 28bceb 18ddc2 32f298 6dfe62 a4fc3c cdec34 eecf3a fdac34 fb7e21 eb500e d02f05
        a91601 7a0403""",
    "coolwarm": """
        3b4cc0 4e68d8 6282ea 779af7 8db0fe a3c2fe b9d0f9 ccd9ed dddcdc ecd3c5 f5c4ac f7b093 f4987a eb7d62 dd5f4b
        ca3b37 b40426""",
    "Blues": """
        f7fbff eaf3fb deebf7 d2e3f3 c6dbef b2d2e8 9dcae1 84bcdb 6aaed6 56a0ce 4191c6 3181bd 2070b4 1460a8 08509b
        084082 08306b""",
    "Reds": """
        fff5f0 feeae1 fee0d2 fdcdb9 fcbba1 fca689 fc9272 fb7d5d fb694a f5523a ee3a2c dc2924 ca181d b71319 a30f15
        840711 67000d""",
    "Greens": """
        f7fcf5 eef8ea e5f5e0 d6efd0 c7e9c0 b4e1ad a0d99b 8ace88 73c476 5ab769 40aa5d 319a50 228a44 117b38 006c2c
        005723 00441b""",
    "hot": """
        0b0000 350000 5f0000 890000 b30000 dd0000 ff0800 ff3200 ff5c00 ff8600 ffb000 ffda00 ffff07 ffff46 ffff85
        ffffc4 ffffff""",
}.items()}
# For categories: matplotlib's tab10.
CATEGORIES = "1f77b4 ff7f0e 2ca02c d62728 9467bd" \
             " 8c564b e377c2 7f7f7f bcbd22 17becf".split()
SHADES = 256  # of a colour map that is sampled


def parse_color(color):
    """Parses "#rgb", "#rgba", "#rrggbb", "#rrggbbaa", a name of CSS, or three or four numbers from 0 to 1; returns four
    floats from 0 to 1."""
    if isinstance(color, str):
        color = NAMES.get(color.lower().replace("grey", "gray"), color)
        digits = color[1:]
        if len(digits) in (3, 4):
            digits = "".join(digit * 2 for digit in digits)
        try:
            if color[:1] == "#" and len(digits) in (6, 8) and digits.isalnum():
                return tuple(byte / 255 for byte in bytes.fromhex(digits)) + (1.0,) * (len(digits) == 6)
        except ValueError:
            pass
    else:
        try:
            values = tuple(float(value) for value in color)
        except (TypeError, ValueError):
            values = ()
        if len(values) in (3, 4) and all(0 <= value <= 1 for value in values):
            return values + (1.0,) * (len(values) == 3)
    raise ArgumentError("%r is not a colour; give a name like \"navy\", \"#rgb\", \"#rrggbb\", either of them with alpha, or "
                        "three or four numbers from 0 to 1" % (color,))


def as_colors(color):
    """Returns n x 4 floats, and whether several colours were given: an array, or a list of values for parse_color."""
    if isinstance(color, str) or (numpy.ndim(color) == 1 and len(color) and not isinstance(color[0], str)):
        return numpy.array([parse_color(color)], numpy.float32), False
    array = numpy.asarray(color)
    if array.ndim == 0:
        raise ArgumentError("color is %r; give a name like \"navy\", \"#rrggbb\", or one for each line" % (color,))
    if array.size == 0:
        return numpy.zeros((0, 4), numpy.float32), True
    if array.dtype == numpy.uint8:
        array = array / numpy.float32(255)
    if array.dtype.kind != "f":
        return numpy.array([parse_color(each) for each in color], numpy.float32).reshape(-1, 4), True
    if array.ndim != 2 or array.shape[1] not in (3, 4) or not ((array >= 0) & (array <= 1)).all():
        raise ArgumentError("colours have the shape %s; give n x 3 or n x 4, numbers from 0 to 1 or bytes"
                            % (array.shape,))
    colors = numpy.ones((len(array), 4), numpy.float32)
    colors[:, :array.shape[1]] = array
    return colors, True


# ---- Colour maps ----


def _from_matplotlib(name, count):
    """Returns a colour map of matplotlib's, if matplotlib is installed and has it."""
    try:
        return importlib.import_module("matplotlib").colormaps[name](numpy.linspace(0, 1, count)).astype(numpy.float32)
    except (ImportError, AttributeError, KeyError):
        return None


def sample(cmap, count=SHADES):
    """Returns n x 4 colours, evenly along a colour map: one of COLORMAPS or of matplotlib's, by name (with "_r" it is
    reversed), an object of matplotlib's, or a list of colours."""
    if callable(cmap):
        return numpy.asarray(cmap(numpy.linspace(0, 1, count)), numpy.float32)[:, :4]
    if isinstance(cmap, str):
        name, is_reversed = (cmap[:-2], True) if cmap.endswith("_r") else (cmap, False)
        if name not in COLORMAPS:
            found = _from_matplotlib(cmap, count)
            if found is not None:
                return found
            near = difflib.get_close_matches(name, COLORMAPS, 1, 0.5)
            raise ArgumentError("%r is not a colour map%s; give one of %s, another of matplotlib's if it is installed, or a "
                                "list of colours" % (cmap, "; is it %s" % near[0] if near else "", ", ".join(COLORMAPS)))
        stops = as_colors(["#" + stop for stop in COLORMAPS[name][::-1 if is_reversed else 1]])[0]
    else:
        stops = as_colors(cmap)[0]
    if not len(stops):
        raise ArgumentError("the colour map is an empty list; give at least one colour")
    places = numpy.linspace(0, len(stops) - 1, count)
    return numpy.stack([numpy.interp(places, numpy.arange(len(stops)), stops[:, c]) for c in range(4)],
                       axis=1).astype(numpy.float32)
