"""What can be done to a simulated robot and its world, through the services of the node nao_sim."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from naoqi.errors import NaoError

from ...cli.stack import SIMULATOR
from ...core.errors import BadGoal

KINDS = ("ball", "box", "cylinder", "landmark", "qr", "face", "person")
"""Things that the page places."""
CONTENTS = {"landmark": "64", "qr": "hello", "face": "anna", "person": "anna"}
"""Kind -> an example of what stands in its content: number of a landmark, text of a code, name of a head."""
MOUTH = 1.5
"""m over the floor, where a person's voice comes from."""
LONGEST_TEXT = 500


class Simulator:
    """The simulator behind one robot, if there is one. Methods call services: not in the event loop.

    All raise NaoError, with the simulator's words, if it refuses or is not there.
    """

    def __init__(self, robot: Any) -> None:
        self._robot = robot

    @property
    def there(self) -> bool:
        return self._robot.has_service(f"{SIMULATOR}/press")

    @property
    def shapes_topic(self) -> str:
        """Full name of the topic that tells where things are: several robots share a world."""
        shared = not self._robot.has_service(f"{SIMULATOR}/pause")
        return f"{'/' if shared else self._robot.namespace}{SIMULATOR}/shapes"

    def touch(self, devices: Sequence[str], seconds: float) -> None:
        """A hand comes and touches sensors for so long, s; with several of one part it strokes over them."""
        from nao_library_msgs.srv import TouchSensors

        self._call("touch", TouchSensors, sensors=list(devices), time=_duration(seconds), wait=False)

    def push(self, force: float, direction: float, seconds: float) -> None:
        """Push the torso with so many N, for so many s, to where a direction in rad points in the world."""
        from geometry_msgs.msg import Vector3

        from nao_library_msgs.srv import PushRobot

        way = Vector3(force * math.cos(direction), force * math.sin(direction), 0.0)
        self._call("push", PushRobot, link="", force=way, time=_duration(seconds))

    def place(self, name: str, kind: str, content: str, x: float, y: float, z: float) -> None:
        """Place a thing at x, y, z, m over the floor."""
        from geometry_msgs.msg import Point, Pose, Quaternion

        from nao_library_msgs.srv import PlaceObject

        if kind not in KINDS:
            raise BadGoal("kind", kind, f"one of {', '.join(KINDS)}")
        pose = Pose(Point(x, y, z), Quaternion())
        size = [0.1, 0.1, 0.1] if kind == "box" else [0.04, 0.1] if kind == "cylinder" else []
        stand = kind in ("landmark", "qr", "face")
        self._call(
            "place_object", PlaceObject, name=name, kind=kind, content=content, size=size, stand=stand, pose=pose
        )

    def remove(self, name: str) -> None:
        from nao_library_msgs.srv import RemoveObject

        self._call("remove_object", RemoveObject, name=name)

    def person_says(self, text: str, x: float, y: float) -> None:
        """Somebody who stands at x, y, m, says a text; returns when it has been said."""
        from geometry_msgs.msg import Point

        from nao_library_msgs.srv import PersonSays

        if not 0 < len(text) <= LONGEST_TEXT:
            raise BadGoal("text", text[:40], f"1 to {LONGEST_TEXT} characters")
        self._call("person_says", PersonSays, text=text, position=Point(x, y, MOUTH))

    def pause(self) -> None:
        self._empty("pause")

    def resume(self) -> None:
        self._empty("resume")

    def reset(self) -> None:
        """Put robot and things back to where they began."""
        self._empty("reset")

    def speed(self) -> float | None:
        """Simulated seconds per second as it was started; None if it does not say so."""
        import rospy

        for name in (f"{self._robot.namespace}{SIMULATOR}/speed", f"/{SIMULATOR}/speed"):
            if rospy.has_param(name):
                return float(rospy.get_param(name))
        return None

    def set_speed(self, speed: float) -> None:
        """Simulated seconds per second; 0 for as fast as possible."""
        from nao_library_msgs.srv import SetSpeed

        self._call("set_speed", SetSpeed, speed=speed)

    def _empty(self, name: str) -> None:
        from std_srvs.srv import Empty

        self._call(name, Empty)

    def _call(self, name: str, kind: type, /, **fields: Any) -> Any:
        """Call a service of this robot, or the one that all robots of a world share."""
        own = f"{SIMULATOR}/{name}"
        answer = self._robot.call(own if self._robot.has_service(own) else f"/{own}", kind, **fields)
        if not getattr(answer, "success", True):
            raise NaoError(answer.message or f"{own}: refused")
        return answer


def _duration(seconds: float) -> Any:
    import rospy

    return rospy.Duration.from_sec(seconds)
