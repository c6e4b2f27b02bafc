"""The paths of the tool and the source tree, which tests/tool/test_python.sh sets."""

import os
import sys

import pytest

TREE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.append(os.path.join(TREE, "tests/fixtures"))


@pytest.fixture
def city():
    return os.path.join(TREE, "tests/data/santa_cruz/osm.mbtiles")


@pytest.fixture
def tool():
    path = os.environ.get("CAMBER_TOOL")
    if not path:
        pytest.skip("CAMBER_TOOL names no camber to compare with")
    return path
