#!/usr/bin/env python3
"""Chooses the tests and the lint of a change: what `./dev test --change` runs, and what waits.

    tiers.py ROOT BUILD       the change of ROOT since its base; prints assignments for a shell, and a report on stderr

BUILD is a configured build folder; its tests/manifest.txt has a line a test (tests/environment.cmake writes it).

A test covers the layers that its labels name and those below them, by the arrows of camber_layer() in
src/CMakeLists.txt. A change runs
  - the tests of ./dev test whose layers it reaches;
  - of all the others one share of seven, which the number of the commit picks, so that each runs within seven commits;
  - in what this leaves of the time, mutants of the files that changed, then the tests under the sanitizers and the deep
    ones that name a changed layer or recipe, the cheapest first. Those that find no time wait for their share: a change of
    everything takes no longer than one of a kernel.
A commit of documents alone does not count and has no share: it cannot break what others test.

The base is CAMBER_BASE; without it the newest commit that passed here (./dev notes it), or one that is a day older.
"""

import collections
import os
import re
import shlex
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "lint"))
import lint_tree  # noqa: E402

SHARES = 7
EVERYDAY = ("tree", "unit", "device", "picture", "tool")  # the labels of ./dev test
SANITIZED = ("unit", "device", "picture", "tool", "faults")
DOCUMENTS = re.compile(r"(docs/.*|[^/]*\.md|LICENSE|src/camber\.3)$")
BUILD = re.compile(r"(dev|CMakeLists\.txt|\.ci/.*|src/[^/]*(CMakeLists\.txt|\.cmake|\.in)|tests/data/.*|"
                   r"tests/(CMakeLists\.txt|environment\.cmake|fuzz/CMakeLists\.txt))$")
LINT = re.compile(r"(\.clang-tidy|\.clang-format|\.ci/pinned|tests/lint\.cmake)$")
MODULES = {"camber-map": ("gdal",)}  # loaded when they are needed: no arrow leads there
# Layers that some formats or one verb lead to. A test that has none of the layer's words does not get there by way of a
# library or of the tool.
WORDS = {"osm": "pbf", "archive": "tiles|archive|gpkg|sqlite", "tiles": "tile", "print": "pdf|svg|paper", "serve": "serve"}
DEFAULT_COST = 1.0
# A change has so many minutes of two processors, lint and the build included: one of a kernel, or whatever else reaches
# nearly all of ./dev test; one of less, such as a reader or the server; one of documents alone.
GOAL_MINUTES, GOAL_MINUTES_OF_LITTLE, GOAL_MINUTES_OF_DOCUMENTS = 25.0, 16.0, 5.0
MINUTES_BEFORE_TESTS, MINUTES_BEFORE_FEW_TESTS = 2.7, 1.8
BUSY = 1.9  # of two processors: three tests run at a time, and some wait
# Seconds of a processor, as costs are, that there are in any case for what names a changed layer.
LEAST_SECONDS = 220.0
SECONDS_A_MUTANT, TIMES_UNDER_SANITIZERS = 7.0, 4.0

Test = collections.namedtuple("Test", "name cost fixture is_setup labels")


def read_manifest(path):
    with open(path, encoding="utf-8") as file:
        rows = [line.split() for line in file]
    return [Test(name, DEFAULT_COST if cost == "-" else float(cost), None if fixture == "-" else fixture,
                 role == "setup", labels.split(",")) for name, cost, fixture, role, labels in rows]


# ---- Layers and folders ----


class Arrows:
    """Which layers a label covers, and which of them a file belongs to."""

    def __init__(self, root):
        self.root, self.layers = root, lint_tree.read_layers(root)
        with open(os.path.join(root, "src/CMakeLists.txt"), encoding="utf-8") as file:
            text = file.read()
        self.libraries = {name: set(layers.split()) for name, layers in
                          re.findall(r"camber_library\((\S+) HEADER [^)]*?LAYERS ([a-z ]+?)\s+LINK", text)}
        for name, modules in MODULES.items():
            self.libraries.setdefault(name, set()).update(modules)
        self.kernel_users = self._find_kernel_users()

    def covered(self, label):
        """A layer with all below it, or a library with all its layers; any other label covers itself."""
        found, waiting = set(), [label]
        while waiting:
            name = waiting.pop()
            if name in found:
                continue
            found.add(name)
            waiting += self.libraries.get(name, ())
            waiting += self.layers.below.get(name, ())
            waiting += self.layers.above.get(name, ())
        return found

    def _includes(self, folder):
        """The headers of kernels/ that the files of a folder include."""
        found = set()
        for top, _, names in os.walk(os.path.join(self.root, folder)):
            for name in names:
                if name.endswith((".c", ".h", ".cl", ".inl", ".vert", ".frag", ".glsl")):
                    with open(os.path.join(top, name), encoding="utf-8", errors="replace") as file:
                        found.update(re.findall(r'#\s*include\s+"(?:kernels/)?([\w.]+)"', file.read()))
        return found

    def _find_kernel_users(self):
        """The files of kernels/ that each layer compiles: those that it includes, and what these include in turn."""
        folder = os.path.join(self.root, "kernels")
        kernels = {}
        for name in os.listdir(folder) if os.path.isdir(folder) else ():
            with open(os.path.join(folder, name), encoding="utf-8", errors="replace") as file:
                kernels[name] = set(re.findall(r'#\s*include\s+"(?:kernels/)?([\w.]+)"', file.read()))
        users = {layer: self._includes("src/" + layer) for layer in self.layers.links}
        users.setdefault("gpu", set()).update(kernels)  # embeds the programs
        users.setdefault("gl", set()).update(self._includes("shaders"))  # and the shaders
        for included in users.values():
            waiting = list(included)
            while waiting:
                more = kernels.get(waiting.pop(), set()) - included
                included |= more
                waiting += more
        return users

    def areas(self, path):
        """The layers and folders that a changed file belongs to, and those that compile it; "build": it reaches all."""
        if path.startswith("kernels/"):
            name = path.partition("/")[2]
            return {"kernels"} | {layer for layer, files in self.kernel_users.items() if name in files}
        return self.own_areas(path)

    def own_areas(self, path):
        top, _, rest = path.partition("/")
        folder = rest.partition("/")[0] if "/" in rest else ""
        if DOCUMENTS.match(path):
            return {"documents"}
        if BUILD.match(path):
            return {"build"}
        if top == "src" and folder:
            return {folder} | ({"documents"} if path.endswith(".1") else set())
        if top == "src":
            return {"camber-map" if re.match(r"camber_(map|tiles)\.h", rest) else "camber", "packaging"}
        if top == "kernels":
            return {"kernels"}
        if top == "shaders":
            return {"shaders", "gl"}
        if top == "examples":
            return {"examples-" + folder if folder else "examples"}
        if path in ("setup.py", "pyproject.toml", "MANIFEST.in"):
            return {"python", "packaging"}
        return {top} if top in ("python", "packaging", "bench") else set()


def bare(name):
    """The name without what all have; replay_NAME is made of fuzz_NAME.c."""
    return re.sub(r"^replay_", "fuzz_", re.sub(r"^test_", "", name))


def stem_of(path):
    """What the tests are named after that a file of tests/ belongs to."""
    parts = path.split("/")
    if len(parts) > 3 and parts[2] in ("corpus", "regressions"):
        return "fuzz_" + parts[3]
    return "golden" if parts[1] == "golden" else os.path.splitext(parts[-1])[0]


class Mentions:
    """Which tests a file of tests/ belongs to: those that are named after it, or after a file that mentions it. And which
    layers of WORDS a test does not get to."""

    def __init__(self, root):
        self.root, self.texts, self.known = root, collections.defaultdict(str), {}
        for path in self._files("tests", (".c", ".h", ".py", ".sh", ".mjs")):
            self.texts[os.path.splitext(os.path.basename(path))[0]] += self._text(path)
        self.words = {stem: set(re.findall(r"\w+", text)) for stem, text in self.texts.items()}
        self.commands = dict(re.findall(r"add_test\(NAME (\S+)(.*?)\)\n", self._text("tests/CMakeLists.txt"), re.S))

    def _files(self, folder, endings=("",)):
        for top, folders, names in os.walk(os.path.join(self.root, folder)):
            folders[:] = [name for name in folders if name not in ("corpus", "regressions", "data", "golden")]
            yield from (os.path.join(top, name) for name in names if name.endswith(endings))

    def _text(self, path):
        with open(os.path.join(self.root, path), encoding="utf-8", errors="replace") as file:
            return file.read()

    def _text_of(self, test):
        """What a test runs: its command, its own files and those that these name, and the folders of its labels. "" if that
        is not known."""
        waiting = [stem for stem in self.texts if is_named_after(test.name, [stem])]
        found, text = set(), self.commands.get(test.name, "")
        while waiting:
            stem = waiting.pop()
            if stem not in found:
                found.add(stem)
                text += self.texts[stem]
                waiting += {name for names in re.findall(r"\b(\w+)\.(?:h|py|sh|mjs)\b|\b(?:import|from) (\w+)", self.texts[stem])
                            for name in names} & self.texts.keys()
        for label in test.labels[1:]:
            if label == "python" or label.startswith("examples"):
                text += "".join(map(self._text, self._files(label.replace("-", "/"))))
        return text and test.name + text

    def unreached(self, test):
        """The layers of WORDS that no word of a test leads to."""
        if test.name not in self.known:
            text = self._text_of(test)
            self.known[test.name] = {layer for layer, words in WORDS.items()
                                     if text and layer not in test.labels and not re.search(words, text, re.I)}
        return self.known[test.name]

    def stems(self, path):
        """The stems of a file and of all that mention it, by way of others too."""
        found, waiting = set(), [stem_of(path)]
        while waiting:
            one = waiting.pop()
            found.add(one)
            waiting += [other for other, words in self.words.items() if one in words and other not in found]
        return found


def is_named_after(test, stems):
    return any(bare(test) == bare(stem) or bare(test).startswith(bare(stem) + "_") for stem in stems)


# ---- Shares ----


def part_of(test):
    """K of NAME_K, one of several parts of something that have a build in common; or None."""
    part = test.fixture and re.search(r"_([0-9])$", test.name)
    return part and int(part.group(1))


def build_costs(tests):
    """Fixture -> what its build costs."""
    return {test.name.removesuffix("_build"): test.cost for test in tests if test.is_setup}


def assign_shares(tests):
    """Name -> share, 0 to SHARES - 1, of like cost, those of ./dev test and the others each for themselves: a change may
    run all of the former. Tests that one build serves stay together; of something in parts two do, for two processors.
    What a change alone runs, what only the sanitizers run, and builds have none."""
    shares, groups = {}, collections.defaultdict(list)
    for test in tests:
        if test.is_setup or test.name.endswith("_changed") or "instrumented" in test.labels:
            continue
        groups[(test.fixture, ((part_of(test) or 1) + 1) // 2) if test.fixture else (test.name, 0)].append(test)
    built = build_costs(tests)
    costs = {key: sum(test.cost for test in group) + built.get(group[0].fixture, 0) for key, group in groups.items()}
    loads = {True: [0.0] * SHARES, False: [0.0] * SHARES}
    for key in sorted(groups, key=lambda key: (-costs[key], key)):
        loaded = loads[groups[key][0].labels[0] in EVERYDAY]
        share = loaded.index(min(loaded))
        loaded[share] += costs[key]
        shares.update((test.name, share) for test in groups[key])
    return shares


# ---- Choosing ----

Choice = collections.namedtuple("Choice", "areas reached share waiting sanitized lint minutes goal")


def count_mutants(root, changed):
    path = os.path.join(root, "tests/deep/test_mutations.sh")
    if not os.path.isfile(path):
        return 0
    with open(path, encoding="utf-8") as file:
        return sum(name in changed for name in re.findall(r"^mutant \w+ (\S+) ", file.read(), re.M))


def is_of_little(tests, reached):
    """Whether a change reaches less than three quarters of ./dev test."""
    everyday = [test for test in tests if test.labels[0] in EVERYDAY]
    return sum(test.cost for test in everyday if test.name in reached) < 0.75 * sum(test.cost for test in everyday)


Pace = collections.namedtuple("Pace", "goal before busy")  # minutes; minutes before the tests; processors that are busy


def pace_of(tests, reached, number):
    if number is None:
        return Pace(GOAL_MINUTES_OF_DOCUMENTS, MINUTES_BEFORE_FEW_TESTS, 1.0)  # recipes wait for each other
    if is_of_little(tests, reached):
        return Pace(GOAL_MINUTES_OF_LITTLE, MINUTES_BEFORE_FEW_TESTS, BUSY)
    return Pace(GOAL_MINUTES, MINUTES_BEFORE_TESTS, BUSY)


class Budget:
    """The seconds of a change that its tests of ./dev test and its share leave for what names a changed layer."""

    def __init__(self, tests, reached, due, number):
        self.builds, self.spent, self.pace = build_costs(tests), 0.0, pace_of(tests, reached, number)
        for test in tests:
            if test.name in reached | due:
                self.spent += test.cost + self.build(test.fixture)
        self.left = 60 * self.pace.busy * (self.pace.goal - self.pace.before) - self.spent
        if number is not None:
            self.left = max(self.left, LEAST_SECONDS)

    def minutes(self):
        return self.pace.before + self.spent / self.pace.busy / 60

    def build(self, fixture):
        """What is to be built for it, once."""
        return self.builds.pop(fixture, 0.0)

    def take(self, seconds, fixture):
        """Whether so much is left; then it is taken."""
        if seconds == 0 or seconds + self.builds.get(fixture, 0.0) > self.left:
            return False
        taken = seconds + self.build(fixture)
        self.left, self.spent = self.left - taken, self.spent + taken
        return True

    def take_cheapest(self, tests, fixture=None, times=1.0):
        """The names of those that are taken."""
        return {test.name for test in sorted(tests, key=lambda test: (test.cost, test.name))
                if self.take(times * test.cost, fixture or test.fixture)}


def choose(root, tests, changed, number, recipes=()):
    """The tests of a change: changed files, the commit's number, the recipes whose words changed. number None: no share."""
    arrows, mentions = Arrows(root), Mentions(root)
    areas, own_areas = set().union(*map(arrows.areas, changed)), set().union(*map(arrows.own_areas, changed))
    of_tests = [path for path in changed if path.startswith("tests/")]
    own = set(map(stem_of, of_tests))
    stems = set().union(*map(mentions.stems, of_tests))
    shares, reached, deep, sanitized = assign_shares(tests), set(), [], []
    for test in tests:
        label, named = test.labels[0], set(test.labels[1:])
        direct = bool((named - set(arrows.libraries)) & own_areas) or is_named_after(test.name, own)
        if label in SANITIZED and direct and not test.is_setup:
            sanitized.append(test)
        if test.name not in shares:
            continue
        if label in EVERYDAY:
            covered = set().union(*map(arrows.covered, named)) - mentions.unreached(test)
            is_reached = (label == "tree" or "build" in areas or covered & areas or is_named_after(test.name, stems) or
                          label == "tool" and "cli" in areas)
        else:
            is_reached = False
            direct = direct or bool(named & {"recipe-" + name for name in recipes})
        if direct and label not in EVERYDAY and not part_of(test):
            deep.append(test)
        if is_reached:
            reached.add(test.name)
    due = set() if number is None else {name for name in set(shares) - reached if shares[name] == number % SHARES}
    budget = Budget(tests, reached, due, number)
    told = {"test_recipe_" + name for name in recipes}
    reached |= budget.take_cheapest([test for test in deep if test.name in told - due])
    if budget.take(count_mutants(root, changed) * SECONDS_A_MUTANT, "mutations"):
        reached.add("mutations_changed")
    sanitized = budget.take_cheapest(sanitized, "sanitize", TIMES_UNDER_SANITIZERS)
    if sanitized:
        reached.add("sanitize_changed")
    reached |= budget.take_cheapest([test for test in deep if test.name not in due | reached])
    waiting, share = collections.defaultdict(list), due - reached
    for name in sorted(set(shares) - reached - share):
        waiting[None if number is None else (shares[name] - number) % SHARES].append(name)
    return Choice(areas, reached, share, waiting, sanitized, lint_targets(root, changed), budget.minutes(), budget.pace.goal)


def lint_targets(root, changed):
    """A regular expression of the targets of lint.cmake that a change reaches: files that changed, and what includes them."""
    if any(LINT.match(path) for path in changed):
        return "lint/.*"
    including = collections.defaultdict(set)
    for folder in ("src", "bench", "kernels"):
        for top, _, names in os.walk(os.path.join(root, folder)):
            for name in names:
                if name.endswith((".c", ".h", ".inl", ".cl")):
                    path = os.path.relpath(os.path.join(top, name), root)
                    with open(os.path.join(root, path), encoding="utf-8", errors="replace") as file:
                        for included in re.findall(r'#\s*include\s+"([^"]+)"', file.read()):
                            including[included].add(path)
    found, waiting = set(), list(changed)
    while waiting:
        path = waiting.pop()
        if path not in found:
            found.add(path)
            waiting += including[path] | including[path.removeprefix("src/")] | (
                including[os.path.basename(path)] if path.startswith(("kernels/", "bench/")) else set())
    targets = ["tree", "format"]
    targets += ["tidy_" + re.escape(path.replace("/", "_")) for path in sorted(found)
                if path.startswith(("src/", "bench/")) and path.endswith(".c")]
    if any(path.startswith("kernels/") for path in changed):
        targets.append("kernel_.*")
    if any(path.startswith(("src/camber", "kernels/")) for path in changed):
        targets.append("c(xx)?_.*")
    return "lint/(%s)" % "|".join(targets)


# ---- The change ----


def git(root, *arguments):
    return subprocess.run(["git", "-C", root, *arguments], check=True, capture_output=True, text=True).stdout


def tested_commits():
    folder = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    try:
        with open(os.path.join(folder, "camber-tested"), encoding="utf-8") as file:
            return set(file.read().split())
    except OSError:
        return set()


def find_base(root):
    """(commit or None: all of it is new, why)"""
    if os.environ.get("CAMBER_BASE"):
        return git(root, "rev-parse", "--verify", os.environ["CAMBER_BASE"] + "^{commit}").strip(), "CAMBER_BASE"
    tested = tested_commits()
    for commit in git(root, "rev-list", "HEAD").split():
        if commit in tested:
            return commit, "the newest commit that passed here"
    newest = int(git(root, "log", "-1", "--format=%ct"))
    before = git(root, "rev-list", "-1", "--before=%d" % (newest - 24 * 3600), "HEAD").strip()
    return before or None, "the newest commit that is a day older"


def recipe_blocks(text):
    """Name -> words of the recipes of a document, as tests/recipes/recipes.sh takes them."""
    parts = re.split(r"^<!-- recipe: (\S+) -->\n", text, flags=re.M)
    return {name: re.match(r"(?s:```.*?\n```)|(?:    .*\n)+|", body).group() for name, body in zip(parts[1::2], parts[2::2])}


def changed_recipes(root, base, changed):
    names = set()
    for path in changed:
        if path.endswith(".md"):
            old = subprocess.run(["git", "-C", root, "show", "%s:%s" % (base, path)], capture_output=True, text=True).stdout
            new = ""
            if os.path.isfile(os.path.join(root, path)):
                with open(os.path.join(root, path), encoding="utf-8") as file:
                    new = file.read()
            before, now = recipe_blocks(old), recipe_blocks(new)
            names |= {name for name in before.keys() | now.keys() if before.get(name) != now.get(name)}
    return names


def find_change(root):
    """(changed files, number of the commit or None, recipes that changed, a line about it)"""
    base, why = find_base(root)
    uncommitted = set(git(root, "diff", "--name-only", "HEAD").split("\n") +
                      git(root, "ls-files", "--others", "--exclude-standard").split("\n")) - {""}
    changed = set(git(root, "ls-files").split("\n") if base is None else
                  git(root, "diff", "--name-only", base).split("\n")) - {""} | uncommitted
    number = None
    if not changed or not all(DOCUMENTS.match(path) for path in changed):
        number = int(git(root, "rev-list", "--count", "HEAD", "--", ".", ":(exclude)docs", ":(exclude,glob)*.md"))
        number += any(not DOCUMENTS.match(path) for path in uncommitted)
    line = "%d files changed since %s, %s" % (len(changed), base[:7] if base else "the beginning", why)
    return sorted(changed), number, changed_recipes(root, base or "HEAD", changed), line


def report(choice, number, line):
    lines = [line + (": " + ", ".join(sorted(choice.areas)) if choice.areas else "")]
    lines.append("runs what the change reaches: %d tests; with its share about %.0f minutes of two processors, where %.0f are the goal" %
                 (len(choice.reached), choice.minutes, choice.goal))
    if number is None:
        lines.append("runs no share of the others: documents alone have changed; %d wait" % sum(map(len, choice.waiting.values())))
        return lines
    lines.append("runs share %d of %d of the others, for commit %d: %s" %
                 (number % SHARES or SHARES, SHARES, number, " ".join(sorted(choice.share)) or "nothing"))
    for commits in sorted(choice.waiting):
        lines.append("waits for %d commit%s: %s" % (commits, "s" * (commits > 1), " ".join(choice.waiting[commits])))
    return lines


def expression(names):
    return "^(%s)$" % "|".join(map(re.escape, sorted(names)))


def main():
    root, build = sys.argv[1:3]
    tests = read_manifest(os.path.join(build, "tests/manifest.txt"))
    changed, number, recipes, line = find_change(root)
    choice = choose(root, tests, changed, number, recipes)
    print("\n".join(report(choice, number, line)), file=sys.stderr)
    chosen = choice.reached | choice.share
    needs_build = any(test.name in chosen and test.labels[0] != "tree" for test in tests)
    for name, value in (("chosen_tests", expression(chosen)), ("chosen_lint", choice.lint),
                        ("chosen_need_build", "yes" if needs_build else ""),
                        ("CAMBER_CHANGED", "\n".join(changed)), ("CAMBER_SANITIZED", expression(choice.sanitized))):
        print("%s=%s" % (name, shlex.quote(value)))


if __name__ == "__main__":
    main()
