"""What a part of the driver gets: the robot over a libqi connection that can be cut, and its time as a clock."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from types import SimpleNamespace

import pytest

from nao_library_modules.core.robot import Robot

PATIENCE = 60.0


@pytest.fixture
def until(robot, eventually):
    """Lets simulated time pass, little by little, until something comes about.

    The parts of the driver have threads of their own. When `limit` s have passed, a busy computer may still keep one
    from what it does: time goes on slowly then.
    """

    def wait(condition, limit=10.0, step=0.05):
        pause, end = threading.Event(), robot.now.time + limit
        while robot.now.time < end:
            if condition():
                return
            robot.advance(step)
            pause.wait(0.004)
        eventually(lambda: condition() or robot.advance(0.01) < 0.0, f"what should within {limit} s of simulated time")

    return wait


@pytest.fixture
def begin():
    """Runs a function in a thread; gives the future of what it returns."""

    def start(function, *arguments):
        pool = ThreadPoolExecutor(1)
        future = pool.submit(function, *arguments)
        pool.shutdown(wait=False)
        return future

    return start


@pytest.fixture
def clock(robot):
    """Simulated time, as the parts of the driver wait for it."""
    return SimpleNamespace(now=robot.lockstep.time, wait=robot.lockstep.wait)


@pytest.fixture
def driver_robot(robot):
    """The robot as the driver has it; `lose` cuts its connection, which it then makes anew."""
    driver = Robot(*robot.address)
    connection = driver.connection
    connection.connect(PATIENCE)

    def lose():
        lost, generation = threading.Event(), connection.generation
        listener = lambda state: lost.set() if state == "lost" else None  # noqa: E731
        connection.add_listener(listener)
        connection.live.session.close()
        assert lost.wait(PATIENCE) and connection.wait_connected(PATIENCE)
        connection.remove_listener(listener)
        assert connection.generation == generation + 1

    driver.lose = lose
    return driver


@pytest.fixture
def closing(robot):
    """Closes parts of the driver when the test is over, while time passes: `closing(Walker(...), 1.0)`."""
    made = []

    def keep(part, *limit):
        made.append((part, limit))
        return part

    yield keep
    for part, limit in reversed(made):
        thread = threading.Thread(target=part.close, args=limit)
        thread.start()
        while thread.is_alive():
            robot.advance(0.05)
            thread.join(0.005)
