"""Studies without a console, for programs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from .files import StudyFiles
from .studies import Studies


def studies_alone(files: StudyFiles, name: str = "") -> tuple[Studies, Any]:
    """Studies and the `RobotClient` of a robot. The program is a node already.

    `name`: of the robot; empty: the first. Raises NotThere if there is none.
    """
    from ..robots.robots import Robots

    return Studies(files, hold_senses), Robots().robot(name)


def hold_senses(robot: Any) -> Callable[[], None]:
    """Have touches, words and faces among the events of a robot; what comes back ends that."""
    from ..view.memory_topics import MemoryTopics
    from ..view.senses import Senses

    return Senses(robot, MemoryTopics(robot)).acquire()
