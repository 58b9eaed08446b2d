"""What the driver's nodes are made of: goals side by side, pace, and parameters that can change."""

from __future__ import annotations

import threading
from unittest.mock import MagicMock

import pytest

from nao_library_modules.core.errors import BadGoal, ErrorCode, Preempted, RobotLost, code_in
from nao_library_modules.core.waiting import CancellationToken, WallClock
from nao_library_modules.driver.base import driver_node, reconfigure
from nao_library_modules.driver.base.driver_node import LazyTopic
from nao_library_modules.driver.base.polling import Rate
from nao_library_modules.driver.base.reconfigure import ReconfigureField
from nao_library_modules.driver.joints.nao_joint_states import NaoJointStates
from nao_library_modules.driver.joints.pose_manager import PostureMissed
from nao_library_modules.ros.action_server import FULL, ConcurrentActionServer, GoalOutcome
from naoqi.errors import NaoError

PATIENCE = 60.0


class Handle:
    """A goal of actionlib: names of joints."""

    def __init__(self, *joints):
        self.joints, self.accepted, self.end, self.feedback = joints, False, None, []
        self.publish_feedback, self._ended = self.feedback.append, threading.Event()
        for state in ("succeeded", "canceled", "aborted"):
            setattr(self, f"set_{state}", lambda result, text="", state=state: self._set(state, result, text))

    def get_goal(self):
        return self.joints

    def set_accepted(self):
        self.accepted = True

    def _set(self, *end):
        assert self.end is None, "a goal ends once"
        self.end = end
        self._ended.set()

    def wait(self):
        assert self._ended.wait(PATIENCE), "the goal did not end"
        return self.end


class Work:
    """An executor whose goals run until the test, or an interrupt, ends them."""

    def __init__(self):
        self.running = {}

    def __call__(self, joints, interrupt):
        finish = self.running[joints] = threading.Event()
        with interrupt.waking(finish.set):
            assert finish.wait(PATIENCE), "nobody ended this goal"
        try:
            interrupt.check()
        except Preempted as reason:
            return GoalOutcome(f"{type(reason).__name__} {joints}", preempted=True)
        return GoalOutcome(f"done {joints}")

    def begun(self, *joints):
        pause, end = threading.Event(), WallClock().now() + PATIENCE
        while joints not in self.running:
            assert not pause.wait(0.001) and WallClock().now() < end, f"{joints} did not begin"
        return self.running[joints]


@pytest.fixture
def work():
    return Work()


@pytest.fixture
def server(work):
    return ConcurrentActionServer(frozenset, work)


def send(server, *joints):
    handle = Handle(*joints)
    server.on_goal(handle)
    assert handle.accepted
    return handle


def test_goals_for_different_joints_run_side_by_side_and_are_cancelled_apart(server, work):
    head, arm, leg = (send(server, joint) for joint in ("HeadYaw", "LArm", "LLeg"))
    for joint in ("HeadYaw", "LLeg"):
        work.begun(joint)
    work.begun("LArm").set()
    assert arm.wait() == ("succeeded", "done ('LArm',)", "")
    assert server.counter.report().values["succeeded"] == "1"
    server.on_cancel(head)
    assert head.wait() == ("canceled", "Preempted ('HeadYaw',)", "canceled")
    assert leg.end is None
    server.interrupt_all(RobotLost("nao:9559", "silence"))
    assert leg.wait() == ("aborted", None, "the robot at nao:9559 went away: silence")


def test_a_goal_for_the_same_joint_ends_the_older_one_first(server, work):
    old = send(server, "HeadYaw", "HeadPitch")
    work.begun("HeadYaw", "HeadPitch")
    new = send(server, "HeadYaw")
    finish = work.begun("HeadYaw")
    assert old.end == ("canceled", "Replaced ('HeadYaw', 'HeadPitch')", "a newer goal needs HeadYaw")
    finish.set()
    assert new.wait()[0] == "succeeded"
    last = send(server, "HeadYaw", "LArm")
    work.begun("HeadYaw", "LArm")
    server.close(PATIENCE)
    assert last.end == ("canceled", "Preempted ('HeadYaw', 'LArm')", "canceled")
    assert send(server, "HeadYaw").wait() == ("canceled", None, "canceled")  # it takes no more


def test_goals_that_will_not_do_abort_with_their_text_and_feedback_goes_to_its_goal(work):
    def claims(joints):
        raise BadGoal("joint_names", joints, "joints")

    def execute(joints, interrupt, publish):
        publish(f"half of {joints[0]}")
        return GoalOutcome("done")

    assert send(ConcurrentActionServer(claims, work), "Tail").wait()[0] == "aborted"
    assert "division by zero" in send(ConcurrentActionServer(frozenset, lambda *_: 1 / 0), "HeadYaw").wait()[2]
    handle = send(ConcurrentActionServer(frozenset, execute, with_feedback=True), "HeadYaw")
    assert handle.wait()[0] == "succeeded" and handle.feedback == ["half of HeadYaw"]


def test_an_error_with_a_code_tells_it_in_the_status_of_its_goal():
    def execute(_joints, _interrupt):
        raise PostureMissed("Stand")

    state, _, text = send(ConcurrentActionServer(frozenset, execute), "HeadYaw").wait()
    assert state == "aborted" and code_in(text) is ErrorCode.POSTURE_MISSED


def test_goals_that_are_too_many_are_aborted_with_what_is_allowed(server, work):
    goals = [send(server, f"joint {n}") for n in range(100)]
    assert send(server, "HeadYaw").wait() == ("aborted", None, FULL) and "100 goals" in FULL
    work.begun("joint 0").set()
    goals[0].wait()
    server.close(PATIENCE)
    assert all(goal.wait()[0] == "canceled" for goal in goals[1:])


class PassingClock:
    """Time that passes by waiting only, and by the test."""

    time = 100.0

    def now(self):
        return self.time

    def wait(self, duration, interrupt):
        self.time += duration
        return not interrupt.is_set()


def test_work_and_delays_do_not_add_up_and_a_long_round_is_made_up_for_once():
    clock = PassingClock()
    pacer, moments = Rate(clock, 0.02, 0.0, CancellationToken()), []
    for work in (0.0, 0.013, 0.004, 0.019, 0.03, 0.0, 0.0):
        assert pacer.wait()
        moments.append(clock.time - 100.0)
        clock.time += work
    assert moments == pytest.approx([0.0, 0.02, 0.04, 0.06, 0.08, 0.11, 0.12])


FIELDS = (
    ReconfigureField("volume", -1, "how loud", -1, 100),
    ReconfigureField("voice", "", "who speaks"),
    ReconfigureField("beep", True, "whether it beeps"),
    ReconfigureField("speed", 1.5, "how fast"),
    ReconfigureField(
        "frequency", 16000, "samples a second", 16000, 48000, {16000: "one channel", 48000: "four channels"}
    ),
)


def test_what_a_parameter_cannot_be_is_told_when_the_node_begins(monkeypatch):
    monkeypatch.setattr(reconfigure, "Server", lambda *_: pytest.fail("the server takes it"))
    for name, value, allowed in (
        ("volume", 101, "a whole number from -1 to 100"),
        ("volume", True, "a whole number from -1 to 100"),
        ("voice", 3, "a text"),
        ("beep", "yes", "true or false"),
        ("frequency", 22050, r"16000 \(one channel\) or 48000 \(four channels\)"),
    ):
        given = {f"~{name}": value}
        node = MagicMock(param=lambda key, default, given=given: given.get(key, default))
        with pytest.raises(NaoError, match=f"~{name} is {value!r}: {allowed}"):
            reconfigure.serve(node, FIELDS, lambda before, after: after)


# Topics that cost nothing


class ListenedTopic:
    """A publisher, and rospy's side of it."""

    def __init__(self):
        self.impl, self.nodes, self._hears = self, [], None

    def add_subscriber_listener(self, listener):
        self._hears = listener

    def get_stats_info(self):
        return [(1, node, "o", "TCPROS", "/topic", True, "") for node in self.nodes]

    def have(self, *nodes):
        self.nodes = nodes
        self._hears.peer_subscribe("/topic", None, None)


def test_work_is_done_while_one_of_some_topics_has_a_listener_that_counts():
    told, (first, second) = [], (ListenedTopic(), ListenedTopic())
    LazyTopic(told.append, first, second, but=["/makes_frames"])
    for topic, nodes, listened in (
        (first, ("/makes_frames",), []),
        (second, ("/rviz",), [True]),
        (first, ("/makes_frames", "/plot"), [True]),
        (second, (), [True]),
        (first, ("/makes_frames",), [True, False]),
    ):
        topic.have(*nodes)
        assert told == listened, nodes


def test_joints_are_wanted_by_who_listens_and_not_by_the_node_that_makes_frames_of_them_alone(monkeypatch):
    monkeypatch.setattr(driver_node, "tf_prefix", lambda: "")
    topics, robot = {}, MagicMock()
    robot.connection.wait_connected.return_value = False
    node = MagicMock(param=lambda _, default=None: default, resolve=lambda name: f"/nao1/{name}")
    node.publisher = lambda name, *_, **__: topics.setdefault(name, ListenedTopic())
    states = NaoJointStates(robot, node)

    def wanted():
        return states.reports()["readings"]().message != "no subscriber"

    try:
        assert not wanted()
        topics["joint_states"].have("/nao1/robot_state_publisher")
        assert not wanted()
        for name in ("/tf", "imu", "odom", "~joint_stiffness"):
            topics[name].have("/rviz")
            assert wanted(), name
            topics[name].have()
            assert not wanted(), name
        topics["joint_states"].have("/nao1/robot_state_publisher", "/plot")
        assert wanted()
    finally:
        states.close()
