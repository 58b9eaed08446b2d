"""Action clients of plans and behaviours whose servers are in this process: the real code, without ROS between."""

from __future__ import annotations

import threading

from actionlib_msgs.msg import GoalStatus

import nao_library_modules.process_modules as p
from nao_library_modules.core.describe import CHECK, check_request, read_response
from nao_library_modules.core.waiting import CancellationToken
from nao_library_modules.process_modules.plan_action_client import ActionEnd
from naoqi.errors import NaoError

STATES = {"succeeded": GoalStatus.SUCCEEDED, "aborted": GoalStatus.ABORTED, "preempted": GoalStatus.PREEMPTED}


class PlanClient:
    """Stands for PlanActionClient: `work(goal, interrupt, on_feedback)` answers the ActionEnd of a goal."""

    def __init__(self, work, check=None):
        self._work = work
        if check is not None:
            self.check = check

    def wait_for_server(self):
        """It is there."""

    def call(self, goal, timeout=None, on_feedback=None, on_end=None):
        return p.retry_after_suspension(lambda: self._once(goal, on_feedback, on_end))

    def _once(self, goal, on_feedback, on_end):
        interrupt, end = CancellationToken(), p.Fluent("end", None)

        def run():
            try:
                end.value = self._work(goal, interrupt, on_feedback)
            except NaoError as error:
                end.value = ActionEnd(GoalStatus.ABORTED, str(error), None)

        threading.Thread(target=run, daemon=True).start()
        over = lambda: p.wait_until(lambda: end.value is not None, [end])  # noqa: E731
        try:
            over()
        finally:
            interrupt.trigger()
            with p.uninterrupted():
                over()
            if on_end is not None:
                on_end(end.value)
        return end.value


def client_of(goals, simulator):
    """A client of a module under test, see `ModuleGoals`."""
    server = goals.module.server

    def work(goal, interrupt, on_feedback):
        server.end, server.preempt_requested, server.feedback = None, False, []
        if on_feedback is not None:
            server.publish_feedback = on_feedback
        simulator.lockstep.goal_begins()
        try:
            with interrupt.waking(server.preempt):
                server.execute(goal)
        finally:
            simulator.lockstep.goal_is_over()
        return ActionEnd(STATES[server.end], server.text, server.result)

    def check(asked):
        return read_response(goals.node.services[goals.module.chain.server + CHECK](check_request(asked)))

    return PlanClient(work, check)
