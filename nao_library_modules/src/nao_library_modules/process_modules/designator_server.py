"""The node process_modules: carries out designators that others send, by the process modules of a NAO."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import rospy
from std_msgs.msg import String

from nao_library_actions.msg import PerformDesignatorAction, PerformDesignatorFeedback, PerformDesignatorResult

from ..core.memory_functions import json_of
from ..core.processes import close_all
from ..core.waiting import CancellationToken
from ..core.yaml_values import Budget
from ..ros.action_server import ActionServer, ConcurrentActionServer, GoalOutcome
from .control import do, top_level
from .designators.designator import Designator, designator, read_yaml, require_short, text_budget
from .failures import PlanError, PlanFailure
from .low_level import make_process_modules, this_robot
from .nao_modules import Grip
from .process_module import perform, start_process_modules, stop_process_modules
from .tasks import Task

ACTION, TOPIC = "perform_designator", "designators"
SHUTDOWN_LIMIT = 2.0
"""s that the end of the node waits for goals, before the modules are ended with whatever they do."""


class DesignatorServer:
    """Process modules that carry out designators of other nodes.

    Goals run at the same time; modules make commands for the same limb take turns.

    ROS API (relative names):
        Action `perform_designator` (nao_library_actions/PerformDesignator): its result has the answer, or the class of
        the failure and its text; feedback names the task that has changed, and its state.
        Subscribes `designators` (std_msgs/String): the same as text, without an answer; failures are logged.
        The modules use `joint_trajectory`, `walk_target`, `speech`, `speech_action`, `NaoLights`, `NaoVision`,
        `joint_states`, /tf.
    """

    def __init__(self) -> None:
        self._robot = this_robot()
        self._closing = CancellationToken()
        start_process_modules(*make_process_modules(self._robot))
        self._server = ConcurrentActionServer(lambda _: frozenset(), self._perform_goal, with_feedback=True)
        ActionServer(ACTION, PerformDesignatorAction, self._server.on_goal, self._server.on_cancel, False).start()
        rospy.Subscriber(TOPIC, String, self._on_text, queue_size=100)

    def close(self) -> None:
        close_all(self._closing.trigger, lambda: self._server.close(SHUTDOWN_LIMIT), stop_process_modules)

    def _perform_goal(self, goal: Any, interrupt: CancellationToken, publish: Callable[[Any], None]) -> GoalOutcome:
        def tell(task: Task) -> None:
            publish(PerformDesignatorFeedback(task=task.path, state=task.state.value))

        try:
            answer = self._perform(read(goal), interrupt, tell)
        except (PlanFailure, PlanError) as failure:
            result = PerformDesignatorResult(failure=type(failure).__name__, text=str(failure))
            return GoalOutcome(result, interrupt.is_set(), "" if interrupt.is_set() else str(failure))
        value = answer.as_json() if isinstance(answer, Grip) else answer
        return GoalOutcome(PerformDesignatorResult(result=json_of(value)))

    def _perform(self, desig: Designator, interrupt: CancellationToken, tell: Callable[[Task], None]) -> Any:
        roots: list[Task] = []

        def see(task: Task) -> None:
            if not roots:
                roots.append(task)
                if interrupt.is_set():  # before there was a task that it could have ended
                    end()
            tell(task)

        def end() -> None:
            for root in roots:
                root.evaporate("the goal was cancelled")

        with interrupt.waking(end):
            return top_level(do(perform, desig), name=str(desig), clock=self._robot.clock, observers=[see])

    def _on_text(self, message: String) -> None:
        try:
            self._perform(designator(message.data), self._closing, lambda _: None)
        except (PlanFailure, PlanError) as failure:
            rospy.logerr("%s: %s: %s", TOPIC, type(failure).__name__, failure)


def read(goal: Any) -> Designator:
    """The designator of a goal of PerformDesignator. Raises PlanError if it has none, or it cannot be read."""
    if goal.designator.strip():
        if goal.pairs:
            raise PlanError("designator: there is text, and keys and values: one of the two")
        return designator(goal.designator)
    kind = goal.kind.strip() or "action"
    if not goal.pairs:
        raise PlanError("designator: there is neither text nor keys and values")
    require_short(sum(len(pair.key) + len(pair.value) for pair in goal.pairs))
    budget = text_budget()
    return designator([(pair.key, _value(pair.value, budget)) for pair in goal.pairs], kind)


def _value(text: str, budget: Budget) -> Any:
    """What a text stands for: a designator in Lisp, or YAML."""
    return designator(text) if text.lstrip().startswith("(") else read_yaml(text, budget)
