"""A window with a slider for each joint of the robot description, for looking at the model."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ElementTree
from collections.abc import Sequence
from dataclasses import dataclass

import rospy
from sensor_msgs.msg import JointState

from naoqi.errors import NaoError

DESCRIPTION = "robot_description"
TOPIC = "joint_sliders"
COLUMNS = 2
LOOK = 200
"""ms between two looks whether the node has ended."""
RESOLUTION = 0.001
MOVABLE = ("revolute", "continuous", "prismatic")


@dataclass(frozen=True)
class UrdfJoint:
    """A joint that can be set by itself. Limits in rad, or m of a prismatic one."""

    name: str
    lower: float
    upper: float

    @property
    def rest(self) -> float:
        """Zero, or the limit that is nearest to it."""
        return min(max(0.0, self.lower), self.upper)


def movable_joints(description: str) -> list[UrdfJoint]:
    """Joints in the order of the description, without those that follow another one.

    Raises NaoError if it is no URDF.
    """
    try:
        root = ElementTree.fromstring(description)
    except ElementTree.ParseError as error:
        raise NaoError(f"the robot description is no XML: {error}") from error
    found = []
    for joint in root.findall("joint"):
        if joint.get("type") not in MOVABLE or joint.find("mimic") is not None:
            continue
        limit = joint.find("limit")
        if joint.get("type") == "continuous" or limit is None:
            lower, upper = -math.pi, math.pi
        else:
            lower, upper = float(limit.get("lower", 0.0)), float(limit.get("upper", 0.0))
        found.append(UrdfJoint(joint.get("name", ""), lower, upper))
    if not found:
        raise NaoError("the robot description has no joint that moves")
    return found


class JointSliders:
    """The window, with a slider for each joint. All of it runs in the thread that made it.

    ROS API:
        Publishes `joint_sliders` (sensor_msgs/JointState) when a slider moves, latched.
        joint_state_publisher takes it with `source_list`.
    """

    def __init__(self, joints: Sequence[UrdfJoint]) -> None:
        """Raises NaoError if there is no display, or Python has no Tk."""
        try:
            import tkinter
        except ImportError as error:
            raise NaoError("a window needs Tk: install the package python3-tk") from error
        try:
            self._window = tkinter.Tk(className="joint_sliders")
        except tkinter.TclError as error:
            raise NaoError(f"no window: {error}") from error
        self._window.title("Joints")
        self._joints = list(joints)
        self._values = [tkinter.DoubleVar(self._window, joint.rest) for joint in joints]
        self._publisher = rospy.Publisher(TOPIC, JointState, queue_size=1, latch=True)
        rows = -(-len(self._joints) // COLUMNS)
        for i, (joint, value) in enumerate(zip(self._joints, self._values)):
            column, row = divmod(i, rows)
            tkinter.Label(self._window, text=joint.name, anchor="w").grid(row=row, column=2 * column, sticky="w")
            tkinter.Scale(
                self._window,
                variable=value,
                from_=joint.lower,
                to=joint.upper,
                resolution=RESOLUTION,
                orient="horizontal",
                length=260,
                command=lambda _: self._publish(),
            ).grid(row=row, column=2 * column + 1)
        tkinter.Button(self._window, text="All to zero", command=self._to_zero).grid(
            row=rows, column=0, columnspan=2 * COLUMNS
        )
        self._publish()

    def run(self) -> None:
        self._window.after(LOOK, self._look)
        self._window.mainloop()

    def _look(self) -> None:
        if rospy.is_shutdown():
            self._window.destroy()
        else:
            self._window.after(LOOK, self._look)

    def _to_zero(self) -> None:
        for joint, value in zip(self._joints, self._values):
            value.set(joint.rest)
        self._publish()

    def _publish(self) -> None:
        message = JointState(name=[j.name for j in self._joints], position=[v.get() for v in self._values])
        message.header.stamp = rospy.Time.now()
        self._publisher.publish(message)


def main() -> int:
    rospy.init_node("joint_sliders")
    try:
        name = rospy.search_param(DESCRIPTION)
        if name is None:
            raise NaoError(f"parameter {DESCRIPTION} not found: does a launch file load the robot description?")
        JointSliders(movable_joints(rospy.get_param(name))).run()
    except NaoError as error:
        rospy.logfatal("%s", error)
        return 1
    return 0
