"""Messages, requests and goals of the driver in which one number is what nobody means: each node goes on as before."""

from __future__ import annotations

import math
import os
import resource
import threading
import unittest
from collections import Counter
from xmlrpc.client import ServerProxy

import actionlib
import rosgraph
import roslib.message
import rosnode
import rospy
import rosservice
from amount import part_of
from boundary import FLOATS, long_lists, numbers, variants
from examples_fixture import start
from gaps import LONGEST, gaps_at
from genpy import Duration
from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion, Vector3
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
from nav_msgs.msg import Path
from sensor_msgs.msg import JointState, Joy
from services import answer, service
from std_msgs.msg import ColorRGBA
from std_srvs.srv import Empty
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from nao_library_actions import msg as actions
from nao_library_msgs.msg import FadeRGB, JointAnglesWithSpeed, StepTarget
from nao_library_msgs.srv import PlaceObject, PlaceSound, RemoveObject, RemoveSound, StopFilm
from nao_sim_bridge.naoqi.binding.binding import DEFECT
from nao_sim_bridge.testing import SimulatedRobot, wait_until

ONE_IN = 5
"""One in so many messages is tried in the short form."""
PATIENCE = 60.0
"""s of the computer that an answer may take."""
WALK = 3.0
"""s of the computer after which a service that still walks is stopped."""
SHORT = 0.3
"""s of the computer after which a goal that goes on is cancelled."""
MEMORY = 8 * 1024**3
"""What each node may have of address space, bytes."""
BEGIN_ANEW = ("/factory_reset", "/reset_world", "/reset")
"""Services that put the robot to where it began."""
THEIRS = ("/rosout", "/clock", "/tf", "/tf_static", "/camera_info")
PLACE = PoseStamped()
PLACE.header.frame_id = "odom"
PLACE.pose = Pose(orientation=Quaternion(w=1.0))
AHEAD = PoseStamped()
AHEAD.header.frame_id = "odom"
AHEAD.pose.position.x, AHEAD.pose.orientation.w = 0.1, 1.0
PATH = Path(poses=[PLACE, AHEAD])
PATH.header.frame_id = "odom"
HEAD = JointAnglesWithSpeed(joint_names=["HeadYaw"], joint_angles=[0.1], speed=0.5)
STEP = StepTarget(leg=1)
STEP.pose.y = 0.1
TRAJECTORY = JointTrajectory(
    joint_names=["HeadYaw"], points=[JointTrajectoryPoint([0.1], [0.0], [0.0], [], Duration(1))]
)
STIFFNESS = JointTrajectory(joint_names=["Head"], points=[JointTrajectoryPoint([0.9], [], [], [], Duration(1))])
THERE = Pose(Point(1.0, 1.0, 0.1), Quaternion(w=1.0))
RED = ColorRGBA(1.0, 0.0, 0.0, 1.0)

TOPICS = {
    "/joint_angles": HEAD,
    "/joint_stiffness": JointState(name=["HeadYaw"], effort=[0.9]),
    "/fade_rgb": FadeRGB(led_name="FaceLeds", color=RED, fade_duration=Duration(0.1)),
    "/joy": Joy(axes=[0.0] * 6, buttons=[0] * 12),
    "/move_base_simple/goal": PLACE,
    "/walk_target_simple/goal": PLACE,
    "/walk_path_simple/goal": PATH,
    "/cmd_step": STEP,
    "/footstep": STEP,
}
"""Messages of topics for which an empty one has no numbers, or is no valid one."""
REQUESTS = {
    "/cmd_step_srv": {"step": STEP},
    "/footstep_srv": {"step": STEP},
    "/clip_footstep_srv": {"step": STEP},
    "/nao_memory/watch": {"pattern": "Boundary/*"},
    "/nao_sim/advance": {"time": Duration(0.1)},
    "/nao_sim/film/start": {"file": "boundary.mp4", "width": 160, "height": 160, "frame_rate": 20.0},
    "/nao_sim/move_object": {"name": "thing", "pose": THERE, "time": Duration(0.1), "wait": True},
    "/nao_sim/move_sound": {"name": "tone", "position": THERE.position},
    "/nao_sim/person_says": {"text": "yes", "position": THERE.position, "level_db": 60.0},
    "/nao_sim/picture": {"width": 64, "height": 48, "file": "boundary.png"},
    "/nao_sim/place_object": {
        "name": "thing",
        "kind": "box",
        "size": [0.1, 0.1, 0.1],
        "color": [1.0, 0.0, 0.0],
        "pose": THERE,
        "mass": 0.1,
    },
    "/nao_sim/place_sound": {"name": "tone", "sound": "tone:440", "position": THERE.position, "level_db": 60.0},
    "/nao_sim/push": {"force": Vector3(1.0, 0.0, 0.0), "time": Duration(0.1)},
    "/nao_sim/set_battery": {"data": 0.5},
    "/nao_sim/touch": {"sensors": ["Head/Touch/Front"], "time": Duration(0.1), "wait": True},
}
UNDO = {
    "/nao_sim/film/start": ("nao_sim/film/stop", StopFilm),
    "/nao_sim/place_object": ("nao_sim/remove_object", RemoveObject, "thing"),
    "/nao_sim/place_sound": ("nao_sim/remove_sound", RemoveSound, "tone"),
}
"""What makes room for another request: what there is already is refused, whatever its numbers are."""
GOALS = {
    "joint_trajectory": (actions.JointTrajectoryAction, actions.JointTrajectoryGoal(trajectory=TRAJECTORY)),
    "joint_stiffness_trajectory": (actions.JointTrajectoryAction, actions.JointTrajectoryGoal(trajectory=STIFFNESS)),
    "joint_angles_action": (actions.JointAnglesWithSpeedAction, actions.JointAnglesWithSpeedGoal(joint_angles=HEAD)),
    "body_pose_naoqi": (
        actions.BodyPoseWithSpeedAction,
        actions.BodyPoseWithSpeedGoal(posture_name="Stand", speed=0.8),
    ),
    "blink": (
        actions.BlinkAction,
        actions.BlinkGoal(
            colors=[RED], bg_color=RED, blink_duration=Duration(0.1), blink_rate_mean=0.1, blink_rate_sd=0.1
        ),
    ),
    "footsteps_execution": (
        actions.ExecFootstepsAction,
        actions.ExecFootstepsGoal(footsteps=[STEP], feedback_frequency=10.0),
    ),
    "walk_path": (actions.FollowPathAction, actions.FollowPathGoal(path=PATH)),
    "walk_target": (MoveBaseAction, MoveBaseGoal(AHEAD)),
}
DESIGNATORS = (
    "{{type: going, target: [{}, 0.0]}}",
    "{{type: going, target: [0.1, 0.0, {}]}}",
    "(an action (type looking) (target (1.0 {})))",
    "{{type: reaching, side: left, target: [0.16, {}, 0.08]}}",
)
"""Designators with a place for a number."""


def forget_the_dead():
    """Have the master forget nodes that tests before this one have killed: their topics and services answer nobody."""
    _, dead = rosnode.rosnode_ping_all()
    rosnode.cleanup_master_blacklist(rosgraph.Master(rospy.get_name()), dead)


def limit_memory():
    """Of all nodes that run."""
    master = rosgraph.Master(rospy.get_name())
    for node in rosnode.get_node_names():
        pid = ServerProxy(master.lookupNode(node)).getPid(rospy.get_name())[2]
        if pid != os.getpid():
            resource.prlimit(pid, resource.RLIMIT_AS, (MEMORY, resource.prlimit(pid, resource.RLIMIT_AS)[1]))


def first(message):
    """Whether a number of a message is not one of the head: what was sent first and when is told nobody."""
    return [place for place, _ in numbers(message) if "header" not in place]


def told(call, request):
    """What a service says that it has not done, as an error or in its answer; empty if it has."""
    answers = []
    text = answer(lambda: answers.append(call(request)))
    if text or getattr(answers[0], "success", True):
        return text
    said = [getattr(answers[0], field, "") for field in ("message", "status_message")]
    return "".join(said) or "no success, and not a word"


class Messages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = SimulatedRobot()
        cls.motion = cls.robot.module("ALMotion")
        cls.figures = Counter()
        cls.plans = start("../nodes/process_modules")
        cls.addClassCleanup(cls.plans.communicate)
        cls.addClassCleanup(cls.plans.kill)
        rospy.wait_for_message("perform_designator/status", rospy.AnyMsg, 60.0)
        forget_the_dead()
        limit_memory()

    def setUp(self):
        self.robot.reset()
        self.motion.wakeUp()
        self.gaps = gaps_at(int(os.environ["NAO_PORT"]))

    def tearDown(self):
        self.gaps.close()
        answer(service("stop_walk_srv", Empty))
        print(f"{self._testMethodName}: {dict(self.figures)}, longest gap {self.gaps.longest:.2f} s")
        self.figures.clear()
        self.assertLess(self.gaps.longest, LONGEST)

    def assert_sound(self, what):
        """Every angle is a number, and the driver answers."""
        self.assertTrue(all(map(math.isfinite, self.motion.getAngles("Body", True))), what)

    def within(self, act, what):
        """What a call gives that has to be over in time."""
        given = []
        thread = threading.Thread(target=lambda: given.append(act()), daemon=True)
        thread.start()
        thread.join(WALK)
        if not given:  # it walks: who calls waits for the end
            answer(service("stop_walk_srv", Empty))
            thread.join(PATIENCE)
        self.assertTrue(given, f"no answer after {PATIENCE:g} s: {what}")
        return given[0]

    def test_topics(self):
        _, subscribed, _ = rospy.get_master().getSystemState()[2]
        kinds = dict(rospy.get_master().getTopicTypes()[2])
        action = ("/goal", "/cancel", "/result", "/feedback", "/status")
        names = [
            name
            for name, nodes in subscribed
            if set(nodes) - {rospy.get_name()} and not name.startswith((*THEIRS, "/other"))
        ]
        tried = []
        for name in names:
            kind = roslib.message.get_message_class(kinds.get(name, "*")) if kinds.get(name, "*") != "*" else None
            if kind is None or (name.endswith(action) and kind.__name__.endswith(("Goal", "ID", "Result", "Feedback"))):
                continue
            example = TOPICS.get(name, kind())
            if not first(example):
                continue
            tried.append(name)
            publisher = rospy.Publisher(name, kind, queue_size=1000)
            wait_until(lambda p=publisher: p.get_num_connections() > 0, PATIENCE, f"subscriber of {name}")
            for _, _, message in part_of([*variants(example), *long_lists(example)], ONE_IN):
                publisher.publish(message)
                self.figures[name] += 1
            publisher.publish(example)
            self.robot.advance(1.0)
            self.within(lambda: answer(service("stop_walk_srv", Empty)), f"after {name}")
            publisher.unregister()
            self.assert_sound(name)
        self.assertLessEqual({"/cmd_vel", "/cmd_pose", *TOPICS}, set(tried))

    def test_services(self):
        for name, kind in (("/nao_sim/place_object", PlaceObject), ("/nao_sim/place_sound", PlaceSound)):
            self.assertEqual(told(service(name, kind), kind._request_class(**REQUESTS[name])), "")
        for name in sorted(rosservice.get_service_list()):
            if name.endswith(("logger_level", "set_logger_level", "get_loggers", *BEGIN_ANEW)):
                continue
            kind = rosservice.get_service_class_by_name(name)
            example = kind._request_class(**REQUESTS.get(name, {}))
            if not first(example):
                continue
            call, (undo, *request) = service(name, kind), UNDO.get(name, (None,))
            self.within(lambda c=call, m=example: answer(c, m), f"{name}: a valid request")
            for place, value, message in part_of([*variants(example), *long_lists(example)], ONE_IN):
                if undo:
                    answer(service(undo, request[0]), *request[1:])
                text = self.within(lambda c=call, m=message: told(c, m), f"{name} {place} {value}")
                self.figures[f"{name} {'refused' if text else 'done'}"] += 1
                self.assertNotIn("unexpected", text, (name, place, value))
                for strange in ("Error processing request", "not a word", DEFECT):
                    self.assertNotIn(strange, text, (name, place, value))
            self.assert_sound(name)

    def test_goals(self):
        for name, (action, example) in GOALS.items():
            client = actionlib.ActionClient(name, action)
            self.assertTrue(client.wait_for_server(rospy.Duration(PATIENCE)), name)
            for place, value, message in [
                *part_of([*variants(example), *long_lists(example)], ONE_IN),
                ("valid", 0, example),
            ]:
                self.end(client, message, f"{name} {place} {value}")
            self.assert_sound(name)

    def test_designators(self):
        client = actionlib.ActionClient("perform_designator", actions.PerformDesignatorAction)
        self.assertTrue(client.wait_for_server(rospy.Duration(PATIENCE)))
        for text in DESIGNATORS:
            for value in (*FLOATS, 0.1):
                goal = actions.PerformDesignatorGoal(text.format(value), "", [])
                self.end(client, goal, f"perform_designator {goal.designator}")
            self.assert_sound(text)

    def end(self, client, message, what):
        """Send a goal, cancel it when it goes on, and wait for its end."""
        over = threading.Event()
        done = {}

        def look(handle):
            if handle.get_comm_state() == actionlib.CommState.DONE:
                done["state"], done["text"] = handle.get_terminal_state(), handle.get_goal_status_text()
                over.set()

        handle = client.send_goal(message, look)
        if not over.wait(SHORT):
            handle.cancel()
        self.assertTrue(over.wait(PATIENCE), f"no end {PATIENCE:g} s after the cancel: {what}")
        self.figures[f"{what.split()[0]} {actionlib.GoalStatus.to_string(done['state']).lower()}"] += 1
        self.assertNotIn("unexpected", done["text"] or "", what)
