#!/usr/bin/env python3
"""Compares what camber declares of OpenCL, GLES and EGL with Khronos' headers, so that a build needs none of those.

    declarations.py ROOT CC

For each header a C file is made that includes Khronos' headers and asserts each value, each type of numbers and the
type of each function. A wrong value and a wrong parameter, put in on purpose, must not compile. Exit status: 1 if
something differs; 77 (skipped) if the headers are not here.
"""

import os
import re
import subprocess
import sys
import tempfile

# Our header; Khronos' headers; the prefix of the functions in our table.
HEADERS = [
    ("src/gpu/opencl/cl.h", ["CL/cl.h", "CL/cl_gl.h"], "cl"),
    ("src/gl/gl.h", ["GLES3/gl32.h", "GLES2/gl2ext.h"], "gl"),
    ("src/gl/egl.h", ["EGL/egl.h", "EGL/eglext.h"], "egl"),
]
# Khronos declares these otherwise: the function's pointer, for which ours has a name.
OWN_TYPES = {
    "camber_cl_told": "void (*)(const char *, const void *, size_t, void *)",
    "camber_cl_built": "void (*)(cl_program, void *)",
    "camber_function *": "__eglMustCastToProperFunctionPointerType",
}
VALUE = re.compile(r"^#define ((?:CL|GL|EGL)_\w+) (.+)$", re.M)
NUMBER = re.compile(r"^typedef ([\w ]+?) ((?:cl_|GL|EGL)\w+);$", re.M)
ROW = re.compile(r"X\(([^,()]+), (\w+), \((.*?)\)\)(?=\s*(?:X\(|\n|$))", re.S)


def assertions(text, prefix):
    """Yields lines of C that hold if the text of our header says what Khronos' headers say."""
    text = re.sub(r"[ \t]*\\\n[ \t]*", " ", text)
    for name, value in VALUE.findall(text):
        if not name.endswith("_H"):
            yield f'_Static_assert({name} == ({value}), "{name}");'
    for kind, name in NUMBER.findall(text):
        if not kind.startswith("struct"):
            yield f'_Static_assert(_Generic(({name})0, {kind}: 1, default: 0), "{name}");'
    for result, name, parameters in ROW.findall(text):
        row = f"{result} (*)({parameters})"
        for ours, theirs in OWN_TYPES.items():
            row = row.replace(ours, theirs)
        yield f'_Static_assert(_Generic(&{prefix}{name}, {row}: 1, default: 0), "{prefix}{name}");'


def compiles(compiler, headers, lines):
    """Returns whether the lines compile after the headers, and what the compiler says."""
    with tempfile.NamedTemporaryFile("w", suffix=".c") as file:
        file.write("#define CL_TARGET_OPENCL_VERSION 120\n#include <stddef.h>\n#include <stdint.h>\n")
        file.write("".join(f"#include <{header}>\n" for header in headers) + "\n".join(lines) + "\n")
        file.flush()
        run = subprocess.run([compiler, "-std=c11", "-fsyntax-only", "-Wno-deprecated-declarations", file.name],
                             capture_output=True, text=True, check=False)
        return run.returncode == 0, run.stderr


def main(root, compiler):
    status = 0
    for path, headers, prefix in HEADERS:
        if not compiles(compiler, headers, [])[0]:
            print(f"{' '.join(headers)} cannot be included (Debian: opencl-c-headers, libegl-dev, libgles-dev): skipped")
            return 77
        with open(os.path.join(root, path), encoding="utf-8") as file:
            text = file.read()
        lines = list(assertions(text, prefix))
        rows = len(re.findall(r"^    X\(", text, re.M))
        if sum("(*)(" in line for line in lines) != rows or not rows:
            print(f"{path}: not each of {rows} functions is understood")
            status = 1
        same, said = compiles(compiler, headers, lines)
        if not same:
            print(f"{path}: not what Khronos' headers say:\n" + said)
            status = 1
        # The compiler must refuse what this test is for: another value, and a function with one parameter more.
        value = next(line for line in lines if "== (" in line)
        row = next(line for line in lines if "_Generic(&" in line and "(void)" not in line)
        for right, wrong in ((value, value.replace("== (", "== 1 + (")), (row, row.replace("): 1", ", char): 1"))):
            if right == wrong or compiles(compiler, headers, [wrong])[0]:
                print(f"{path}: this is wrong, and compiles: {wrong}")
                status = 1
        print(f"{path}: {len(lines)} declarations")
    return status


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
