"""What the console knows of the ROS master."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor

import pytest
import rospy

from nao_library_modules.console.robots import robot_client as master_look
from nao_library_modules.console.robots.robot_client import Robots

LIMIT = 60.0


class SlowMaster:
    """A ROS master with one robot; answers when it is let."""

    def __init__(self):
        self.asked, self.let = threading.Event(), threading.Event()

    def getSystemState(self):  # noqa: N802  wire spelling
        self.asked.set()
        assert self.let.wait(LIMIT)
        return 1, "", ([], [["/nao1/NaoMotion/goal", ["/nao1/NaoMotion"]]], [["/nao1/NaoMotion/describe", []]])

    def getTopicTypes(self):  # noqa: N802
        return 1, "", []


@pytest.fixture
def master(monkeypatch):
    made = SlowMaster()
    monkeypatch.setattr(rospy, "get_master", lambda: made)
    yield made
    made.let.set()


def test_no_robot_is_unknown_before_the_master_has_answered_once(master, monkeypatch):
    monkeypatch.setattr(master_look, "PATIENCE", 0.0)  # for a master that has answered before
    robots = Robots()
    with ThreadPoolExecutor() as pool:
        pages = [pool.submit(robots.robot, "nao1") for _ in range(2)]
        assert master.asked.wait(LIMIT)
        master.let.set()
        assert [page.result(LIMIT).name for page in pages] == ["nao1", "nao1"]
