"""Suites as users write theirs, run as users run them: `rostest nao_library_tests lights.test`."""

from __future__ import annotations

import os
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
from named_port import named_port

FOLDER = Path(__file__).parents[1] / "rostest"
ROSTEST = (sys.executable, "-c", "import rostest; rostest.rostestmain()")
"""rostest, but with the interpreter that runs this file: its program would put another one first."""
LIMIT = 1500.0
ROS = FOLDER.parent / "ros"


def shown_elsewhere(suite):
    """Whether all tests of a suite are run in the level ros as well, by its running stack."""
    return all((ROS / test.get("type")).exists() for test in ElementTree.parse(suite).getroot().iter("test"))


@pytest.mark.timeout(LIMIT + 60.0)
@pytest.mark.parametrize(
    "suite",
    [
        pytest.param(path.stem, marks=[pytest.mark.long] * shown_elsewhere(path))
        for path in sorted(FOLDER.glob("*.test"))
    ],
)
def test_a_suite_of_rostest_passes(suite, tmp_path):
    environment = {name: value for name, value in os.environ.items() if name not in ("ROS_MASTER_URI", "ROS_NAMESPACE")}
    environment.update(
        ROS_MASTER_URI="http://127.0.0.1:11311",  # rostest takes a port of its own
        ROS_TEST_RESULTS_DIR=str(tmp_path),
        ROS_LOG_DIR=str(tmp_path / "log"),
        ROS_HOME=str(tmp_path / "home"),
        NAO_PORT=str(named_port()),  # what the suites start themselves is killed and started again there
    )
    file = FOLDER / f"{suite}.test"
    output = tmp_path / "output.txt"
    with output.open("wb") as out:
        done = subprocess.run(
            [*ROSTEST, str(file)], env=environment, stdout=out, stderr=subprocess.STDOUT, timeout=LIMIT, check=False
        )
    text = output.read_text(errors="replace")
    assert done.returncode == 0, text[-8000:]
    # rostest says OK of a test whose process died: what counts is what each test has left.
    wanted = {test.get("test-name") for test in ElementTree.parse(file).getroot().iter("test")}
    results = {path.stem.replace("rosunit-", ""): path for path in tmp_path.rglob("rosunit-*.xml")}
    assert wanted <= set(results), text[-8000:]
    for name in wanted:
        root = ElementTree.parse(results[name]).getroot()
        assert int(root.get("tests")) > 0 and root.get("failures") == root.get("errors") == "0", name
