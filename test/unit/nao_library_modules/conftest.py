"""Small stand-ins for the robot, the ROS node and the action server, so that goals run without either."""

from __future__ import annotations

import threading

import pytest
from fake_robot import FakeCall, FakeRobot
from fake_server import FakeEdge


@pytest.fixture
def robot():
    return FakeRobot()


@pytest.fixture
def edge():
    return FakeEdge()


@pytest.fixture
def make_call():
    return FakeCall


@pytest.fixture
def in_thread():
    """Runs a function in a thread; gives the thread, and a list that its value or error goes to."""

    def start(function, *arguments):
        outcome = []

        def run():
            try:
                outcome.append(function(*arguments))
            except Exception as error:
                outcome.append(error)

        thread = threading.Thread(target=run, daemon=True)
        thread.start()
        return thread, outcome

    return start


@pytest.fixture
def succeed(play):
    """Plays functions that succeed, and gives the result. `play`, of the module under test, gives the server."""

    def run(*functions):
        server = play(*functions)
        assert server.end == "succeeded", server.text
        return server.result

    return run


@pytest.fixture
def refused(play):
    """Plays functions that fail, and gives the text."""

    def run(*functions):
        server = play(*functions)
        assert server.end == "aborted"
        return server.text

    return run
