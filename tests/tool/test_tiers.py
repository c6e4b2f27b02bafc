#!/usr/bin/env python3
"""./dev test --change chooses what it says: made-up changes of this tree, and seven commits that run every test.

    test_tiers.py ROOT BUILD

BUILD is a configured build folder of ROOT: the tests are those of its tests/manifest.txt.
"""

import functools
import os
import re
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import tiers  # noqa: E402

tiers.Arrows, tiers.Mentions = functools.cache(tiers.Arrows), functools.cache(tiers.Mentions)  # the tree stays as it is

ROOT, BUILD = sys.argv.pop(1), sys.argv.pop(1)
TESTS = tiers.read_manifest(os.path.join(BUILD, "tests/manifest.txt"))
NAMES = {test.name for test in TESTS}


def choose(*changed, number=100, recipes=()):
    return tiers.choose(ROOT, TESTS, changed, number, recipes)


class Tiers(unittest.TestCase):
    def setUp(self):
        """A commit has time for all that names what it changes; how much it has is test_a_change_has_an_end's."""
        kept = tiers.LEAST_SECONDS
        tiers.LEAST_SECONDS = 5000.0
        self.addCleanup(setattr, tiers, "LEAST_SECONDS", kept)

    def expect(self, choice, runs, waits):
        """Of the tests that this build has, the first run and the change does not reach the others."""
        self.assertFalse((set(runs) & NAMES) - choice.reached - choice.share)
        self.assertFalse(set(waits) & choice.reached)

    def test_a_kernel(self):
        choice = choose("kernels/stroke.h")
        self.expect(choice, {"test_pixels", "test_pixels_cl", "test_golden", "test_rasterize", "test_serve_outside",
                             "test_cli", "test_validate", "test_oclgrind", "mutations_changed", "lint_tree"},
                    {"test_kubernetes", "test_recipe_build", "fuzz_osm", "test_slurm", "mutations_1"})
        self.assertIn("gl", choice.areas)  # the shaders include it
        self.assertRegex("lint/kernel_raster_gpu", choice.lint)

    def test_a_kernel_header_that_one_layer_includes(self):
        self.assertEqual(choose("kernels/offset.h").areas - {"gl"},
                         {"kernels", "gpu", "points", "residency", "stroke"})

    def test_a_reader(self):
        choice = choose("src/osm/read.c")
        self.expect(choice, {"test_osm", "test_coast", "test_cli", "test_serve_outside", "test_golden_map", "fuzz_osm",
                             "sanitize_changed"},
                    {"test_pixels", "test_rasterize", "test_memory", "test_validate", "mutations_changed", "test_oclgrind",
                     "fuzz_png"})
        self.assertIn("test_osm", choice.sanitized)
        self.assertNotIn("test_pixels", choice.sanitized)
        self.assertTrue(re.fullmatch(choice.lint, "lint/tidy_src_osm_read.c"))
        self.assertFalse(re.fullmatch(choice.lint, "lint/tidy_src_osm_ways.c"))

    def test_the_server(self):
        choice = choose("src/serve/route.c")
        self.expect(choice, {"test_serve_outside", "test_route", "test_page", "test_proxies", "sanitize_soak", "test_cli"},
                    {"test_tiles_outside", "test_pixels", "test_osm", "fuzz_osm"})

    def test_a_document(self):
        choice = choose("docs/strokes.md", "README.md", number=None)
        self.assertEqual({test.labels[0] for test in TESTS if test.name in choice.reached}, {"tree"})
        self.assertFalse(choice.share)
        self.assertFalse(choice.sanitized)

    def test_a_recipe(self):
        self.expect(choose("README.md", number=None, recipes={"demo"}), {"test_recipe_demo"},
                    {"test_recipe_core", "test_newcomer_trixie"})

    def test_the_build(self):
        for path in ("dev", "CMakeLists.txt", "tests/CMakeLists.txt", "src/CMakeLists.txt", ".ci/run"):
            choice = choose(path)
            everyday = {test.name for test in TESTS if test.labels[0] in tiers.EVERYDAY and not test.is_setup}
            self.assertFalse(everyday - choice.reached, path)
            self.assertTrue(choice.share)

    def minutes_of(self, choice, number):
        """By the costs of what it runs, with what is built for it; a mutant's are known to nobody."""
        chosen = [test for test in TESTS if test.name in choice.reached | choice.share]
        fixtures = {test.fixture for test in chosen}
        seconds = sum(test.cost for test in chosen if not test.name.endswith("_changed"))
        seconds += sum(test.cost for test in TESTS if test.is_setup and test.name.removesuffix("_build") in fixtures)
        seconds += tiers.TIMES_UNDER_SANITIZERS * sum(test.cost for test in TESTS if test.name in choice.sanitized)
        pace = tiers.pace_of(TESTS, choice.reached, number)
        return pace.before + seconds / pace.busy / 60

    def test_a_change_has_an_end(self):
        """Of everything, of the build, of a kernel, of documents: the goal. A seventh of the deep tests takes longer than the goal of
        readers and the server leaves: what they take is known. On each of seven commits; the report says what the costs do."""
        tiers.LEAST_SECONDS = 220.0
        everything = subprocess.run(["git", "-C", ROOT, "ls-files"], capture_output=True, text=True).stdout.split()
        for number in range(200, 200 + tiers.SHARES):
            for changed, most in ((everything, 25), (["tests/CMakeLists.txt", "dev"], 25), (["kernels/stroke.h"], 25),
                                  (["kernels/rasterize.cl"], 25), (["src/osm/read.c"], 22.5), (["src/gdal/confine.c"], 22.5),
                                  (["src/archive/read.c"], 22.5), (["src/serve/route.c"], 20)):
                choice = choose(*changed, number=number)
                self.assertLessEqual(choice.minutes, most, (number, changed[0]))
                self.assertAlmostEqual(choice.minutes, self.minutes_of(choice, number),
                                       delta=2 if "mutations_changed" in choice.reached else 0.01)
        for recipes in ((), {"build"}, {"demo", "core", "ci", "build", "python"}):
            choice = choose("README.md", number=None, recipes=recipes)
            self.assertLessEqual(choice.minutes, 5)
            self.assertAlmostEqual(choice.minutes, self.minutes_of(choice, None), delta=0.01)
            self.assertEqual(bool(recipes), any(name.startswith("test_recipe") for name in choice.reached))
        choice = choose(*everything)
        self.assertNotIn("mutations_changed", choice.reached)
        self.assertTrue(choice.share)

    def test_a_test(self):
        self.expect(choose("tests/unit/test_osm.c"), {"test_osm", "sanitize_changed"}, {"test_coast", "test_pixels"})
        self.expect(choose("tests/fixtures/pbf_file.h"), {"test_osm", "replay_osm"}, {"test_pixels", "test_leaks"})
        self.expect(choose("tests/fuzz/corpus/osm/made.pbf"), {"replay_osm", "fuzz_osm"}, {"replay_glb"})
        self.expect(choose("tests/golden/caps.png"), {"test_golden", "test_golden_cl"}, {"test_osm"})

    def test_a_header_that_others_include(self):
        choice = choose("src/camber_map.h")
        self.expect(choice, {"test_golden_map", "test_serve_outside", "test_python"}, {"test_pixels"})
        self.assertTrue(re.fullmatch(choice.lint, "lint/tidy_src_cli_verb_render.c"))
        self.assertTrue(re.fullmatch(choose(".clang-tidy").lint, "lint/tidy_src_osm_ways.c"))

    def test_layers_are_those_of_the_tree(self):
        arrows = tiers.Arrows(ROOT)
        for test in TESTS:
            for label in test.labels[1:]:
                known = label in arrows.layers.links or label in arrows.libraries or label.startswith(("examples", "recipe-"))
                self.assertTrue(known or label in ("kernels", "shaders", "python", "packaging", "bench", "instrumented",
                                                   "mutation", "oclgrind", "asan", "ubsan", "tsan", "aarch64"), (test.name, label))
        self.assertIn("osm", arrows.covered("serve"))
        self.assertIn("raster", arrows.covered("map"))
        self.assertNotIn("features", arrows.covered("camber"))

    def test_seven_commits_run_all(self):
        shares = tiers.assign_shares(TESTS)
        for first in (100, 101, 887):
            ran = [choose("python/camber/_lines.py", number=number) for number in range(first, first + tiers.SHARES)]
            self.assertFalse(set(shares) - set().union(*(choice.share | choice.reached for choice in ran)))
            for choice in ran:  # nobody waits for longer than is said, and none is forgotten
                self.assertLess(max(choice.waiting), tiers.SHARES)
                self.assertEqual(set(shares), choice.share | (choice.reached & set(shares)) | set().union(*choice.waiting.values()))
        deep = {test.name for test in TESTS if test.labels[0] not in tiers.EVERYDAY and "instrumented" not in test.labels}
        self.assertEqual({name for name in deep - set(shares)},
                         {test.name for test in TESTS if test.name in deep and (test.is_setup or test.name.endswith("_changed"))})

    def test_shares_are_of_like_cost(self):
        """Those of ./dev test and the others, each for themselves."""
        shares = tiers.assign_shares(TESTS)
        for is_everyday in (True, False):
            costs = [0.0] * tiers.SHARES
            for test in TESTS:
                if test.name in shares and (test.labels[0] in tiers.EVERYDAY) == is_everyday:
                    costs[shares[test.name]] += test.cost
            self.assertLess(max(costs), 1.5 * sum(costs) / tiers.SHARES, costs)

    def test_two_parts_share_a_build(self):
        """They run beside each other; what the build serves besides is with the first of them."""
        shares = tiers.assign_shares(TESTS)
        of_sanitizers = [shares["sanitize_%d" % part] for part in (1, 2, 3, 4)]
        self.assertEqual(of_sanitizers[0::2], of_sanitizers[1::2])
        self.assertNotEqual(of_sanitizers[0], of_sanitizers[2])
        self.assertEqual(shares.get("sanitize_soak", of_sanitizers[0]), of_sanitizers[0])


class Repository(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = os.path.join(folder.name, "tree")
        os.makedirs(self.root)
        kept = os.environ.pop("CAMBER_BASE", None), os.environ.get("XDG_CACHE_HOME")
        os.environ["XDG_CACHE_HOME"] = folder.name
        self.addCleanup(lambda: [os.environ.update({name: value}) for name, value in
                                 zip(("CAMBER_BASE", "XDG_CACHE_HOME"), kept) if value is not None])
        self.git("init", "-q")

    def git(self, *arguments, date="2026-11-20T12:00:00"):
        told = subprocess.run(["git", "-C", self.root, "-c", "user.name=a", "-c", "user.email=a@example.org", *arguments],
                              check=True, capture_output=True, text=True, env={**os.environ, "GIT_COMMITTER_DATE": date})
        return told.stdout.strip()

    def commit(self, path, text, date="2026-11-20T12:00:00"):
        os.makedirs(os.path.dirname(os.path.join(self.root, path)), exist_ok=True)
        with open(os.path.join(self.root, path), "w", encoding="utf-8") as file:
            file.write(text)
        self.git("add", "-A")
        self.git("commit", "-qm", path, date=date)
        return self.git("rev-parse", "HEAD")

    def test_what_has_changed(self):
        first = self.commit("src/osm/read.c", "1")
        self.assertEqual(tiers.find_change(self.root)[:2], (["src/osm/read.c"], 1))  # no base: all of it
        self.commit("docs/input.md", "text")
        second = self.commit("src/osm/read.c", "2", date="2026-11-22T12:00:00")
        self.assertEqual(tiers.find_change(self.root)[:2], (["src/osm/read.c"], 2))  # a day older; documents do not count
        with open(os.path.join(os.path.dirname(self.root), "camber-tested"), "w", encoding="utf-8") as file:
            file.write(first + "\n")
        self.assertEqual(tiers.find_change(self.root)[:2], (["docs/input.md", "src/osm/read.c"], 2))  # it passed
        os.environ["CAMBER_BASE"] = second
        self.addCleanup(os.environ.pop, "CAMBER_BASE", None)
        self.commit("docs/input.md", "more")
        self.assertEqual(tiers.find_change(self.root)[:2], (["docs/input.md"], None))
        with open(os.path.join(self.root, "made.c"), "w", encoding="utf-8"):
            pass
        self.assertEqual(tiers.find_change(self.root)[:2], (["docs/input.md", "made.c"], 3))  # not committed yet

    def test_a_recipe_that_has_changed(self):
        recipe = "# Title\n\n<!-- recipe: demo -->\n    ./dev demo\n    ./dev test\n\nWords\n\n<!-- recipe: build -->\n```sh\nmake\n```\n"
        first = self.commit("docs/a.md", recipe)
        self.commit("docs/a.md", recipe.replace("Words", "Other words"))
        self.assertEqual(tiers.changed_recipes(self.root, first, {"docs/a.md"}), set())
        self.commit("docs/a.md", recipe.replace("make\n", "make all\n"))
        self.assertEqual(tiers.changed_recipes(self.root, first, {"docs/a.md"}), {"build"})


if __name__ == "__main__":
    unittest.main()
