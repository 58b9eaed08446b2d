"""What is swept: a behaviour, or the program of a plan. Both run on the stack of a worker and tell how they ended."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any, ClassVar, Protocol

LATE = "late"
"""State of what had to be ended, for its limit was over."""
SERVER_LIMIT = 60.0
"""s until the server of behaviours must have reached the robot."""


@dataclass(frozen=True)
class Outcome:
    """How a run ended. `duration`: s of simulated time."""

    state: str  # succeeded, aborted, failed, ..; LATE
    text: str
    duration: float


class Subject(Protocol):
    """Something that runs on a stack.

    Attributes:
        launch: Arguments of nao_sim.launch that it needs.
        memory: MiB of a worker with such a stack.
    """

    launch: ClassVar[Mapping[str, str]]
    memory: ClassVar[float]

    def connect(self, robot: Any) -> Any:
        """What it needs of a stack that has just come up; handed to each `run` there. `robot`: `SimulatedRobot`."""

    def run(self, link: Any, parameters: Mapping[str, Any], limit: float, begun: Callable[[], None]) -> Outcome:
        """Run it to its end.

        Args:
            link: What `connect` has answered.
            parameters: Values by name, of those that are swept.
            limit: s of this computer that it may take.
            begun: To be called when it begins, from any thread; of several calls the first counts.
        """


@dataclass(frozen=True)
class BehaviorGoal:
    """A behaviour, stored as `name`, or written in `text`. `file`: what the text was read from."""

    name: str = ""
    text: str = ""
    file: str = ""
    launch: ClassVar[Mapping[str, str]] = MappingProxyType({"driver": "false"})  # the action servers alone
    memory: ClassVar[float] = 750.0

    def connect(self, robot: Any) -> Any:
        from nao_library_actions.msg import NaoBehaviorAction

        return robot.action_client("NaoBehavior", NaoBehaviorAction, SERVER_LIMIT)

    def run(self, link: Any, parameters: Mapping[str, Any], limit: float, begun: Callable[[], None]) -> Outcome:
        import rospy
        from actionlib_msgs.msg import GoalStatus

        from nao_library_actions.msg import NaoBehaviorGoal
        from nao_library_msgs.msg import BehaviorFunction
        from nao_sim_bridge.testing import StackNotReady, send

        given = [f"{name}={value}" for name, value in parameters.items()]
        which = {"text": self.text, "file": self.file} if self.text else {"str_param": self.name}
        goal = send(link, NaoBehaviorGoal([BehaviorFunction(function="runBehavior", parameters=given, **which)]))
        begun()
        try:
            goal.wait(limit)
        except StackNotReady:
            late = f"not done within {limit:g} s of this computer"
            return Outcome(LATE, late, rospy.get_time() - goal.sent)
        return Outcome(GoalStatus.to_string(goal.state).lower(), goal.text, goal.ended - goal.sent)


@dataclass(frozen=True)
class PlanProgram:
    """The program of a plan: it takes `--trace FILE`, as `project` wants it. None of its arguments is swept."""

    program: Path
    arguments: Sequence[str] = ()
    launch: ClassVar[Mapping[str, str]] = MappingProxyType({})
    memory: ClassVar[float] = 1000.0

    def connect(self, robot: Any) -> None:
        pass

    def run(self, link: Any, parameters: Mapping[str, Any], limit: float, begun: Callable[[], None]) -> Outcome:
        import rosgraph
        import rospy

        from nao_library_msgs.msg import PlanTree

        from ..process_modules.plan_runner import TOPIC
        from ..process_modules.projection import ProjectionFailed, ProjectionLate, run_program

        before = rospy.get_time()
        seen = rospy.Subscriber(TOPIC, PlanTree, lambda _: begun())
        try:
            with tempfile.TemporaryDirectory(prefix="nao_sweep_") as folder:
                trace = run_program(self.program, self.arguments, rosgraph.get_master_uri(), Path(folder), limit)
        except ProjectionFailed as failed:
            state = LATE if isinstance(failed, ProjectionLate) else "failed"
            return Outcome(state, str(failed), rospy.get_time() - before)
        finally:
            seen.unregister()
        plan = trace.records[0]
        return Outcome(plan.state, plan.failure, (plan.ended or 0.0) - (plan.began or 0.0))
