"""ALLogger: messages of programs in the log of the simulator, and in files of the robot."""

import logging
import os
import re

import pytest

from nao_sim_bridge.base.sizes import load_sizes


@pytest.fixture
def logger(robot):
    return robot.ALLogger


@pytest.fixture
def logged(caplog):
    """What the log of the simulator has of programs: level and text."""
    return lambda: [(r.levelno, r.getMessage()) for r in caplog.records if r.name == "nao_sim.programs"]


def test_messages_are_in_the_log_of_the_simulator_up_to_the_verbosity(logger, logged):
    assert logger.verbosity() == 4
    logger.warn("Game", "too fast")
    logger.debug("Game", "left out")
    logger.setVerbosity("debug")
    logger.lowInfo("Game", "details")
    logger.setVerbosity("error")
    logger.info("Game", "left out")
    logger.fatal("Game", "over")
    assert logger.verbosity() == 2
    assert logged() == [
        (logging.WARNING, "Game: too fast"),
        (logging.DEBUG, "Game: details"),
        (logging.CRITICAL, "Game: over"),
    ]


def test_a_filter_gives_modules_levels_of_their_own(logger, logged):
    logger.setFilter("Game*=debug:-Noise:GameOver=error")
    for module in ("GameOn", "Noise", "GameOver", "Other"):
        logger.debug(module, "debug")
        logger.warn(module, "warning")
    assert [text for _, text in logged()] == ["GameOn: debug", "GameOn: warning", "Other: warning"]
    logger.setFilter()
    logger.warn("Noise", "again")
    assert logged()[-1] == (logging.WARNING, "Noise: again")


def test_messages_go_to_files_of_the_robot_as_long_as_they_are_wanted(robot, logger, logged):
    logger.logInFile("/home/nao/logs/game.log")
    logger.removeHandler("std")
    logger.error("Game", "first")
    logger.separator()
    logger.removeHandler("/home/nao/logs/game.log")
    logger.logInStd()
    logger.error("Game", "second")
    lines = (robot.server.files.folder / "logs" / "game.log").read_text().splitlines()
    assert len(lines) == 2 and re.fullmatch(r"\[E\] \d+\.\d{6} \d+ Game: first", lines[0])
    assert [text for _, text in logged()] == ["Game: second"]


def test_a_file_is_one_by_whatever_path_and_one_that_is_full_keeps_nothing_from_others(robot, logger):
    folder, most = robot.server.files.folder, load_sizes().kept.log_bytes
    (folder / "full.log").touch()
    os.truncate(folder / "full.log", most)
    for path in ("full.log", "game.log", "/home/nao/game.log"):
        logger.logInFile(path)
    with pytest.raises(RuntimeError, match=f"full, {most} bytes at most, and written to no more: /home/nao/full.log"):
        logger.error("Game", "first")
    logger.error("Game", "second")
    logger.removeHandler("~/game.log")
    logger.error("Game", "third")
    assert [line.split()[-1] for line in (folder / "game.log").read_text().splitlines()] == ["first", "second"]
    assert (folder / "full.log").stat().st_size == most


def test_what_cannot_be_logged_is_refused(refuses):
    refuses("ALLogger", """
        setVerbosity('loud') -> verbosity is 'loud', allowed is one of silent, fatal, error, warning, info
        setVerbosity('\N{SUPERSCRIPT TWO}') -> verbosity is
        setVerbosity(5000 * '9') -> verbosity is
        setFilter('=debug') -> filter is '=debug', allowed is module=level
        setFilter('+') -> filter is '\\+', allowed is module=level
        setFilter('Game') -> filter is 'Game', allowed is module=level, \\+module or -module
        logInSys() -> no system log: messages are in the log of the simulator
        logInForwarder('tcp://example.com:5099') -> not sent to other computers
        logInFile('std') -> file is 'std', allowed is another name
        logInFile('../game.log') -> '../game.log' is not inside
        removeHandler('game.log') -> unknown handler 'game.log'
    """)  # fmt: skip
