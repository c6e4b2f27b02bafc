#!/usr/bin/env python3
"""Holds the shaders of examples/web/index.html to those of camber.

Input: shaders/stroke.vert and stroke.frag with the headers of kernels/. Output: the two blocks of the page between its
markers. The C preprocessor resolves what the page does not draw, and of the functions only those stay that are called.

usage: web_shader.py CC [--write]
Exit status: 1 where the page has other text than the sources give. --write puts it there.
"""
import difflib
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / 'examples' / 'web' / 'index.html'
# The stroke shader as the page draws with it, seen from above; what it may have is in FLAGS.
VARIANT = dict(CAMBER_GLSL=1, METHOD=0, TIPS=1, THIN=1, LINEAR=0, COUNT=0, UNION=0, TRIM=0, RAMP=0, MASK=0, PATTERN=0,
               PITCHED=0, TEXELS_A_ROW=4)
# The page's own macros, each with those of camber that it stands for.
FLAGS = {'SHARP': ['SHARP_JOINS'], 'FLAT': ['FLAT_ENDS'], 'RICH': ['GAP', 'BLUR', 'DASH']}
# The page calls these itself. It has a main of its own for vertices, since its records are others.
CALLED = {'stroke.vert': ['row_texel', 'camber_turn_between', 'camber_line_ends', 'camber_stub_pack',
                          'camber_join_word', 'camber_cap_word', 'camber_turn_tan_half', 'camber_join_kind',
                          'camber_join_end', 'camber_turn_unpack', 'hand_over'],
          'stroke.frag': ['main']}


def preprocess(compiler, shader, variant):
    defines = [f'-D{name}={value}' for name, value in variant.items()]
    command = [*compiler.split(), '-E', '-P', '-undef', '-x', 'c', *defines, '-I', str(ROOT / 'kernels'), '-I',
               str(ROOT / 'shaders'), '-']
    text = f'#include "{shader}"\n'
    return subprocess.run(command, check=True, capture_output=True, text=True, input=text).stdout.replace('->', '.')


def tidy(text):
    """Takes away what macros have left behind."""
    text = re.sub(r'\bfloat\((-?[0-9.e-]+)f?\)|\buint\(([0-9]+u)\)', lambda m: m[1] or m[2], text)
    text = re.sub(r'([0-9])f\b', r'\1', text)
    text = re.sub(r'\b([0-9]) (==|!=) ([0-9])\b', lambda m: str((m[1] == m[3]) == (m[2] == '==')).lower(), text)
    text = re.sub(r'\s+', ' ', text)
    text = re.sub(r' ([);,])|([(]) ', lambda m: m[1] or m[2], text)
    return re.sub(r'(?<![\w)] )(?<![\w)])\((-?[0-9.e-]+u?|\w+)\)', r'\1', text)


def split(text):
    """The declarations of a shader, each with the names in it; a function or struct has its body."""
    parts, depth, start = [], 0, 0
    for i, c in enumerate(text):
        depth += (c == '{') - (c == '}')
        is_end = depth == 0 and (c == ';' or (c == '}' and text[i + 1:i + 2] != ';'))
        if is_end:
            parts.append(text[start:i + 1].strip())
            start = i + 1
    return [part for part in parts if part != ';']


def name_of(part):
    head = re.match(r'struct (\w+)|\w+ (\w+)\(', part)
    return head and (head[1] or head[2])


def find_needed(parts, roots):
    """The names of what the roots call and use, and all words in these."""
    by_name = {name_of(part): part for part in parts if name_of(part)}
    names, queue = set(), list(roots)
    while queue:
        name = queue.pop()
        if name in by_name and name not in names:
            names.add(name)
            queue += re.findall(r'\w+', by_name[name])
    return names, {word for name in names for word in re.findall(r'\w+', by_name[name])}


def prune(parts, names, words):
    """Keeps what is needed, in order, and what comes in and goes out."""
    return [part for part in parts if
            name_of(part) in names or (not name_of(part) and (part.startswith('precision') or
                                                              re.findall(r'\w+', part)[-1] in words))]


def lay_out(part):
    """Breaks and indents a declaration: a statement a line, and none longer than 120 characters."""
    lines, line, indent, inside = [], '', 0, 0
    for c in part:
        inside += (c == '(') - (c == ')')
        indent -= c == '}'
        line += c
        if c in '{}' or (c == ';' and not inside):
            lines.append('    ' * indent + line.strip())
            indent += c == '{'
            line = ''
    text = '\n'.join(lines + [line]).rstrip().replace('}\n;', '};')
    return '\n'.join(map(wrap, text.split('\n')))


def wrap(line):
    indent = re.match(' *', line)[0] + '    '
    lines = []
    while len(line) > 120:
        at = max(line.rfind(', ', 0, 119) + 1, line.rfind(' ? ', 0, 119), line.rfind(' : ', 0, 119),
                 line.rfind(' + ', 0, 119))
        lines.append(line[:at])
        line = indent + line[at:].strip()
    return '\n'.join(lines + [line])


def make_variants(read_parts, needed, flags, variant):
    """The lines of all variants. What only some have is one item with its #if and #endif."""
    if not flags:
        return [line for part in prune(read_parts(variant), *needed) for line in lay_out(part).split('\n')]
    flag, *rest = flags
    without, having = (make_variants(read_parts, needed, rest, variant | dict.fromkeys(FLAGS[flag], on)) for on in (0, 1))
    items = []
    for what, i, j, k, m in difflib.SequenceMatcher(None, without, having, False).get_opcodes():
        if what == 'equal':
            items += without[i:j]
        else:
            both = ['#else'] if what == 'replace' else []
            first = f'#if {flag}' if k < m else f'#if !{flag}'
            items.append('\n'.join([first, *having[k:m], *both, *without[i:j], '#endif']))
    return items


def make_block(compiler, shader):
    def read_parts(variant):
        return split(tidy(preprocess(compiler, shader, variant)))
    everything = VARIANT | {name: 1 for names in FLAGS.values() for name in names}
    needed = find_needed(read_parts(everything), CALLED[shader])
    return '\n'.join(make_variants(read_parts, needed, list(FLAGS), VARIANT)) + '\n'


def main():
    compiler, write = sys.argv[1], '--write' in sys.argv
    page = PAGE.read_text(encoding='utf-8')
    made = page
    for shader in CALLED:
        begin, end = f'// <shaders/{shader}>\n', f'// </shaders/{shader}>\n'
        before, found, rest = made.partition(begin)
        _, closed, behind = rest.partition(end)
        if not found or not closed:
            sys.exit(f'{PAGE}: no {begin.strip()} to {end.strip()}')
        made = before + begin + make_block(compiler, shader) + end + behind
    if write:
        PAGE.write_text(made, encoding='utf-8')
    elif made != page:
        print(f"not ok - {PAGE.relative_to(ROOT)} has camber's shaders: tests/tool/web_shader.py cc --write puts them there")
        sys.exit(1)
    print("ok - the page has camber's shaders")


if __name__ == '__main__':
    main()
