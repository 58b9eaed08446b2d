"""What nao_walker tells about itself."""

from __future__ import annotations

import pytest

from nao_library_modules.driver.walk_report import WalkJournal
from nao_library_modules.health import Level


@pytest.fixture
def journal():
    return WalkJournal()


def test_it_tells_what_was_commanded_and_what_the_robot_does(journal):
    journal.commanded("cmd_vel from /stick", 10.0)
    journal.succeeded()
    report = journal.report(10.5, "walks at (0.5, 0, 0)", True, [], 2)
    assert (report.level, report.message) == (Level.OK, "walks")
    assert report.values["last command"] == "cmd_vel from /stick"
    assert report.values["last command (s ago)"] == "0.5"
    assert report.values["stopped because commands ceased"] == "2"


def test_it_tells_who_inhibits(journal):
    report = journal.report(0.0, "nothing", False, ["/path", "/me"], 0)
    assert (report.level, report.message) == (Level.OK, "stands, inhibited by /path, /me")


def test_a_failure_is_a_warning_until_a_command_succeeds(journal):
    journal.failed("cmd_vel", ValueError("limp"))
    report = journal.report(0.0, "nothing", None, [], 0)
    assert (report.level, report.message) == (Level.WARN, "unknown; cmd_vel: limp")
    journal.succeeded()
    report = journal.report(0.0, "nothing", False, [], 0)
    assert (report.level, report.values["last failure"]) == (Level.OK, "cmd_vel: limp")


def test_the_log_tells_each_thing_once_in_a_while(journal, caplog):
    for _ in range(5):
        journal.failed("cmd_vel", ValueError("limp"))
        journal.failed("cmd_pose", ValueError("fallen"))
        journal.warn("range", "clamped")
    assert [record.getMessage() for record in caplog.records] == ["cmd_vel: limp", "cmd_pose: fallen", "clamped"]
    assert journal.report(0.0, "nothing", None, [], 0).values["commands that failed"] == "10"
