"""The robot's legs by way of topics: who listens, what the robot says, how a walk is stopped."""

from __future__ import annotations

import pytest
import rospy

from nao_library_modules.driver import path_follower_legs
from nao_library_modules.driver.path_follower_legs import WalkTopics
from nao_library_modules.interrupt import Interrupt
from nao_library_modules.places import Place
from naoqi.errors import NaoError, RobotError

OBSTACLE = ["an obstacle 0.39 m ahead", 1, [0.9, 0.0, 0.3]]


class WalkingMotion:
    """ALMotion that walks or does not, and an ALMemory with the last failure."""

    def __init__(self):
        self.active = False
        self.refuses = ""
        self.failure = None
        self.calls = []

    def moveInit(self):
        self.calls.append("moveInit")
        if self.refuses:
            raise RobotError("ALMotion", "moveInit", self.refuses)

    def moveIsActive(self):
        return self.active

    def stopMove(self):
        self.calls.append("stopMove")
        self.active = False

    def waitUntilMoveIsFinished(self):
        self.calls.append("waitUntilMoveIsFinished")

    def getData(self, key):
        if self.failure is None:
            raise RobotError("ALMemory", "getData", f"no data {key}")
        return self.failure


class FakePublisher:
    """Keeps messages; has a listener, or none."""

    listeners = 1

    def __init__(self, topic, kind, subscriber_listener, **options):
        self.topic, self.kind = topic, kind
        self.messages = []
        if self.listeners:
            subscriber_listener.peer_subscribe(topic, None, None)

    def get_num_connections(self):
        return self.listeners

    def publish(self, message):
        self.messages.append(message)


class FakeServices:
    """Services that are there, by name; a call of another one fails as rospy has it."""

    def __init__(self, *names):
        self.names = names
        self.calls = []

    def proxy(self, name, kind):
        def call():
            if name not in self.names:
                raise rospy.ServiceException(f"service {name} unavailable")
            self.calls.append(name)

        call.resolved_name = name
        return call


@pytest.fixture
def motion():
    return WalkingMotion()


@pytest.fixture
def services(monkeypatch):
    services = FakeServices("stop_walk_srv", "inhibit_walk", "uninhibit_walk")
    monkeypatch.setattr(path_follower_legs.rospy, "ServiceProxy", services.proxy)
    monkeypatch.setattr(path_follower_legs.rospy, "Publisher", FakePublisher)
    monkeypatch.setattr(path_follower_legs, "LISTENER_LIMIT", 0.01)
    return services


@pytest.fixture
def legs(robot, proxy, services):
    robot.proxy = {"ALMotion": proxy, "ALMemory": proxy}.__getitem__
    return WalkTopics(robot, use_velocities=False)


def test_a_standing_robot_takes_the_pose_for_walking_a_walking_one_has_it(legs, motion):
    legs.prepare(Interrupt())
    motion.active = True
    legs.prepare(Interrupt())
    assert motion.calls == ["moveInit"]


def test_what_keeps_it_from_walking_is_told(legs, motion, monkeypatch):
    motion.refuses = "the legs are limp"
    with pytest.raises(RobotError, match="limp"):
        legs.prepare(Interrupt())
    monkeypatch.setattr(FakePublisher, "listeners", 0)
    with pytest.raises(NaoError, match="nobody listens to .*cmd_pose: does nao_walker run"):
        legs.prepare(Interrupt())


@pytest.mark.parametrize("use_velocities, topic", [(False, "cmd_pose"), (True, "cmd_vel")])
def test_commands_have_their_topics(robot, services, use_velocities, topic):
    legs = WalkTopics(robot, use_velocities)
    assert legs._commands.topic == topic
    if use_velocities:
        legs.go_at(0.5, -0.25, 0.75)
        twist = legs._commands.messages[0]
        assert (twist.linear.x, twist.linear.y, twist.angular.z) == (0.5, -0.25, 0.75)
    else:
        legs.go_to(Place(0.5, -0.25, 0.75))
        pose = legs._commands.messages[0]
        assert (pose.x, pose.y, pose.theta) == (0.5, -0.25, 0.75)


def test_a_failure_counts_when_it_came_after_the_beginning(legs, motion):
    legs.prepare(Interrupt())
    assert legs.why_stopped() == ""
    motion.failure = OBSTACLE
    assert legs.why_stopped() == OBSTACLE[0]
    legs.prepare(Interrupt())
    assert legs.why_stopped() == ""


def test_a_walk_is_stopped_by_the_service_and_else_by_the_robot(legs, motion, services):
    legs.stop()
    assert services.calls == ["stop_walk_srv"]
    assert motion.calls == ["waitUntilMoveIsFinished"]
    services.names = ()
    legs.stop()
    assert motion.calls[1:] == ["stopMove", "waitUntilMoveIsFinished"]


def test_others_are_kept_from_walking_where_somebody_can(legs, services):
    legs.reserve()
    legs.release()
    assert services.calls == ["inhibit_walk", "uninhibit_walk"]
    services.names = ()
    legs.reserve()
    assert len(services.calls) == 2
