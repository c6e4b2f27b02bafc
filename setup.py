"""The parts of the build that pyproject.toml cannot describe: the extension that cffi makes from the C headers, and the
C library and the tool where none is installed."""

import os
import sys

from setuptools import setup

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "python"))
import build_inside  # noqa: E402

inside = build_inside.is_wanted()
os.makedirs("build/python", exist_ok=True)  # beside what CMake builds
setup(cffi_modules=["python/build_library.py:builder"], cmdclass={"build_ext": build_inside.BuildInside} if inside else {},
      scripts=["python/tool/camber"] if inside else [],
      options={"build": {"build_base": "build/python"}, "egg_info": {"egg_base": "build/python"},
               "bdist_wheel": {"py_limited_api": "cp39"}})  # cffi keeps to the stable ABI
