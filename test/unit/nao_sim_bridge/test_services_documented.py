"""The simulator's ROS services in docs/simulator.md: all of them, with their types, and an example that fits."""

from __future__ import annotations

import ast
import importlib
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
DOCUMENT = (ROOT / "docs" / "simulator.md").read_text(encoding="utf-8")
SOURCES = sorted((ROOT / "nao_sim_bridge" / "src" / "nao_sim_bridge").glob("ros_*.py"))
ROW = re.compile(r"^\| `(?:nao_sim/)?(?P<name>[a-z_/]+)` \| (?:\[)?`(?P<package>\w+)/(?P<type>\w+)`", re.MULTILINE)
MAKERS = ("rospy.Service", "success_service")
DOCUMENTED = {match["name"]: (match["package"], match["type"]) for match in ROW.finditer(DOCUMENT)}


def offered():
    """Name -> class of the services in the code: first and second argument of the calls that make them."""
    found = {}
    for path in SOURCES:
        source = path.read_text(encoding="utf-8")
        for call in ast.walk(ast.parse(source)):
            if isinstance(call, ast.Call) and ast.get_source_segment(source, call.func) in MAKERS:
                name, kind = (ast.get_source_segment(source, argument) for argument in call.args[:2])
                if '"' in name:  # the helper passes on a variable
                    found[re.sub(r'^f?"(~|\{\w+\})?|"$', "", name)] = kind
    return found


def test_every_service_stands_there_with_its_type():
    services = offered()
    assert len(services) > 15
    assert {name: kind for name, (_, kind) in DOCUMENTED.items()} == services


@pytest.mark.parametrize("name", sorted(DOCUMENTED))
def test_the_type_is_in_the_package_that_is_told(name):
    package, kind = DOCUMENTED[name]
    assert hasattr(importlib.import_module(f"{package}.srv"), f"{kind}Request")


def test_the_example_fits_the_types():
    example = ast.parse(re.search(r"```python\n(.*?)```", DOCUMENT, re.DOTALL)[1])
    kinds = {
        alias.name: getattr(importlib.import_module(statement.module), alias.name)
        for statement in example.body
        if isinstance(statement, ast.ImportFrom)
        for alias in statement.names
    }
    assert {"AdvanceTime", "PushRobot", "TouchSensors"} <= set(kinds)
    calls = [call for call in ast.walk(example) if isinstance(call, ast.Call) and isinstance(call.func, ast.Name)]
    (fields,) = [{keyword.arg for keyword in call.keywords} for call in calls if call.func.id == "push"]
    assert fields == set(kinds["PushRobot"]._request_class.__slots__)
