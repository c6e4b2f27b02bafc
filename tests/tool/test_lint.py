#!/usr/bin/env python3
"""The lint of the tree finds what it is for: each rule is broken in a small tree of its own, and nothing else is found.

    test_lint.py
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "lint"))
import lint_tree  # noqa: E402

HEAD = "/* A file. */\n"


def header(guard, body=""):
    return HEAD + "#ifndef %s\n#define %s\n%s\n#endif\n" % (guard, guard, body)


CLEAN = {
    "src/CMakeLists.txt": "# The layers.\nfunction(camber_layer name)\nendfunction()\n"
                          "camber_layer(base)\ncamber_layer(io LINKS base PNG::PNG)\n"
                          "camber_layer(draw LINKS io # drawn\n  EXTRA base)\n",
    "src/camber.h": header("CAMBER_H", "typedef struct camber_context camber_context;"),
    "src/base/base.h": header("CAMBER_BASE_BASE_H", '#include "camber.h"\n'
                              "struct camber_context { int size; };\n"
                              "typedef enum camber_kind { CAMBER_KIND_ONE } camber_kind;\n"
                              "typedef void camber_log_fn(void *user, const char *text);\n"
                              "int camber_base(void);"),
    "src/base/base.c": HEAD + '#include "base/base.h"\ntypedef struct place { int x; } place;\n'
                              "int camber_base(void) { return 0; }\n",
    "src/io/png.c": HEAD + '#include "base/base.h"\n#include "kernels/layout.h"\n'
                           "typedef struct place { int x; } place;\n"
                           'static const char text[] = "typedef struct camber_kind { } /* Of */";\n'
                           "int camber_png(void);\nint camber_png(void) { return camber_base() + (int)text[0]; }\n",
    "src/draw/draw.c": HEAD + '#include "base/base.h" /* by way of io */\nint camber_png(void);\n'
                              "int camber_rasterizer(void);\nint camber_rasterizer(void) { return camber_png(); }\n",
    "kernels/layout.h": header("CAMBER_KERNELS_LAYOUT_H", "#define CAMBER_BLOCK 256"),
    "kernels/scan.cl": HEAD + '#include "kernels/layout.h"\nkernel void scan(void) { int x = CAMBER_BLOCK; }\n',
    "shaders/stroke.vert": "// Made of triangles.\nvoid main() {}\n",
    "tests/fixtures/scene.h": header("CAMBER_TESTS_FIXTURES_SCENE_H", "typedef struct scene { int x; } scene;"),
    "tests/unit/test_png.c": HEAD + "typedef struct scene { int other; } scene;\n",
    "bench/bench.c": HEAD + "int main(void) { return 0; }\n",
    "README.md": "# camber\n\n| %s |\n%s\n" % ("a row " * 40, "https://example.org/" + "long" * 40),
    "docs/glossary.md": "# Words\n\n## Words that are gone\n\n- `camber_edge`: camber_edge\n"
                        "- prowl, veil (of a layer): neighbour walk\n\n## Others\n\n- ink: brush\n",
}


class Lint(unittest.TestCase):
    def setUp(self):
        self.root = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.root)
        for path, text in CLEAN.items():
            self.write(path, text)

    def write(self, path, text):
        path = os.path.join(self.root, path)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)

    def append(self, path, text):
        self.write(path, CLEAN[path] + text)

    def findings(self, build=None):
        tree = lint_tree.Tree(self.root, build)
        return [finding for rule in lint_tree.RULES for finding in rule(tree)]

    def finds(self, place, what, build=None):
        """There is one finding, at place (file:line), and it says what."""
        found = self.findings(build)
        self.assertEqual(["%s:%d" % finding[:2] for finding in found], [place], found)
        self.assertIn(what, found[0].what)

    def compile(self):
        """A build folder as CMake lays it out."""
        build = os.path.join(self.root, "build")
        commands = []
        for folder, _, names in os.walk(os.path.join(self.root, "src")):
            for name in names:
                if not name.endswith(".c"):
                    continue
                source = os.path.join(folder, name)
                made = os.path.join(build, "src/CMakeFiles/objects.dir",
                                    os.path.relpath(source, os.path.join(self.root, "src")) + ".o")
                os.makedirs(os.path.dirname(made), exist_ok=True)
                subprocess.run(["cc", "-c", "-I", os.path.join(self.root, "src"), "-I", self.root, "-o", made, source],
                               check=True)
                commands.append({"directory": build, "file": source, "command": "cc -o %s -c %s" % (made, source)})
        # An object file of a source that has moved on: it counts no more.
        with open(os.path.join(build, "src/CMakeFiles/objects.dir/left.c.o"), "w") as left:
            left.write("left")
        with open(os.path.join(build, "compile_commands.json"), "w") as database:
            json.dump(commands, database)
        return build

    def test_clean(self):
        self.assertEqual(self.findings(), [])

    def test_clean_objects(self):
        self.assertEqual(self.findings(self.compile()), [])

    # ---- Types ----

    def test_type_of_two_headers(self):
        self.append("tests/fixtures/scene.h", "struct camber_context { int other; };\n#endif\n")
        self.finds("tests/fixtures/scene.h:6", "camber_context is defined in src/base/base.h:5")

    def test_type_of_header_and_source(self):
        self.append("src/draw/draw.c", "typedef int (*scene)(void);\n")
        self.finds("src/draw/draw.c:6", "type scene")

    def test_type_of_header_and_kernel(self):
        self.append("kernels/scan.cl", "typedef float camber_kind[4];\n")
        self.finds("kernels/scan.cl:4", "type camber_kind")

    def test_type_of_two_sources_with_prefix(self):
        self.append("src/io/png.c", "enum camber_way { UP };\n")
        self.append("src/draw/draw.c", "typedef int first, camber_way;\n")
        self.finds("src/io/png.c:8", "type camber_way")

    # ---- Guards ----

    def test_guard_missing(self):
        self.write("src/io/io.h", HEAD + "int camber_io(void);\n")
        self.finds("src/io/io.h:1", "no include guard")

    def test_guard_repeated(self):
        self.write("src/io/io.h", header("CAMBER_BASE_BASE_H"))
        self.finds("src/io/io.h:2", "is that of src/base/base.h")

    def test_guard_of_another_path(self):
        self.write("src/io/io.h", header("CAMBER_IO_H"))
        self.finds("src/io/io.h:2", "does not follow the path")

    # ---- Layers ----

    def test_include_points_up(self):
        self.write("src/io/io.h", header("CAMBER_IO_IO_H"))
        self.append("src/base/base.c", '\n#include "io/io.h"\n')
        self.finds("src/base/base.c:6", "layer base includes io")

    def test_include_of_parent(self):
        self.append("src/io/png.c", '#include "../base/base.h"\n')
        self.finds("src/io/png.c:8", '"../base/base.h"')

    def test_kernel_includes_layer(self):
        self.append("kernels/scan.cl", '#include "base/base.h"\n')
        self.finds("kernels/scan.cl:4", "kernels includes layer base")

    def test_public_header_includes_layer(self):
        self.write("src/camber.h", header("CAMBER_H", '#include "base/base.h"'))
        self.finds("src/camber.h:4", "src includes layer base")

    def test_folder_without_layer(self):
        self.write("src/gl/gl.c", HEAD)
        self.finds("src/CMakeLists.txt:1", "src/gl is no layer")

    def test_no_layers(self):
        self.write("src/CMakeLists.txt", "camber_layer(all base io draw)\n")
        self.finds("src/CMakeLists.txt:1", "no layers")

    def test_archive_that_knows_styles(self):
        self.write("src/style/style.c", "int style(void) {\n    return 0;\n}\n")
        self.write("src/archive/read.c", "int archive(void) {\n    return 0;\n}\n")
        self.append("src/CMakeLists.txt", "camber_layer(style LINKS base)\ncamber_layer(archive LINKS style)\n")
        self.finds("src/CMakeLists.txt:9", "layer archive reaches style")

    def test_layers_in_a_circle(self):
        self.write("src/gl/gl.c", HEAD)
        self.append("src/CMakeLists.txt", "camber_layer(gl LINKS gl)\n")
        self.finds("src/CMakeLists.txt:8", "layer gl links itself in a circle")

    def test_link_points_up(self):
        self.append("src/base/base.c", "int camber_png(void);\nint camber_up(void);\n"
                                       "int camber_up(void) { return camber_png(); }\n")
        self.finds("src/base/base.c:1", "layer base calls camber_png of src/io/png.c", self.compile())

    def test_link_of_two_definitions(self):
        """One is of a layer that the caller links; the other one takes its place in another library."""
        self.append("src/CMakeLists.txt", "camber_layer(gl LINKS base)\n")
        for layer in ("base", "gl"):
            self.write("src/%s/found.c" % layer, HEAD + "int camber_found(void);\nint camber_found(void) { return 1; }\n")
        self.append("src/draw/draw.c", "int camber_found(void);\nint camber_draw(void);\n"
                                       "int camber_draw(void) { return camber_found(); }\n")
        self.assertEqual(self.findings(self.compile()), [])

    def test_link_cycle(self):
        """Where no layers are named, those that the objects show must have no circle."""
        self.write("src/CMakeLists.txt", "")
        self.append("src/base/base.c", "int camber_png(void);\nint camber_up(void);\n"
                                       "int camber_up(void) { return camber_png(); }\n")
        whats = [finding.what for finding in self.findings(self.compile())]
        self.assertEqual(whats, ["no layers",
                                 "layers base and io use each other: here camber_png of src/io/png.c",
                                 "layers io and base use each other: here camber_base of src/base/base.c"])

    def test_files_in_a_circle(self):
        self.append("src/io/png.c", "int camber_other(void);\nint camber_one(void);\n"
                                    "int camber_one(void) { return camber_other(); }\n")
        self.write("src/io/other.c", HEAD + "int camber_one(void);\nint camber_other(void);\n"
                                            "int camber_other(void) { return camber_one(); }\n")
        whats = [finding[2] for finding in self.findings(self.compile())]
        self.assertEqual(whats, ["it and png.c call each other in a circle", "it and other.c call each other in a circle"])

    def test_opencl_outside_of_gpu(self):
        self.append("src/draw/draw.c", "/* cl_mem is no more than a word here */\nlong cl_khr_fp64;\nvoid *cl_mem;\n")
        self.finds("src/draw/draw.c:8", "cl_mem outside of src/gpu")

    def test_headers_of_drivers(self):
        for header in ("CL/cl.h", "EGL/egl.h", "GLES3/gl32.h"):
            self.write("src/draw/driver.c", HEAD + "#include <%s>\n" % header)
            self.finds("src/draw/driver.c:2", header + ": a build needs nothing of drivers")

    # ---- Kernels ----

    def test_kernel_includes_nothing(self):
        self.write("kernels/scan.cl", HEAD + "#define CAMBER_OWN 1\nkernel void scan(void) {\n"
                                             "    int x = CAMBER_OWN + CAMBER_BLOCK;\n}\n")
        self.finds("kernels/scan.cl:4", "CAMBER_BLOCK comes from nowhere")

    def test_kernel_includes_what_is_not_there(self):
        self.append("kernels/scan.cl", '#include "kernels/join.h"\n')
        self.finds("kernels/scan.cl:4", 'there is no "kernels/join.h"')

    # ---- Words ----

    def test_gone_identifier(self):
        self.append("src/io/png.c", "/* It says\n * so. */\nextern int camber_edge;\n")
        self.finds("src/io/png.c:10", "camber_edge is a word that is gone")

    def test_gone_word_of_comment(self):
        self.append("shaders/stroke.vert", "// A small\n/* line\n   and a veil over it */\n")
        self.finds("shaders/stroke.vert:5", "veil is a word that is gone")

    def test_gone_file(self):
        self.write("bench/prowl.c", HEAD)
        self.finds("bench/prowl.c:1", "the file is called prowl")

    def test_word_within_another(self):
        self.append("src/io/png.c", "extern int camber_pens, prowler, ink; /* unveil, camber_pen_x */\n")
        self.assertEqual(self.findings(), [])

    # ---- Comments ----

    def test_comment_of(self):
        self.append("src/io/png.c", "extern int x; /* Of\n many */\nextern int y; /* Of all */\n")
        self.finds("src/io/png.c:10", 'begins with "Of"')

    def test_comment_what(self):
        self.append("src/CMakeLists.txt", "set(x) #%s it is\n# It is\n#%s goes on.\n" % (2 * (" What",)))
        self.finds("src/CMakeLists.txt:8", 'begins with "What"')

    def test_head(self):
        self.write("src/io/long.c", "int x;\n" + "\n" * 100)
        self.finds("src/io/long.c:1", "without a head")

    # ---- Documents ----

    def test_long_line(self):
        self.append("README.md", "word " * 25 + "\n")
        self.finds("README.md:5", "125 characters")

    def test_long_document(self):
        self.append("README.md", "word\n" * 1300)
        self.finds("README.md:1", "1300 are allowed")

    # ---- English ----

    TRANSLATED = (
        "Where no tile has a line, none is drawn.", "What nobody asked for is left out.",
        "The size comes behind the name.",
        "The caller is told the name.", "It takes so many bytes.", "It reads the header alone.", "It draws the tile anew.",
        "It draws as GL has it.", "The tile lies in memory.", "It is written beside the file.")
    PLAIN = (
        "If no tile has a line, none is drawn. This is where the tiles are, or what is left.", "What is a tile?",
        "A proxy may hide behind another name.", "He told us so.",
        "It takes so many bytes that it fails, so much for that.",
        "It cannot count, let alone draw.", "It has it.", "Belies, aloneness, `beside`, anew_tile, besides.")

    def hints(self):
        return [hint[:2] for hint in lint_tree.list_hints(lint_tree.Tree(self.root))]

    def test_each_pattern_hints(self):
        self.assertEqual(len(self.TRANSLATED), len(lint_tree.PATTERNS))
        for number, sentence in enumerate(self.TRANSLATED):
            found = [i for i, (pattern, _) in enumerate(lint_tree.PATTERNS) if pattern.search(sentence)]
            self.assertEqual(found, [number], sentence)

    def test_hints(self):
        self.assertEqual(self.hints(), [])
        self.append("README.md", "\nA line\nthat is split: it is\ntold. This lies\nhere, and `lies` and ``\n\n"
                                 "    lies = anew\n\n```\nbeside\n```\n\n# Where code lies, or not\n\nIt is\n\ntold.\n")
        self.append("src/io/png.c", "/* It says\n * so\n * much. */\nint lies; // Made anew\n"
                                    "const char *beside = \"beside\";\n")
        self.append("src/CMakeLists.txt", "set(alone 1) # for PNG alone\n")
        self.assertEqual(self.hints(), [("README.md", 7), ("README.md", 8), ("src/CMakeLists.txt", 8),
                                        ("src/io/png.c", 9), ("src/io/png.c", 11)])

    def test_plain_english(self):
        self.append("README.md", "\n" + "\n".join(self.PLAIN) + "\n")
        self.write("bench/plain.c", "/* " + "\n * ".join(self.PLAIN) + " */\n")
        self.assertEqual(self.hints(), [])

    # ---- Packages ----

    def write_packages(self):
        self.write("CMakeLists.txt", "project(camber VERSION 1.2.3 LANGUAGES C)\nfind_package(GDAL REQUIRED)\n"
                                     "option(CAMBER_WARM \"Compile\" ON)\nfind_program(PROTOC_C protoc-c REQUIRED)\n"
                                     "pkg_check_modules(JANSSON REQUIRED IMPORTED_TARGET jansson)\n")
        debian = "libgdal-dev, libjansson-dev, protobuf-c-compiler\n"
        for path, text in {
                "packaging/debian/control": "Build-Depends: " + debian,
                "packaging/debian/changelog": "camber (1.2.3-1) unstable\n",
                "packaging/debian/rules": "dh_auto_configure -- -DCAMBER_WARM=OFF\n",
                "packaging/camber.spec": "Version: 1.2.3\nBuildRequires: pkgconfig(gdal) pkgconfig(jansson)\n"
                                         "BuildRequires: protobuf-c-compiler\nRequires: python3-numpy\n%cmake -DCAMBER_WARM=OFF\n"
                                         "* Wed Nov 25 2026 Someone <a@b> - 1.2.3-1\n",
                "packaging/camber.rb": 'url "camber-1.2.3.tar.gz"\ndepends_on "gdal"\ndepends_on "jansson"\n'
                                       'depends_on "protobuf-c"\nsystem "-DCAMBER_WARM=OFF"\n',
                "packaging/recipe.yaml": 'context:\n  version: "1.2.3"\nscript: cmake -DCAMBER_WARM=OFF\n',
                "examples/serve/Dockerfile": "RUN apt-get install " + debian + "RUN cmake -DCAMBER_WARM=OFF\n",
                "pyproject.toml": 'version = "1.2.3"\ndependencies = ["numpy"]\n', "src/camber.3": '.TH CAMBER 3 "x" "camber 1.2.3"\n',
                "src/cli/camber.1": '.TH CAMBER 1 "x" "camber 1.2.3"\n'}.items():
            self.write(path, text)

    def test_versions_of_packages(self):
        self.write_packages()
        self.assertEqual(list(lint_tree.check_packages(lint_tree.Tree(self.root))), [])
        for path in ("packaging/debian/changelog", "packaging/camber.spec", "packaging/camber.rb", "packaging/recipe.yaml",
                     "pyproject.toml", "src/camber.3", "src/cli/camber.1"):
            self.write_packages()
            with open(os.path.join(self.root, path), encoding="utf-8") as file:
                self.write(path, file.read().replace("1.2.3", "1.2.4", 1))
            self.finds(path + ":1", "the version is 1.2.4")

    def test_libraries_of_packages(self):
        for path, name in (("packaging/debian/control", "libgdal-dev"), ("packaging/camber.spec", "pkgconfig(jansson)"),
                           ("packaging/camber.rb", "gdal"), ("packaging/camber.rb", "protobuf-c"),
                           ("packaging/camber.spec", "protobuf-c-compiler"), ("packaging/camber.spec", "python3-numpy"),
                           ("examples/serve/Dockerfile", "libjansson-dev")):
            self.write_packages()
            with open(os.path.join(self.root, path), encoding="utf-8") as file:
                self.write(path, file.read().replace(name, "x" + name))
            self.finds(path + ":1", "it does without " + name)

    def test_a_new_library(self):
        self.write_packages()
        with open(os.path.join(self.root, "CMakeLists.txt"), encoding="utf-8") as file:
            self.write("CMakeLists.txt", file.read() + "find_package(Zebra REQUIRED)\n")
        self.finds("CMakeLists.txt:1", "Zebra is new")

    def test_options_of_packages(self):
        for path, option, what in (("packaging/camber.rb", "CAMBER_WARM=ON", "CAMBER_WARM=OFF CAMBER_WARM=ON: not as in"),
                                   ("examples/serve/Dockerfile", "CAMBER_SERVER=ON", "has no option CAMBER_SERVER")):
            self.write_packages()
            with open(os.path.join(self.root, path), encoding="utf-8") as file:
                self.write(path, file.read().replace("CAMBER_WARM=OFF", option))
            self.finds(path + ":1", what)

    def test_the_changes_of_the_spec(self):
        self.write_packages()
        with open(os.path.join(self.root, "packaging/camber.spec"), encoding="utf-8") as file:
            self.write("packaging/camber.spec", file.read().replace("- 1.2.3-1", "- 1.2.2-1"))
        self.finds("packaging/camber.spec:1", "the version is 1.2.2")

    # ---- The program ----

    def test_program(self):
        program = [sys.executable, lint_tree.__file__]
        clean = subprocess.run(program + [self.root], capture_output=True, text=True)
        self.assertEqual((clean.returncode, clean.stdout), (0, ""), clean.stderr)
        self.write("bench/prowl.c", HEAD)
        broken = subprocess.run(program + [self.root], capture_output=True, text=True)
        self.assertEqual((broken.returncode, broken.stdout),
                         (1, "bench/prowl.c:1: the file is called prowl: rename it: neighbour walk\n"))
        self.assertEqual(subprocess.run(program, capture_output=True).returncode, 1)

    def test_program_hints(self):
        program = [sys.executable, lint_tree.__file__]
        self.write("bench/bench.c", "/* It is drawn anew. */\n")
        counted = subprocess.run(program + [self.root], capture_output=True, text=True)
        self.assertEqual(counted.returncode, 0, counted.stderr)
        self.assertRegex(counted.stdout, r"\Ahint: .*: 1; .*--hints.*\n\Z")
        listed = subprocess.run(program + ["--hints", self.root], capture_output=True, text=True)
        self.assertEqual((listed.returncode, listed.stdout), (0, 'hint: bench/bench.c:1: "anew": say "again"\n'),
                         listed.stderr)
        self.write("bench/prowl.c", HEAD)
        self.assertEqual(subprocess.run(program + ["--hints", self.root], capture_output=True).returncode, 1)


if __name__ == "__main__":
    unittest.main()
