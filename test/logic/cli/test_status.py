"""What `nao status` says of a robot that does not answer for the moment."""

from types import SimpleNamespace

import pytest
from diagnostic_msgs.msg import DiagnosticStatus, KeyValue

from nao_library_modules.cli.commands.server_commands import LEVELS, silent_robots, status_lines
from nao_library_modules.core.health import connection_report
from naoqi.limits import Timing

ADDRESS = "10.0.0.7:9559"


def told_by_a_node(silent):
    facts = {"state": "connected", "latency": 0.002, "generation": 1, "last_error": ""}
    report = connection_report(ADDRESS, SimpleNamespace(silent=silent, timing=Timing(), **facts))
    return DiagnosticStatus(message=report.message, values=[KeyValue(*each) for each in report.values.items()])


def test_a_robot_is_silent_that_a_node_says_so_of():
    others = DiagnosticStatus(message="runs", values=[KeyValue("state", "running")])
    assert silent_robots([others, told_by_a_node(0.0)]) == {}
    assert silent_robots([others, told_by_a_node(4.2)])[ADDRESS].startswith("silent: goals and calls wait")


@pytest.mark.parametrize(
    "silent, connected, told", [("no answer", False, "SILENT"), ("", True, "connected"), ("", False, "NOT REACHED")]
)
def test_the_first_line_tells_how_the_robot_is(silent, connected, told):
    unknown = dict.fromkeys(("battery", "posture", "stiffness", "awake"))
    reports = {**dict.fromkeys(LEVELS, 0), "problems": []}
    found = {"robot": "/", "address": ADDRESS, "master": "here", "servers": {}, "diagnostics": reports, **unknown}
    found["nodes"] = {"nao_driver": ["nao_controller", "nao_speech"]}
    lines = list(status_lines({**found, "silent": silent, "connected": connected}))
    assert "  nao_driver  nao_controller, nao_speech" in lines
    assert lines[0].endswith(f"/ at {ADDRESS}, {told}")
    assert any(line.endswith("no answer") for line in lines) is bool(silent)
