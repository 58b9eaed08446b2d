"""A simulator that is stopped and goes on in the midst of goals of every kind, and one that is killed meanwhile."""

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from xmlrpc.client import ServerProxy

import pytest
import rosgraph

from nao_library_modules.ros.own_stack import OwnStack

pytestmark = pytest.mark.timeout(300)
USER = Path(__file__).resolve().parents[1] / "support/every_goal.py"
KINDS = {"lights", "audio out", "audio in", "motion", "vision", "behaviour and touch", "joints"}
SILENCES = 1.0, 3.0, 8.0
"""s for which the simulator is stopped; its clients wait for up to 10."""


class User:
    """The program `every_goal.py`."""

    def __init__(self, port):
        command = [sys.executable, str(USER), str(port)]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def say(self, word):
        """Say something; the answer, as lines."""
        if word:
            self.process.stdin.write(f"{word}\n")
            self.process.stdin.flush()
        return list(iter(lambda: self.process.stdout.readline().rstrip("\n"), "over"))


@pytest.fixture
def own_stack(tmp_path, monkeypatch):
    for name in ("ROS_HOME", "ROS_LOG_DIR"):
        monkeypatch.setenv(name, str(tmp_path))
    folders = {name: str(tmp_path / name) for name in ("record_dir", "motion_dir", "behavior_dir")}
    with OwnStack(tmp_path / "stack.txt", folders) as own_stack:
        own_stack.wait_for_robot()
        monkeypatch.setenv("ROS_MASTER_URI", own_stack.master_uri)
        yield own_stack


@pytest.fixture
def user(own_stack):
    user = User(own_stack.nao_port)
    yield user
    user.process.kill()
    user.process.communicate()


def test_goals_of_every_kind_outlive_a_silent_robot_and_fail_at_once_with_one_that_is_gone(own_stack, user):
    user.say("")
    node = rosgraph.Master("/test", own_stack.master_uri).lookupNode("/nao_sim")
    simulator = ServerProxy(node).getPid("/test")[2]
    for seconds in SILENCES:
        assert set(user.say("go")) == KINDS
        os.kill(simulator, signal.SIGSTOP)
        time.sleep(seconds)
        os.kill(simulator, signal.SIGCONT)
        assert set(user.say("touch")) == {f"{kind}: SUCCEEDED " for kind in KINDS}, seconds
    assert set(user.say("go")) == KINDS
    os.kill(simulator, signal.SIGKILL)
    killed = time.monotonic()
    for end in user.say("wait"):
        assert re.search(f"ABORTED .*127.0.0.1:{own_stack.nao_port}.*(went away|connection)", end), end
    print(f"goals with a robot that is gone fail within {time.monotonic() - killed:.2f} s")
    log = own_stack.log.read_text(errors="replace")
    assert "calls wait for it" in log and "answers again" in log and "Traceback" not in log
