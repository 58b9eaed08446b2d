"""Behaviours of the library, played one after another on a running stack, for the demonstration and the film."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from .demo_support import Stack, Table

LIMIT = 600.0
"""s of simulated time that a behaviour may take."""
FALLEN_BELOW = 0.2
"""m, of the torso of a robot that should stand."""
SITTING = "sit_and_rest"


@dataclass(frozen=True)
class Turn:
    """A behaviour of the show.

    Attributes:
        name: Its name.
        parameters: name=value each.
        length: About how long it takes on a stack of the demonstration, s.
    """

    name: str
    parameters: Sequence[str] = field(default_factory=tuple)
    length: int = 5

    @property
    def title(self) -> str:
        return self.name.replace("_", " ")


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
"""All that are bundled."""


class BehaviorPlayer:
    """Client of the server NaoBehavior of a stack that this program has joined.

    Args:
        stack: The running stack.
        table: Gets what was asked, what the robot did, and whether that is good.
    """

    def __init__(self, stack: Stack, table: Table) -> None:

        from nao_library_actions.msg import NaoBehaviorAction
        from nao_library_msgs.srv import GetTruepose

        self._table = table
        self._client = stack.client("NaoBehavior", NaoBehaviorAction)
        self._pose = stack.service("get_truepose", GetTruepose)

    def play(self, turn: Turn) -> None:
        """Play one to its end."""
        error, late = self.run(turn)
        height = self._pose().pose.pose.pose.position.z
        stands = height > FALLEN_BELOW or turn.name == SITTING
        report = f"{late * 1000.0:.0f} ms late at most, torso at {height:.2f} m"
        self._table.add(f"behaviour {turn.name}", f"{report}; {error}" if error else report, not error and stands)

    def run(self, turn: Turn) -> tuple[str, float]:
        """Run one; returns what was wrong, empty if nothing was, and by how much a step was late at most, s."""
        import rospy
        from actionlib_msgs.msg import GoalStatus

        from nao_library_actions.msg import NaoBehaviorGoal
        from nao_library_msgs.msg import BehaviorFunction

        function = BehaviorFunction(function="runBehavior", str_param=turn.name, parameters=list(turn.parameters))
        self._client.send_goal(NaoBehaviorGoal([function]))
        if not self._client.wait_for_result(rospy.Duration(LIMIT)):
            self._client.cancel_goal()
            return f"no result within {LIMIT:g} s", 0.0
        result: Any = self._client.get_result()
        late = max((step.late for step in result.steps), default=0.0)
        state = self._client.get_state()
        if state == GoalStatus.SUCCEEDED:
            return "", late
        return f"{GoalStatus.to_string(state)} {self._client.get_goal_status_text()}", late
