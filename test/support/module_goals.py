"""Goals to a real module class that talks libqi to the simulator, without a ROS master."""

from __future__ import annotations

import threading
from types import SimpleNamespace

from recorded_node import RecordedNode
from simulator import PATIENCE

from nao_library_modules.core.robot import Robot


class WatchedRobot(Robot):
    """Proxies whose calls the lockstep knows of."""

    def __init__(self, ip, port, lockstep):
        super().__init__(ip, port)
        self._lockstep = lockstep
        self._watched = {}

    def proxy(self, name):
        if name not in self._watched:
            self._watched[name] = _WatchedProxy(super().proxy(name), self._lockstep)
        return self._watched[name]


class _WatchedProxy:
    def __init__(self, proxy, lockstep):
        self._proxy = proxy
        self._lockstep = lockstep

    def call_async(self, method, *arguments):
        opened = self._lockstep.call_begins(self._proxy)
        try:
            opened.call = self._proxy.call_async(method, *arguments)
        except BaseException:
            self._lockstep.call_ended(opened)
            raise
        opened.call.add_done_callback(lambda _: self._lockstep.call_ended(opened))
        return _WatchedCall(opened.call, self._proxy, self._lockstep)

    def __getattr__(self, name):
        return getattr(self._proxy, name)


class _WatchedCall:
    """A call whose callbacks the lockstep knows of."""

    def __init__(self, call, proxy, lockstep):
        self._call, self._proxy, self._lockstep = call, proxy, lockstep

    def add_done_callback(self, callback):
        opened = self._lockstep.call_begins(self._proxy, self._call)

        def run(_):
            try:
                callback(self)
            finally:
                self._lockstep.call_ended(opened)

        self._call.add_done_callback(run)

    def __getattr__(self, name):
        return getattr(self._call, name)


class Goal:
    """A goal under way, or its end.

    Attributes:
        feedback: Messages so far.
    """

    def __init__(self, module, simulator, goal):
        self._server = module.server
        self._simulator = simulator
        self._server.end = None
        self._server.preempt_requested = False
        self._server.feedback = self.feedback = []
        self._finishing = False
        self._thread = threading.Thread(target=self._run, args=(goal,), daemon=True)
        simulator.lockstep.goal_begins(self._thread)
        self._thread.start()

    def _run(self, goal):
        self._server.execute(goal)
        if self._finishing:
            self._simulator.server.runner.pause()  # here, where time holds: no tick more than the goal needs

    @property
    def active(self):
        return self._thread.is_alive()

    def refused(self, limit):
        """Whether it is over within `limit` s of the computer, without time that passes."""
        self._thread.join(limit)
        return not self.active

    def finish(self):
        """Let time pass until the goal is over, and no longer."""
        self._finishing = True
        if self.active:
            self._simulator.server.runner.resume()
        self._thread.join(4 * PATIENCE)
        self._simulator.server.runner.pause()
        return self._ended()

    def cancel(self):
        """Preempt it and wait for its end; no simulated time passes unless its clean-up waits for some."""
        self._server.preempt()
        self._simulator.lockstep.changed()
        return self.finish()

    def over(self):
        """It does not hold time any more."""
        self._simulator.lockstep.goal_is_over(self._thread)

    def _ended(self):
        assert not self._thread.is_alive(), "the goal does not end"
        self.over()
        assert self._server.end is not None, "the goal has no end state"
        self.state, self.text, self.result = self._server.end, self._server.text, self._server.result
        return self


class ModuleGoals:
    """A module under test, and goals to it.

    Args:
        kind: Class of the module.
        goal: Type of its goals.
        simulator: The robot that it talks to.
        options: More arguments of the class.
    """

    def __init__(self, kind, goal, simulator, parameters=None, **options):
        self.node = RecordedNode(
            SimpleNamespace(now=simulator.lockstep.time, wait=simulator.lockstep.wait, simulated=True)
        )
        self.node.parameters.update(parameters or {})
        self._simulator = simulator
        self._goal = goal
        robot = WatchedRobot(*simulator.address, simulator.lockstep)
        robot.connection.connect(PATIENCE)
        self.module = kind(*simulator.address, robot=robot, node=self.node, **options)

    def send(self, *functions, **fields):
        """A goal that has begun; let time pass with `robot.advance`, `goal.finish()` or `goal.cancel()`."""
        return Goal(self.module, self._simulator, self._goal(list(functions), **fields))

    def play(self, *functions, **fields):
        """A goal that is over, whatever its end; time passes as it needs it."""
        return self.send(*functions, **fields).finish()

    def succeed(self, *functions, **fields):
        """The result of a goal that succeeds."""
        goal = self.play(*functions, **fields)
        assert goal.state == "succeeded", goal.text
        return goal.result

    def refused(self, *functions, **fields):
        """The text of a goal that is aborted."""
        goal = self.play(*functions, **fields)
        assert goal.state == "aborted", goal.state
        return goal.text

    def close(self):
        self.module.shut_down()
