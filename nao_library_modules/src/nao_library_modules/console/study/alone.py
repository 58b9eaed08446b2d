"""Studies without a console, for programs."""

from __future__ import annotations

from typing import Any

from .files import StudyFiles
from .studies import Studies


def studies_alone(files: StudyFiles, name: str = "") -> tuple[Studies, Any]:
    """Studies and the `RobotClient` of a robot. The program is a node already.

    `name`: of the robot; empty: the first. Raises NotThere if there is none.
    """
    from ..robots.robots import Robots
    from ..view.views import Views

    views = Views(files.folder)
    studies = Studies(files, lambda robot: views.of(robot).senses.acquire(), lambda robot: views.of(robot).alarms)
    return studies, Robots().robot(name)
