"""The part of the build that pyproject.toml cannot describe: the extension that cffi makes from the C headers."""

import os

from setuptools import setup

os.makedirs("build/python", exist_ok=True)  # beside what CMake builds
setup(cffi_modules=["python/build_library.py:builder"],
      options={"build": {"build_base": "build/python"}, "egg_info": {"egg_base": "build/python"},
               "bdist_wheel": {"py_limited_api": "cp39"}})  # cffi keeps to the stable ABI
