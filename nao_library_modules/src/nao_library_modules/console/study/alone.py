"""Studies without a console, for programs."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from .files import StudyFiles
from .runner import TrialRunner
from .studies import Studies
from .trial_watch import watch_trial

if TYPE_CHECKING:
    from ..view.views import Views


def studies_alone(files: StudyFiles, name: str = "") -> tuple[Studies, Any]:
    """Studies and the `RobotClient` of a robot. The program is a node already.

    `name`: of the robot; empty: the first. Raises NotThere if there is none.
    """
    from ..robots.robots import Robots
    from ..view.views import Views

    views = Views(files.folder)
    return studies_of(files, views), Robots().robot(name)


def studies_of(files: StudyFiles, views: Views) -> Studies:
    """Studies that log what robots sense, stops of other programs and alarms."""
    from ..robots.foreign_stops import hear_stops

    def listen(robot: Any) -> Callable[[], None]:
        deaf, leave = hear_stops(robot), views.of(robot).senses.acquire()

        def end() -> None:
            deaf()
            leave()

        return end

    def watch(runner: TrialRunner, recordings: Any) -> Callable[[], None]:
        return watch_trial(views.of(runner.robot).alarms, runner, recordings)

    return Studies(files, listen, watch)
