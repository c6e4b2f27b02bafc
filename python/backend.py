"""The build backend that pip and build call: setuptools and cffi, from the system if it has them.

An isolated build does not see packages of the system, and downloads everything that it requires. Debian's packages work
as well and need no network, so this backend also searches the system's folder, and requires only what is missing there.
"""

import importlib.util
import os
import sys

for _folder in (os.path.join(sys.base_prefix, "lib/python3/dist-packages"),
                os.path.join(sys.base_prefix, "lib/python%d.%d/site-packages" % sys.version_info[:2])):
    if os.path.isdir(_folder) and _folder not in sys.path:
        sys.path.append(_folder)


def get_requires_for_build_wheel(config_settings=None):
    return [name for name in ("setuptools", "wheel", "cffi") if importlib.util.find_spec(name) is None]


get_requires_for_build_sdist = get_requires_for_build_wheel


def build_wheel(*arguments, **settings):
    from setuptools import build_meta
    return build_meta.build_wheel(*arguments, **settings)


def build_sdist(*arguments, **settings):
    from setuptools import build_meta
    return build_meta.build_sdist(*arguments, **settings)
