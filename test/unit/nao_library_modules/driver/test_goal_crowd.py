"""Goals side by side, and those that are in each other's way."""

from __future__ import annotations

import threading

import pytest

from nao_library_modules.driver.goal_crowd import GoalCrowd, Outcome, Replaced
from nao_library_modules.errors import BadGoal, Preempted, RobotLost

LIMIT = 5.0


class Handle:
    """A goal of actionlib: names of joints."""

    def __init__(self, *joints):
        self.joints = joints
        self.accepted = False
        self.end = None
        self._ended = threading.Event()

    def get_goal(self):
        return self.joints

    def set_accepted(self):
        self.accepted = True

    def wait(self):
        assert self._ended.wait(LIMIT), "the goal did not end"
        return self.end

    def _set(self, state):
        def end(result, text=""):
            assert self.end is None, "a goal ends once"
            self.end = (state, result, text)
            self._ended.set()

        return end

    def __getattr__(self, name):
        if name.startswith("set_"):
            return self._set(name[len("set_") :])
        raise AttributeError(name)


class Work:
    """An executor whose goals run until the test, or an interrupt, ends them."""

    def __init__(self):
        self.running = {}
        self.started = threading.Condition()

    def __call__(self, joints, interrupt):
        finish = threading.Event()
        with self.started:
            self.running[joints] = finish
            self.started.notify_all()
        with interrupt.waking(finish.set):
            assert finish.wait(LIMIT), "nobody ended this goal"
        try:
            interrupt.check()
        except Preempted:
            return Outcome(f"stopped {joints}", preempted=True)
        return Outcome(f"done {joints}")

    def wait_for(self, *joints):
        with self.started:
            assert self.started.wait_for(lambda: joints in self.running, LIMIT), f"{joints} did not start"


@pytest.fixture
def work():
    return Work()


@pytest.fixture
def crowd(work):
    return GoalCrowd(frozenset, work)


def send(crowd, *joints):
    handle = Handle(*joints)
    crowd.on_goal(handle)
    assert handle.accepted
    return handle


def test_goals_for_different_joints_run_side_by_side(crowd, work):
    head, arm = send(crowd, "HeadYaw"), send(crowd, "LArm")
    work.wait_for("HeadYaw")
    work.wait_for("LArm")
    work.running[("LArm",)].set()
    assert arm.wait() == ("succeeded", "done ('LArm',)", "")
    assert head.end is None
    work.running[("HeadYaw",)].set()
    assert head.wait()[0] == "succeeded"


def test_a_goal_for_the_same_joint_ends_the_older_one_first(crowd, work):
    old = send(crowd, "HeadYaw", "HeadPitch")
    work.wait_for("HeadYaw", "HeadPitch")
    new = send(crowd, "HeadYaw")
    work.wait_for("HeadYaw")
    assert old.end == ("canceled", "stopped ('HeadYaw', 'HeadPitch')", "a newer goal needs HeadYaw")
    work.running[("HeadYaw",)].set()
    assert new.wait()[0] == "succeeded"


def test_of_many_goals_for_one_joint_only_the_last_is_left(crowd, work):
    goals = [send(crowd, "HeadYaw", f"{i}") for i in range(20)]
    for goal in goals[:-1]:
        assert goal.wait()[0] == "canceled"
    work.wait_for("HeadYaw", "19")
    assert goals[-1].end is None
    crowd.on_cancel(goals[-1])
    assert goals[-1].wait() == ("canceled", "stopped ('HeadYaw', '19')", "canceled")


def test_a_cancel_ends_one_goal(crowd, work):
    head, arm = send(crowd, "HeadYaw"), send(crowd, "LArm")
    work.wait_for("HeadYaw")
    work.wait_for("LArm")
    crowd.on_cancel(head)
    assert head.wait() == ("canceled", "stopped ('HeadYaw',)", "canceled")
    assert arm.end is None
    crowd.interrupt_all(RobotLost("nao:9559", "silence"))
    assert arm.wait() == ("aborted", None, "the robot at nao:9559 went away: silence")


def test_goals_that_will_not_do_abort_with_their_text(work):
    def claims(joints):
        raise BadGoal("joint_names", joints, "joints")

    assert send(GoalCrowd(claims, work), "Tail").wait()[0] == "aborted"
    broken = GoalCrowd(frozenset, lambda *_: 1 / 0)
    assert "division by zero" in send(broken, "HeadYaw").wait()[2]


def test_the_end_of_the_node_ends_goals_and_takes_no_more(crowd, work):
    head = send(crowd, "HeadYaw")
    work.wait_for("HeadYaw")
    crowd.close(LIMIT)
    assert head.end[0] == "canceled"
    assert send(crowd, "HeadYaw").wait() == ("canceled", None, "canceled")


def test_ends_are_counted(crowd, work):
    head = send(crowd, "HeadYaw")
    work.wait_for("HeadYaw")
    work.running[("HeadYaw",)].set()
    head.wait()
    assert crowd.counter.report().values["succeeded"] == "1"


@pytest.mark.parametrize("newer, signal", [(True, Replaced), (False, Preempted)], ids=["newer goal", "cancel"])
def test_an_executor_knows_whether_a_newer_goal_takes_over(newer, signal):
    started, reasons = threading.Event(), []

    def execute(joints, interrupt):
        if started.is_set():
            return Outcome("second")
        started.set()
        assert interrupt.wait(LIMIT)
        try:
            interrupt.check()
        except Preempted as reason:
            reasons.append(reason)
            raise

    crowd = GoalCrowd(frozenset, execute)
    old = send(crowd, "HeadYaw")
    assert started.wait(LIMIT)
    if newer:
        assert send(crowd, "HeadYaw").wait()[0] == "succeeded"
    else:
        crowd.on_cancel(old)
    assert old.wait()[0] == "canceled"
    assert [type(reason) for reason in reasons] == [signal]


def test_feedback_goes_to_the_goal_it_is_for():
    def execute(joints, interrupt, publish):
        publish(f"half of {joints[0]}")
        return Outcome("done")

    crowd = GoalCrowd(frozenset, execute, with_feedback=True)
    handle = Handle("HeadYaw")
    handle.feedback = []
    handle.publish_feedback = handle.feedback.append
    crowd.on_goal(handle)
    assert handle.wait()[0] == "succeeded"
    assert handle.feedback == ["half of HeadYaw"]
