"""LogManager: programs read the log of the robot, and write into it."""

import logging
import queue

import pytest
from simulator import PATIENCE

FIELDS = ["category", "date", "id", "level", "location", "message", "source", "systemDate"]
ERROR, INFO, DEBUG = 2, 4, 6


@pytest.fixture
def listener(robot):
    listener = robot.LogManager.createListener()
    yield listener
    listener.clearFilters()
    listener.setLevel(INFO)


@pytest.fixture
def told(listener):
    """What a listener is told, in order."""
    messages = queue.Queue()
    listener.onLogMessage.connect(messages.put)
    return lambda: messages.get(timeout=PATIENCE)


def test_a_listener_is_told_the_log_of_the_simulator_and_of_programs(robot, told):
    logging.getLogger("nao_sim.test").error("no %s", "way")
    message = told()
    assert sorted(message) == FIELDS
    assert (message["level"], message["category"], message["message"]) == (ERROR, "nao_sim.test", "no way")
    _, _, line = message["source"].split(":")  # file and function before it, as programs take it apart
    assert int(line) > 0
    robot.ALLogger.error("Game", "lost")
    message = next(message for message in iter(told, None) if message["category"] == "Game")
    assert (message["level"], message["category"], message["message"]) == (ERROR, "Game", "lost")


def test_what_a_program_logs_is_told_as_it_is_and_is_in_the_log(robot, told, caplog):
    sent = ("game.cpp:play:7", INFO, "game", "robot:1", "over", 0, 1, 2)
    robot.LogManager.log([sent])
    message = told()
    assert {**message, "id": 0} == dict(
        zip(("source", "level", "category", "location", "message", "id", "date", "systemDate"), sent)
    )
    assert "game: over" in [record.getMessage() for record in caplog.records]


def test_levels_and_filters_are_those_of_the_listener(robot, listener, told):
    listener.setLevel(ERROR)
    listener.addFilter("Game*", DEBUG)
    robot.ALLogger.setVerbosity("debug")
    for module, write in (("Noise", robot.ALLogger.warn), ("GameOver", robot.ALLogger.debug)):
        write(module, "heard")
    assert told()["category"] == "GameOver"
    listener.clearFilters()
    robot.ALLogger.warn("GameOver", "not heard")
    robot.ALLogger.error("Noise", "heard")
    assert told()["category"] == "Noise"


def test_a_program_that_writes_is_told_what_is_wanted_until_it_leaves(robot, listener):
    levels, filters = queue.Queue(), queue.Queue()

    class Provider:
        def setLevel(self, level):
            levels.put(level)

        def setFilters(self, wanted):
            filters.put(wanted)

    def told():
        return levels.get(timeout=PATIENCE), filters.get(timeout=PATIENCE)

    number = robot.LogManager.addProvider(Provider())
    assert told() == (INFO, [])
    listener.addFilter("Game*", DEBUG)
    assert told() == (INFO, [("Game*", DEBUG)])
    robot.LogManager.removeProvider(number)
    listener.setLevel(ERROR)
    with pytest.raises(RuntimeError, match=f"there is no provider {number}"):
        robot.LogManager.removeProvider(number)
    assert levels.empty() and filters.empty()
