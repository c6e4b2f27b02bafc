#!/usr/bin/env python3
"""Checks the rules of the tree that no compiler checks: names, guards, includes, layers, words, comments and documents.

    lint_tree.py [--hints] ROOT [BUILD]

ROOT is the source tree. BUILD is a build folder of it: with one, the object files are checked against the layers too.
Each finding is one line, `file:line: what: cure`. The exit status is 1 if there are findings, else 0.

Hints are about English that reads like a translation, in documents and comments. A pattern cannot judge a sentence, so
they never change the exit status. With --hints each is one line, `hint: file:line: what: cure`; without it a single
line counts them.

Each rule is a function that takes a Tree and yields findings; RULES lists them. They need only Python's standard
library, and for BUILD the program `nm`. To add a rule, write the function, list it, and break it in
tests/tool/test_lint.py.
"""

import collections
import json
import os
import re
import subprocess
import sys

LINE_LENGTH = 120
HEAD_LINES = 100  # a longer file starts with a comment
# Layers that must not reach another one, whatever CMake says: a reader knows a schema, an archive not even that.
BARRED = {layer: ("style",) for layer in ("archive", "features", "formats", "gdal", "osm")}

MOST_WORDS = {"README.md": 1300, "ARCHITECTURE.md": 1900}  # other documents are as long as they need

CODE = ("src", "kernels", "shaders", "tests", "bench", "python")
TYPED = ("src/", "kernels/", "tests/fixtures/", "bench/")  # where the name of a type is unique
SKIPPED = {"corpus", "regressions", "data", "golden", "results", "__pycache__"}  # folders of data
C_LIKE = (".c", ".h", ".cl")
SHADERS = (".glsl", ".vert", ".frag")
HASHED = (".cmake", ".py", ".sh", "CMakeLists.txt", "dev")  # comments begin with #

COMMENT_OR_TEXT = re.compile(r"""//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'""", re.S)
DIRECTIVE = re.compile(r"^[ \t]*#(?:\\\n|[^\n])*", re.M)
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]+"([^"]+)"', re.M)
IDENTIFIER = re.compile(r"[A-Za-z_]\w*")

Finding = collections.namedtuple("Finding", "file line what cure")


def blank(text):
    """Blanks in place of text: positions and lines stay what they were."""
    return re.sub(r"[^\n]", " ", text)


class File:
    """A file of the tree. Its code is the text without comments and without the contents of string literals."""

    def __init__(self, root, path):
        self.path = path
        with open(os.path.join(root, path), encoding="utf-8", errors="replace") as file:
            self.text = file.read()
        self.comments = []  # (position, text)
        self.code = COMMENT_OR_TEXT.sub(self._take, self.text) if path.endswith(C_LIKE + SHADERS) else self.text

    def _take(self, match):
        if match.group()[0] != "/":
            return match.group()[0] + blank(match.group()[1:-1]) + match.group()[0]
        self.comments.append((match.start(), match.group()))
        return blank(match.group())

    def line_at(self, position):
        return self.text.count("\n", 0, position) + 1

    def includes(self):
        """(line, name in quotes)"""
        for match in INCLUDE.finditer(self.text):
            yield self.line_at(match.start(1)), match.group(1)

    @property
    def layer(self):
        """The folder of src that the file is in, or None."""
        parts = self.path.split("/")
        return parts[1] if parts[0] == "src" and len(parts) > 2 else None


class Tree:
    def __init__(self, root, build=None):
        self.root, self.build = root, build
        self.files = [File(root, path) for path in sorted(self._list())]
        self.layers = read_layers(root)

    def _list(self):
        for top in CODE:
            for folder, folders, names in os.walk(os.path.join(self.root, top)):
                folders[:] = [name for name in folders if name not in SKIPPED]
                for name in names:
                    if name.endswith(C_LIKE + SHADERS + HASHED):
                        yield os.path.relpath(os.path.join(folder, name), self.root)
        for name in ("CMakeLists.txt", "dev"):
            if self.has(name):
                yield name

    def has(self, path):
        return os.path.isfile(os.path.join(self.root, path))

    def ending(self, *endings):
        return [file for file in self.files if file.path.endswith(endings)]


# ---- Types ----


def strip_bodies(text):
    """text without what stands in braces."""
    kept, depth = [], 0
    for letter in text:
        depth -= letter == "}"
        if depth == 0 and letter not in "{}":
            kept.append(letter)
        depth += letter == "{"
    return "".join(kept)


def split_declarators(text):
    """Splits at the commas that stand in no parentheses."""
    parts, depth, start = [], 0, 0
    for at, letter in enumerate(text):
        depth += (letter == "(") - (letter == ")")
        if letter == "," and depth == 0:
            parts.append(text[start:at])
            start = at + 1
    return parts + [text[start:]]


def declared_name(declarator):
    pointer = re.search(r"\(\s*(?:\w+\s*)?\*+\s*(?:const\s+)?(\w+)\s*(?:\[\w*\]\s*)*\)\s*[(\[]", declarator)
    if pointer:
        return pointer.group(1)
    words = IDENTIFIER.findall(re.split(r"[(\[]", declarator.strip())[0])
    return words[-1] if words else None


def typedefs(code):
    """(position, name, what it is made of): one for each name that a typedef declares."""
    for match in re.finditer(r"\btypedef\b", code):
        at, depth = match.end(), 0
        while at < len(code) and (code[at] != ";" or depth):
            depth += (code[at] == "{") - (code[at] == "}")
            at += 1
        text = re.sub(r"__attribute__\s*\(\(.*?\)\)", " ", code[match.end():at], flags=re.S)
        for declarator in split_declarators(strip_bodies(text)):
            name = declared_name(declarator)
            if name:
                yield match.start(), name, text


def type_definitions(file):
    """Name -> line of each type that a file defines. A tag and a typedef of one name are one type."""
    code = DIRECTIVE.sub(lambda match: blank(match.group()), file.code)
    found = {}
    for match in re.finditer(r"\b(?:struct|union|enum)\s+(?:__attribute__\s*\(\(.*?\)\)\s*)?(\w+)\s*\{", code):
        found.setdefault(match.group(1), file.line_at(match.start()))
    for position, name, text in typedefs(code):
        is_forward = re.fullmatch(r"\s*(?:struct|union|enum)\s+%s\s+%s\s*" % (name, name), text)
        if not is_forward:
            found.setdefault(name, file.line_at(position))
    return found


def check_types(tree):
    definitions = collections.defaultdict(list)
    for file in tree.ending(*C_LIKE):
        if file.path.startswith(TYPED):
            for name, line in type_definitions(file).items():
                definitions[name].append((file.path, line))
    for name, places in sorted(definitions.items()):
        # Headers first: of two definitions the one in a header stays.
        places.sort(key=lambda place: (not place[0].endswith(".h"), place))
        first = places[0]
        if not first[0].endswith(".h") and not name.startswith("camber_"):
            continue
        for path, line in places[1:]:
            yield Finding(path, line, "type %s is defined in %s:%d already" % (name, *first),
                          "give one of them another name, or let both use one definition")


# ---- Guards ----


def guard_of(path):
    """The include guard that belongs to a header: its path, without src, behind CAMBER_."""
    name = re.sub(r"\W", "_", path[4:] if path.startswith("src/") else path).upper()
    return name if name.startswith("CAMBER_") else "CAMBER_" + name


def check_guards(tree):
    seen = {}
    for file in tree.ending(".h"):
        wanted = guard_of(file.path)
        match = re.match(r"\s*#ifndef\s+(\w+)\s+#define\s+(\w+)", file.code)
        if not match or match.group(1) != match.group(2) or not file.code.rstrip().endswith("#endif"):
            yield Finding(file.path, 1, "no include guard", "wrap the header in #ifndef %s" % wanted)
            continue
        guard, line = match.group(1), file.line_at(match.start(1))
        if guard in seen:
            yield Finding(file.path, line, "guard %s is that of %s" % (guard, seen[guard]), "use %s" % wanted)
        elif guard != wanted:
            yield Finding(file.path, line, "guard %s does not follow the path" % guard, "use %s" % wanted)
        seen.setdefault(guard, file.path)


# ---- Layers ----


class Layers:
    """The folders of src and which may use which: those that they link, and what these link in turn.

    above: layers over the libraries, which call public functions too, and which libraries those are."""

    def __init__(self, links, lines, above=None):
        self.links, self.lines, self.above = links, lines, above or {}
        self.below = {name: self._reach(name) for name in links}

    def _reach(self, name):
        found, open_names = set(), [name]
        while open_names:
            for link in self.links.get(open_names.pop(), ()):
                if link not in found:
                    found.add(link)
                    open_names.append(link)
        return found

    def allows(self, user, used):
        return user == used or used in self.below.get(user, ())


def read_layers(root):
    """The calls camber_layer(FOLDER ... LINKS FOLDER...) of src/CMakeLists.txt."""
    links, lines, above = {}, {}, {}
    path = os.path.join(root, "src/CMakeLists.txt")
    if not os.path.isfile(path):
        return Layers(links, lines)
    with open(path, encoding="utf-8") as file:
        text = re.sub(r"#[^\n]*", "", file.read())
    for match in re.finditer(r"\bcamber_layer\s*\(([^)]*)\)", text):
        words = match.group(1).split()
        if not words or not os.path.isdir(os.path.join(root, "src", words[0])):
            continue
        named = words[words.index("LINKS") + 1:] if "LINKS" in words else []
        end = next((i for i, word in enumerate(named) if re.fullmatch(r"[A-Z_]+", word)), len(named))
        links[words[0]] = [word for word in named[:end] if os.path.isdir(os.path.join(root, "src", word))]
        lines[words[0]] = text.count("\n", 0, match.start()) + 1
        used = set(words[words.index("USES"):]) if "USES" in words else set()
        if "${map_library}" in used:
            above[words[0]] = {"camber", "camber-map"}
        elif "camber" in used:
            above[words[0]] = {"camber"}
    return Layers(links, lines, above)


def check_layers(tree):
    """Every folder of src is a layer; no layer links one that leads back to it, or to one that it must not know."""
    folders = {file.layer for file in tree.ending(*C_LIKE) if file.layer}
    if folders and not tree.layers.links:
        yield Finding("src/CMakeLists.txt", 1, "no layers", "add camber_layer(FOLDER LINKS FOLDER...) for each folder")
        return
    for folder in sorted(folders - set(tree.layers.links)):
        yield Finding("src/CMakeLists.txt", 1, "src/%s is no layer" % folder, "add camber_layer(%s LINKS ...)" % folder)
    for name in sorted(tree.layers.links):
        if name in tree.layers.below[name]:
            yield Finding("src/CMakeLists.txt", tree.layers.lines[name], "layer %s links itself in a circle" % name,
                          "take out the arrow that points up")
        for barred in BARRED.get(name, ()):
            if barred in tree.layers.below[name]:
                yield Finding("src/CMakeLists.txt", tree.layers.lines[name], "layer %s reaches %s" % (name, barred),
                              "hand down what it needs, as a style its schema")


def check_includes(tree):
    for file in tree.ending(*(C_LIKE + SHADERS)):
        for line, name in file.includes():
            if name.startswith("../"):
                yield Finding(file.path, line, 'include of "%s"' % name, "name the header from src or from the root")
                continue
            used = name[4:] if name.startswith("src/") else name
            used = used.split("/")[0] if "/" in used else None
            if not used or not os.path.isdir(os.path.join(tree.root, "src", used)):
                continue
            if file.path.startswith("kernels/") or (file.path.startswith("src/") and not file.layer):
                yield Finding(file.path, line, "%s includes layer %s" % (file.path.split("/")[0], used),
                              "move what it needs down")
            elif file.layer in tree.layers.links and not tree.layers.allows(file.layer, used):
                yield Finding(file.path, line, "layer %s includes %s, which it does not link" % (file.layer, used),
                              "move what both need into a lower layer, or correct LINKS in src/CMakeLists.txt")


def check_compute(tree):
    """OpenCL's names stay in gpu/, so that another back end is a folder of it. Drivers' headers are not included."""
    for file in tree.ending(".c", ".h"):
        match = re.search(r"^#include <((?:CL|EGL|GL|GLES\d)/.*)>", file.text, re.M)
        if match and file.path.startswith("src/"):
            yield Finding(file.path, file.line_at(match.start()), "%s: a build needs nothing of drivers" % match.group(1),
                          "declare what it has in gpu/opencl/cl.h, gl/gl.h or gl/egl.h")
        if not file.path.startswith("src/") or file.layer == "gpu":
            continue
        match = re.search(r"\b(?:cl_(?!khr_)[a-z]\w*|cl[A-Z]\w*|CL_[A-Z]\w*)\b", file.code)
        if match:
            yield Finding(file.path, file.line_at(match.start()), "%s outside of src/gpu" % match.group(),
                          "use gpu/buffer.h or gpu/launch.h; if they lack it, add it to each back end")


# ---- Object files ----


def compiled_objects(tree):
    """(object file, source in src) of what the build folder has compiled: others in it are left from before."""
    path = os.path.join(tree.build, "compile_commands.json")
    if not os.path.isfile(path):
        return
    with open(path, encoding="utf-8") as file:
        commands = json.load(file)
    for command in commands:
        source = os.path.relpath(os.path.join(command["directory"], command["file"]), os.path.abspath(tree.root))
        output = re.search(r" -o (\S+)", command.get("command", ""))
        compiled = os.path.join(command["directory"], command.get("output") or (output.group(1) if output else ""))
        if source.startswith("src/") and source.count("/") > 1 and os.path.isfile(compiled) and \
                os.path.getmtime(compiled) >= os.path.getmtime(os.path.join(tree.root, source)):
            yield compiled, source


def list_symbols(tree):
    """(source, symbol, nm's kind) of all object files of src in BUILD."""
    sources = {}
    for compiled, source in compiled_objects(tree):
        sources.setdefault(source, compiled)  # one of those that are compiled twice
    if not sources:
        return
    by_object = {path: source for source, path in sources.items()}
    listed = subprocess.run(["nm", "-A", "-P", "-g", *by_object], capture_output=True, text=True, check=True).stdout
    for line in listed.splitlines():
        path, rest = line.split(": ", 1)
        symbol, kind = rest.split()[:2]
        yield by_object[path], symbol, kind


def public_functions(tree):
    """The functions that the headers of src itself declare."""
    names = set()
    for file in tree.ending(".h"):
        if file.path.startswith("src/") and not file.layer:
            names.update(re.findall(r"\bCAMBER_API\b[^;{(]*?(\w+)\s*\(", file.code))
    return names


def link_arrows(tree):
    """(using layer, used layer) -> an example: source, symbol, the source that defines it."""
    defined, used, public = collections.defaultdict(list), [], public_functions(tree)
    for source, symbol, kind in list_symbols(tree):
        if kind in "UvwVW":
            used.append((source, symbol))
        else:
            defined[symbol].append(source)
    arrows = {}
    for source, symbol in sorted(used):
        # Two layers may define it, for two libraries: the one that this layer links counts.
        targets = sorted(defined[symbol], key=lambda one: not tree.layers.allows(source.split("/")[1], one.split("/")[1]))
        target = targets[0] if targets else None
        if symbol in public and source.split("/")[1] in tree.layers.above:
            continue
        if target and source.split("/")[1] != target.split("/")[1]:
            arrows.setdefault((source.split("/")[1], target.split("/")[1]), (source, symbol, target))
    return arrows


def check_links(tree):
    if not tree.build:
        return
    arrows = link_arrows(tree)
    real = Layers({user: [used for other, used in arrows if other == user] for user, _ in arrows}, {})
    for (user, used), (source, symbol, target) in sorted(arrows.items()):
        if tree.layers.links:
            if user not in tree.layers.links or tree.layers.allows(user, used):
                continue
            yield Finding(source, 1, "layer %s calls %s of %s, which it does not link" % (user, symbol, target),
                          "hand it down as a value or a callback, or move it below")
        elif real.allows(used, user):
            yield Finding(source, 1, "layers %s and %s use each other: here %s of %s" % (user, used, symbol, target),
                          "let one of the two know nothing of the other")


# Files that call each other in a circle, by folder, because what they read holds more of itself: an operator compiles its
# operands, which are expressions.
CIRCLES = {
    "style": ("compiler.c", "operators.c", "operators_decisions.c", "operators_formats.c", "operators_inputs.c",
              "operators_sequences.c", "operators_types.c"),
}


def calls_within(tree):
    """layer -> source -> the sources of the same layer whose functions it calls. Tables of functions are no arrows."""
    symbols = list(list_symbols(tree))
    defined = {symbol: source for source, symbol, kind in symbols if kind in "Tt"}
    calls = {}
    for source, symbol, kind in symbols:
        layer, target = source.split("/")[1], defined.get(symbol)
        calls.setdefault(layer, {}).setdefault(source, set())
        if kind == "U" and target and target != source and target.split("/")[1] == layer:
            calls[layer][source].add(target)
    return calls


def reachable(graph, start):
    seen, todo = set(), list(graph.get(start, ()))
    while todo:
        node = todo.pop()
        if node not in seen:
            seen.add(node)
            todo.extend(graph.get(node, ()))
    return seen


def check_circles(tree):
    """No files of a folder call each other in a circle: a reader can go through them from below."""
    if not tree.build:
        return
    for layer, graph in sorted(calls_within(tree).items()):
        for source in sorted(graph):
            others = {other for other in reachable(graph, source) if source in reachable(graph, other)} - {source}
            known = CIRCLES.get(layer, ())
            if others and not {one.split("/", 2)[2] for one in others | {source}} <= set(known):
                yield Finding(source, 1, "it and %s call each other in a circle" %
                              ", ".join(sorted(other.split("/", 2)[2] for other in others)),
                              "move what both need into a file of its own, below")


# ---- Kernels ----


def check_kernels(tree):
    """A kernel includes what it uses, so that an editor and a compiler can check it by itself."""
    for file in tree.ending(*C_LIKE):
        if not file.path.startswith("kernels/"):
            continue
        names = []
        for line, name in file.includes():
            names.append(name)
            if not name.startswith("../") and not any(
                    tree.has(os.path.join(folder, name)) for folder in ("kernels", "", "src")):
                yield Finding(file.path, line, 'there is no "%s"' % name, "correct its name")
        if not file.path.endswith(".cl") or names:
            continue
        defined = set(re.findall(r"#[ \t]*define[ \t]+(\w+)", file.code))
        defined |= set(re.findall(r"(\w+)\s*\([^;{}]*\)\s*\{", file.code)) | set(type_definitions(file))
        for match in re.finditer(r"\b(?:CAMBER|camber)_\w+", file.code):
            if match.group() not in defined:
                yield Finding(file.path, file.line_at(match.start()), "%s comes from nowhere" % match.group(),
                              "include the header that has it")
                break


# ---- Words ----


def gone_words(root):
    """Old word -> new word: the list of docs/glossary.md under "## Words that are gone"."""
    path = os.path.join(root, "docs/glossary.md")
    if not os.path.isfile(path):
        return {}
    with open(path, encoding="utf-8") as file:
        section = re.search(r"^## Words that are gone$(.*?)(?=^## |\Z)", file.read(), re.M | re.S)
    words = {}
    for olds, new in re.findall(r"^- ([^:\n]+): *(.+)$", section.group(1) if section else "", re.M):
        for old in re.sub(r"\([^)]*\)|`", "", olds).split(","):
            if old.strip():
                words[old.strip()] = new.strip()
    return words


def check_words(tree):
    gone = gone_words(tree.root)
    if not gone:
        return
    pattern = re.compile(r"(?<![\w-])(?:%s)(?![\w-])" % "|".join(map(re.escape, sorted(gone, key=len, reverse=True))))
    for file in tree.files:
        stem = os.path.basename(file.path).split(".")[0]
        if stem in gone:
            yield Finding(file.path, 1, "the file is called %s" % stem, "rename it: %s" % gone[stem])
        if not file.path.endswith(C_LIKE + SHADERS):
            continue
        for start, text in [(0, file.code)] + file.comments:
            for match in pattern.finditer(text):
                yield Finding(file.path, file.line_at(start) + text.count("\n", 0, match.start()),
                              "%s is a word that is gone" % match.group(), "say %s" % gone[match.group()])


# ---- Comments ----


def comment_starts(file):
    """(line, text) of each comment, without its marks and rules."""
    if file.path.endswith(C_LIKE + SHADERS):
        for start, text in file.comments:
            yield file.line_at(start), text.lstrip("/*!- \t\n")
        return
    is_open = False  # the line above is a comment as well: this one goes on with it
    for number, line in enumerate(file.text.split("\n"), 1):
        match = re.match(r"(.*?)(?:^|\s)#+ +(.*)", line)
        if match and not (is_open and not match.group(1).strip()):
            yield number, match.group(2).lstrip("- ")
        is_open = bool(match) and not match.group(1).strip()


def check_comments(tree):
    for file in tree.files:
        for line, text in comment_starts(file):
            word = re.match(r"(Of|What) ", text)
            if word:
                yield Finding(file.path, line, 'a comment begins with "%s"' % word.group(1),
                              "say in a sentence who does what")
        if file.path.endswith(C_LIKE) and file.text.count("\n") > HEAD_LINES and file.text[:2] not in ("/*", "//"):
            yield Finding(file.path, 1, "over %d lines without a head" % HEAD_LINES,
                          "begin with a comment: purpose, input, output, the main idea")


# ---- Documents ----


def list_documents(root):
    """(path, most words or None)"""
    for name in sorted(os.listdir(root)):
        if name.endswith(".md"):
            yield name, MOST_WORDS.get(name)
    docs = os.path.join(root, "docs")
    for folder, _, names in sorted(os.walk(docs)):
        for name in sorted(names):
            if name.endswith(".md"):
                yield os.path.relpath(os.path.join(folder, name), root), None
    for page in ("src/cli/camber.1", "src/camber.3"):
        if os.path.isfile(os.path.join(root, page)):
            yield page, None


def is_breakable(line):
    """Rows of tables are not, nor a line that is one word, such as a link."""
    return not line.startswith("|") and " " in line.strip().lstrip("-*> ")


def check_documents(tree):
    for path, most_words in list_documents(tree.root):
        with open(os.path.join(tree.root, path), encoding="utf-8") as file:
            text = file.read()
        words = len(text.split())
        if most_words and words > most_words:
            yield Finding(path, 1, "%d words, and %d are allowed" % (words, most_words),
                          "leave out what another document has, or move it to docs/")
        for number, line in enumerate(text.split("\n"), 1):
            if len(line) > LINE_LENGTH and is_breakable(line):
                yield Finding(path, number, "%d characters, and %d are allowed" % (len(line), LINE_LENGTH),
                              "break the line")


# ---- English ----

# (what a hint quotes, what to say instead). Spaces match line ends too. Capital letters begin a sentence.
PATTERNS = [(re.compile(pattern.replace(" ", r"\s+")), cure) for pattern, cure in (
    (r"\bWhere [^.;:?!]*?,", 'if it is a condition, say "if"'),
    (r"\bWhat (?!is |are |it is )[^.;:,?!|]*? (?:is|are|was|has|have|does|goes|lies|stays|takes)\b(?![^.|]*\?)",
     "name the subject: who does it, or which things"),
    (r"\b[Bb]ehind (?:the|it|its|them|that|this|those|each|every|all|others?)\b", 'if it is an order, say "after"'),
    (r"\b(?:is|are|was|were) told\b", "say who reports, names or prints it"),
    (r"\b[Ss]o (?:many|much)\b(?! (?:\w+ )?(?:that|as|for)\b)", "give the number, or the thing that it depends on"),
    (r"(?<!let\s)\balone\b", 'say "only"'),
    (r"\b[Aa]new\b", 'say "again"'),
    (r"\b[Aa]s [^.;:,?!]{1,30}? (?:has|have|had) (?:it|them)\b", 'say "like" or "as in"'),
    (r"\b(?:lies|lie|lay)\b", 'say "is", unless somebody rests'),
    (r"\b[Bb]eside\b", 'say "next to", "with" or "compared with"'))]


def split_paragraphs(text):
    """(line, text): what stands between empty lines and headings."""
    for match in re.finditer(r"(?:^(?!#|[ \t]*$)[^\n]*\n?)+", text, re.M):
        yield text.count("\n", 0, match.start()) + 1, match.group()


def list_prose(tree):
    """(path, line, text): the paragraphs of documents and the comments, without code."""
    for path, _ in list_documents(tree.root):
        with open(os.path.join(tree.root, path), encoding="utf-8") as file:
            text = file.read()
        text = re.sub(r"^```.*?^```|^ {4}[^\n]*|`[^`]*`", lambda code: blank(code.group()), text, flags=re.M | re.S)
        for line, paragraph in split_paragraphs(text):
            yield path, line, paragraph
    for file in tree.files:
        if file.path.endswith(HASHED):
            for number, line in enumerate(file.text.split("\n"), 1):
                comment = re.search(r"(?:^|\s)#+ (.*)", line)
                if comment:
                    yield file.path, number, comment.group(1)
        for start, comment in file.comments:
            yield file.path, file.line_at(start), re.sub(r"^[ \t]*(?:/\*|\*|//)|`[^`\n]*`", "", comment, flags=re.M)


def list_hints(tree):
    for path, line, text in list_prose(tree):
        for pattern, cure in PATTERNS:
            for match in pattern.finditer(text):
                quoted = " ".join(match.group().split())
                quoted = quoted if len(quoted) <= 40 else quoted[:18] + " ... " + quoted[-18:]
                yield Finding(path, line + text.count("\n", 0, match.start()), '"%s"' % quoted, cure)


# ---- Packages ----

# Each thing that CMake looks for -> the package that has it: Debian's, RPM's, Homebrew's. None: it needs none of its own.
LIBRARIES = {
    "PNG": ("libpng-dev", "pkgconfig(libpng)", "libpng"), "ZLIB": ("zlib1g-dev", "pkgconfig(zlib)", "zlib"),
    "Threads": None, "PkgConfig": None,
    "jansson": ("libjansson-dev", "pkgconfig(jansson)", "jansson"), "GDAL": ("libgdal-dev", "pkgconfig(gdal)", "gdal"),
    "SQLite3": ("libsqlite3-dev", "pkgconfig(sqlite3)", "sqlite"), "cmocka": None,
    "libprotobuf-c": ("libprotobuf-c-dev", "pkgconfig(libprotobuf-c)", "protobuf-c"),
    "protoc-c": ("protobuf-c-compiler", "protobuf-c-compiler", "protobuf-c"),
    "harfbuzz": ("libharfbuzz-dev", "pkgconfig(harfbuzz)", "harfbuzz"),
    "fribidi": ("libfribidi-dev", "pkgconfig(fribidi)", "fribidi"),
    "fontconfig": ("libfontconfig-dev", "pkgconfig(fontconfig)", "fontconfig"),
    "libdeflate": ("libdeflate-dev", "pkgconfig(libdeflate)", "libdeflate"),
    "libisal": ("libisal-dev", "pkgconfig(libisal)", "isa-l"),
    "liblz4": ("liblz4-dev", "pkgconfig(liblz4)", "lz4"), "libzstd": ("libzstd-dev", "pkgconfig(libzstd)", "zstd"),
    "liblzma": ("liblzma-dev", "pkgconfig(liblzma)", "xz"),
    "libwebp": ("libwebp-dev", "pkgconfig(libwebp)", "webp"),
    "libmicrohttpd": ("libmicrohttpd-dev", "pkgconfig(libmicrohttpd)", "libmicrohttpd"),
    "cairo": ("libcairo2-dev", "pkgconfig(cairo)", "cairo"), "cairo-ft": None, "cairo-pdf": None, "cairo-svg": None,
    "freetype2": None,
    "meshoptimizer": ("libmeshoptimizer-dev", "cmake(meshoptimizer)", "meshoptimizer"),
    "Leaflet": ("libjs-leaflet", "leaflet-1.9.4.tgz", "leaflet-1.9.4.tgz"),  # src/serve/page.cmake
}
# Where a release's version stands besides CMakeLists.txt, and the file's place in LIBRARIES.
PACKAGINGS = (
    ("packaging/debian/control", None, 0), ("packaging/camber.spec", r"^Version: *(\S+)", 1),
    ("packaging/camber.rb", r"camber-([\d.]+)\.tar", 2), ("examples/serve/Dockerfile", None, 0),
    ("packaging/recipe.yaml", r'^  version: "([\d.]+)"', None),
    ("packaging/debian/changelog", r"\Acamber \(([\d.]+)-", None),
    ("pyproject.toml", r'^version = "(.*)"', None), ("src/camber.3", r'^\.TH .* "camber (\S+)"', None),
    ("packaging/camber.spec", r"^\* .* - (\S+)-1$", None), ("src/cli/camber.1", r'^\.TH .* "camber (\S+)"', None))
# Each package is made with the same options, and with all that can be left out.
CONFIGURED = ("packaging/debian/rules", "packaging/camber.spec", "packaging/camber.rb", "packaging/recipe.yaml")


def check_options(tree, cmake):
    """Packages are built with options that there are, and with the same ones."""
    known = set(re.findall(r"^(?:option|set)\((CAMBER_\w+)", cmake, re.M))
    first = None
    for path in CONFIGURED + ("examples/serve/Dockerfile",):
        with open(os.path.join(tree.root, path), encoding="utf-8") as file:
            options = set(re.findall(r"-D(CAMBER_\w+=\w+)", file.read()))
        for option in sorted(options):
            if option.split("=")[0] not in known:
                yield Finding(path, 1, "CMakeLists.txt has no option " + option.split("=")[0], "take it away, or rename it")
        first = first or options
        if path in CONFIGURED and options != first:
            yield Finding(path, 1, "%s: not as in %s" % (" ".join(sorted(options ^ first)), CONFIGURED[0]),
                          "build all packages alike")


def check_packages(tree):
    """Packages have the version, the libraries and the options that CMakeLists.txt has."""
    if not tree.has("packaging/debian/control"):
        return
    cmake = next(file.text for file in tree.files if file.path == "CMakeLists.txt")
    version = re.search(r"^project\(camber VERSION (\S+)", cmake, re.M).group(1)
    used = set(re.findall(r"\bfind_package\((\w+)", cmake))
    used |= set(re.findall(r"\bpkg_check_modules\(\w+ .*IMPORTED_TARGET ([a-z][\w-]*)", cmake))
    used |= set(re.findall(r"^ *camber_optional_library\(\w+ CAMBER_\w+ (\S+)", cmake, re.M))
    used |= set(re.findall(r"\bfind_program\(\w+ ([\w-]+) REQUIRED", cmake))
    used |= {"Leaflet"} if tree.has("src/serve/page.cmake") else set()
    yield from check_options(tree, cmake)
    for name in sorted(used - set(LIBRARIES)):
        yield Finding("CMakeLists.txt", 1, "%s is new to the packages" % name,
                      "say in LIBRARIES of tests/lint/lint_tree.py which packages have it, and add them")
    for path, pattern, place in PACKAGINGS:
        with open(os.path.join(tree.root, path), encoding="utf-8") as file:
            text = file.read()
        found = re.search(pattern, text, re.M) if pattern else None
        if pattern and (not found or found.group(1) != version):
            yield Finding(path, 1, "the version is %s" % (found.group(1) if found else "not told"),
                          "make it CMake's, %s" % version)
        for name in sorted(used & set(LIBRARIES)) if place is not None else ():
            package = LIBRARIES[name] and LIBRARIES[name][place]
            if package and not re.search(r"(?<![\w-])%s(?![\w-])" % re.escape(package), text):
                yield Finding(path, 1, "it does without %s, where CMake wants %s" % (package, name), "add it")
        if path == "pyproject.toml":
            modules = json.loads(re.search(r"^dependencies = (.*)", text, re.M).group(1))
        elif path == "packaging/camber.spec":
            spec = text
    for module in modules:
        if not re.search(r"^Requires:.* python3-%s(?!\S)" % module, spec, re.M):
            yield Finding("packaging/camber.spec", 1, "it does without python3-%s, which pyproject.toml wants" % module,
                          "add it")


RULES = (check_packages, check_types, check_guards, check_layers, check_includes, check_compute, check_links,
         check_circles, check_kernels, check_words, check_comments, check_documents)


def main(arguments):
    lists_hints = arguments[:1] == ["--hints"]
    arguments = arguments[lists_hints:]
    if len(arguments) not in (1, 2):
        sys.exit(__doc__)
    tree = Tree(*arguments)
    status = 0
    for rule in RULES:
        for finding in rule(tree):
            print("%s:%d: %s: %s" % finding)
            status = 1
    hints = sorted(list_hints(tree))
    if lists_hints:
        for hint in hints:
            print("hint: %s:%d: %s: %s" % hint)
    elif hints:
        print("hint: phrases that may read like a translation: %d; tests/lint/lint_tree.py --hints %s lists them" %
              (len(hints), arguments[0]))
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
