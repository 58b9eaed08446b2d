"""The ten behaviours that come with the library, played one after another and filmed, for the demonstration."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from nao_library_modules.processes.own_stack import OwnStack

from .contact_sheet import Part, contact_sheet, save_small
from .demo_support import SPEED

FILM, SHEET = "behaviors.mp4", "behaviors.png"
SIZE, RATE, VIEW = 300, 10.0, "stage"
"""Of the film: pixels each way, pictures a second, from where."""
START_LIMIT = 120.0
"""s of wall time for the servers to come up."""
LIMIT = 600.0
"""s of wall time that a behaviour may take: time waits for the film when the computer is slow."""
FALLEN_BELOW = 0.2
"""m, of the torso of a robot that should stand."""
SITTING = "sit_and_rest"


@dataclass(frozen=True)
class Turn:
    """A behaviour of the show.

    Attributes:
        name: Its name.
        parameters: name=value each.
    """

    name: str
    parameters: Sequence[str] = field(default_factory=tuple)


TURNS = (
    Turn("hello"),
    Turn("introduce_yourself"),
    Turn("nod"),
    Turn("shake_head"),
    Turn("look_around", ("speed=1.2",)),
    Turn("count_to_ten", ("pause=0",)),
    Turn("tai_chi", ("speed=1.2",)),
    Turn("dance"),
    Turn("bow"),
    Turn(SITTING),
)
"""All ten."""

Report = Callable[[str, str, bool], None]


class BehaviorShow:
    """Client of a stack of its own, in which time waits for the film to be drawn.

    Args:
        output: Folder for film, sheet and log.
    """

    def __init__(self, output: Path) -> None:
        self._output = output
        self._stack = OwnStack(
            output / "behaviors.log",
            {"record_dir": str(output), "speed": SPEED, "driver": "false", "cameras": "false"},
        )

    def __enter__(self) -> BehaviorShow:
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.stop()

    def play(self, report: Report) -> list[Part]:
        """Play and film all of them; leaves film and sheet.

        Args:
            report: Gets what was asked, what the robot did, and whether that is good.

        Returns:
            Where in the film each of them is.
        """
        self._stack.wait_for_robot()
        os.environ["ROS_MASTER_URI"] = self._stack.master_uri
        client = self._client()
        world = _World()
        # When it is over, the server of behaviours has found those that it needs.
        self._run(client, Turn("nod", ("times=1",)))
        world.start_film()
        began, parts = world.time(), []
        for turn in TURNS:
            world.caption_film(turn.name.replace("_", " "))
            begin = world.time() - began
            end, late = self._run(client, turn)
            parts.append(Part(turn.name.replace("_", " "), begin, world.time() - began))
            height = world.height()
            stands = height > FALLEN_BELOW or turn.name == SITTING
            told = f"{parts[-1].end - begin:.1f} s, {late * 1000.0:.0f} ms late at most, torso at {height:.2f} m"
            report(f"behaviour {turn.name}", told if not end else f"{told}; {end}", not end and stands)
        film = world.stop_film()
        save_small(contact_sheet(self._output / FILM, parts), self._output / SHEET)
        told = f"{film.frames} pictures, {film.length.to_sec():.0f} s, with sound; {SHEET} has six of each"
        report(f"film {FILM}", told, film.frames > 0)
        return parts

    def _client(self) -> Any:
        import actionlib
        import rospy

        from nao_library_actions.msg import NaoBehaviorAction

        rospy.init_node("nao_library_behavior_show", disable_signals=True)
        client = actionlib.ActionClient("NaoBehavior", NaoBehaviorAction)
        # On the wall clock: simulated time may run so fast that a node is not up within much of it.
        give_up = time.monotonic() + START_LIMIT
        while not client.wait_for_server(rospy.Duration(10.0)):
            if not self._stack.alive() or time.monotonic() > give_up:
                raise RuntimeError(f"the server NaoBehavior did not come up; see {self._stack.log}")
        rospy.wait_for_service("nao_sim/film/start", START_LIMIT)  # the last thing that the simulator does
        return client

    @staticmethod
    def _run(client: Any, turn: Turn) -> tuple[str, float]:
        """Run one; returns what was wrong, empty if nothing was, and by how much a step was late at most, s."""
        import actionlib
        from actionlib_msgs.msg import GoalStatus

        from nao_library_actions.msg import NaoBehaviorGoal
        from nao_library_msgs.msg import BehaviorFunction

        function = BehaviorFunction(function="runBehavior", str_param=turn.name, parameters=list(turn.parameters))
        over = threading.Event()

        def changed(goal: Any) -> None:
            if goal.get_comm_state() == actionlib.CommState.DONE:
                over.set()

        goal = client.send_goal(NaoBehaviorGoal([function]), changed)
        if not over.wait(LIMIT):
            goal.cancel()
            return f"no result within {LIMIT:g} s", 0.0
        late = max((step.late for step in goal.get_result().steps), default=0.0)
        state = goal.get_terminal_state()
        if state == GoalStatus.SUCCEEDED:
            return "", late
        return f"{GoalStatus.to_string(state)} {goal.get_goal_status_text()}", late


class _World:
    """What only a simulator can do, by its services."""

    def __init__(self) -> None:
        import rospy

        from nao_library_msgs.srv import CaptionFilm, GetTruepose, StartFilm, StopFilm

        self.time = rospy.get_time
        self._start = rospy.ServiceProxy("nao_sim/film/start", StartFilm)
        self._caption = rospy.ServiceProxy("nao_sim/film/caption", CaptionFilm)
        self._stop = rospy.ServiceProxy("nao_sim/film/stop", StopFilm)
        self._pose = rospy.ServiceProxy("get_truepose", GetTruepose)

    def start_film(self) -> None:
        _require(self._start(FILM, VIEW, SIZE, SIZE, RATE))

    def caption_film(self, text: str) -> None:
        _require(self._caption(text))

    def stop_film(self) -> Any:
        return _require(self._stop())

    def height(self) -> float:
        """Of the torso over the floor, m."""
        return self._pose().pose.pose.pose.position.z


def _require(answer: Any) -> Any:
    if not answer.success:
        raise RuntimeError(answer.message)
    return answer
