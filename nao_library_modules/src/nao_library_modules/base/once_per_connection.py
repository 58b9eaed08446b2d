"""What is asked of the robot once, and again when another one may be behind the connection. No ROS."""

from __future__ import annotations

from typing import Any, Callable, Generic, Tuple, TypeVar

Answer = TypeVar("Answer")


class OncePerConnection(Generic[Answer]):
    """An answer of the robot, asked for when it is first needed and again after each reconnection.

    Any thread may ask; at worst two ask the robot at the same time.
    """

    def __init__(self, robot: Any, read: Callable[[], Answer]) -> None:
        self._connection = robot.connection
        self._read = read
        self._known: Tuple[int, Answer] | None = None

    def __call__(self) -> Answer:
        generation = self._connection.generation
        known = self._known
        if known is None or known[0] != generation:
            known = self._known = (generation, self._read())
        return known[1]
