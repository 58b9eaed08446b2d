"""A robot live for all open pages: pose, lights, touches, things of its world, and the traces that pages plot."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from typing import Any

from naoqi.errors import NaoError

from ...base.places import yaw_of_quaternion
from .background import in_background
from .broadcast import Broadcast, FrameInbox
from .memory_topics import MemoryTopics
from .senses import Senses
from .simulator import Simulator
from .traces import MOST_TRACES, Traces
from .wire import Base, lights_frame, pose_frame, same_pose, samples_frame, text_frame

PERIOD = 0.05
"""s between two poses: 20 Hz."""
SLOWEST = 10
"""Periods after which a pose is sent again that has not changed: plots go on."""
LAYOUT, POSE, LIGHTS, TOUCHED, SHAPES, TRACES = "layout", "pose", "lights", "touched", "shapes", "traces"


class LiveView:
    """One robot as its pages see it. Event loop only, but for callbacks of ROS, which only note the newest message.

    Frames are made 20 times a second, once for all pages, and only while one looks.

    ROS API (relative names):
        Subscribes `joint_states`, `led_states`, and where the robot is: `ground_truth/odom` of a simulated one, else
        `odom`; `nao_sim/shapes` of a simulated world; topics of traces that are plotted, and those of `Senses`.
    """

    def __init__(self, robot: Any, senses: Senses, memory: MemoryTopics, simulator: Simulator) -> None:
        self._robot = robot
        self._senses = senses
        self._simulator = simulator
        self._traces = Traces(robot, memory)
        self._pages = Broadcast()
        self._watched: dict[FrameInbox, list[str]] = {}
        self._changing = asyncio.Lock()  # one page comes or goes at a time
        self._ends: list[Callable[[], None]] = []
        self._task: asyncio.Task[None] | None = None
        self._joints: Any = None
        self._odometry: Any = None
        self._lights: Any = None
        self._shapes: Any = None
        self._base: Base | None = None
        self._names: tuple[Sequence[str], Sequence[str]] = ([], [])
        self._pose = b""
        self._unchanged = 0
        self._pressed: frozenset[str] = frozenset()

    async def attach(self) -> FrameInbox:
        """One more page looks."""
        async with self._changing:
            if self._task is None:
                self._ends = await in_background(self._subscribe)
                self._task = asyncio.create_task(self._run())
            inbox = self._pages.attach()
            self._watched[inbox] = []
            return inbox

    async def detach(self, inbox: FrameInbox) -> None:
        """A page has gone."""
        await self.watch(inbox, ())
        async with self._changing:
            self._watched.pop(inbox, None)
            self._pages.detach(inbox)
            if self._watched or self._task is None:
                return
            self._task.cancel()
            self._task = None
            ends, self._ends = self._ends, []
            await in_background(_end_all, ends)
            self._joints = self._odometry = self._lights = self._shapes = self._base = None
            self._names, self._pose, self._pressed = ([], []), b"", frozenset()

    async def watch(self, inbox: FrameInbox, names: Sequence[str]) -> None:
        """Send a page these traces, and no others: the last minute of each that is known, then what comes."""
        wanted = list(dict.fromkeys(names))[:MOST_TRACES]
        async with self._changing:
            if inbox not in self._watched:
                return
            before = self._watched[inbox]
            if before == wanted:
                return
            found = await in_background(self._change_traces, before, wanted)
            self._watched[inbox] = wanted
        problems = {name: trace.problem for name, trace in found.items() if trace.problem}
        inbox.forget()  # indices mean other traces now
        inbox.put(TRACES, text_frame(TRACES, traces=wanted, problems=problems))
        for index, name in enumerate(wanted):
            if name not in before and found[name].kept():
                inbox.add(samples_frame([(index, value, stamp) for stamp, value in found[name].kept()]))

    @property
    def heading(self) -> float:
        """Where the robot looks, rad in the frame of its place; 0 while that is not known."""
        return 0.0 if self._base is None else yaw_of_quaternion(*self._base[3:]) or 0.0

    def _change_traces(self, before: Sequence[str], wanted: Sequence[str]) -> dict[str, Any]:
        found = {name: self._traces.want(name) for name in wanted}  # before others go: what stays is not begun anew
        for name in before:
            self._traces.leave(name)
        return found

    def _subscribe(self) -> list[Callable[[], None]]:
        from nav_msgs.msg import Odometry
        from sensor_msgs.msg import JointState

        from nao_library_msgs.msg import LedStates, WorldShapes

        ends = [
            self._senses.acquire(),
            self._robot.topic("joint_states", JointState, lambda told: setattr(self, "_joints", told)),
            self._robot.topic("led_states", LedStates, lambda told: setattr(self, "_lights", told)),
        ]
        simulated = self._simulator.there
        place = "ground_truth/odom" if simulated else "odom"
        ends.append(self._robot.topic(place, Odometry, lambda told: setattr(self, "_odometry", told)))
        if simulated:
            topic = self._simulator.shapes_topic
            ends.append(self._robot.topic(topic, WorldShapes, lambda told: setattr(self, "_shapes", told)))
        return ends

    # --- 20 times a second ----------------------------------------------------------------------------------------

    async def _run(self) -> None:
        loop = asyncio.get_running_loop()
        due = loop.time()
        while True:
            due = max(due + PERIOD, loop.time())
            await asyncio.sleep(due - loop.time())
            self._show_lights()
            self._show_pose()
            self._show_touches()
            self._show_shapes()
            self._show_samples()

    def _show_pose(self) -> None:
        odometry, self._odometry = self._odometry, None
        if odometry is not None:
            place, turn = odometry.pose.pose.position, odometry.pose.pose.orientation
            self._base = (place.x, place.y, place.z, turn.x, turn.y, turn.z, turn.w)
        joints, self._joints = self._joints, None
        if joints is None:
            return
        self._show_layout(joints.name, self._names[1])
        frame = pose_frame(joints.header.stamp.to_sec(), self._base, joints.position)
        self._unchanged += 1
        if self._unchanged < SLOWEST and same_pose(frame, self._pose):
            return
        self._pose, self._unchanged = frame, 0
        self._pages.put(POSE, frame)

    def _show_lights(self) -> None:
        lights, self._lights = self._lights, None
        if lights is None:
            return
        self._show_layout(self._names[0], lights.lights)
        frame = lights_frame((color.r, color.g, color.b) for color in lights.colors)
        if frame != self._pages.last(LIGHTS):
            self._pages.put(LIGHTS, frame)

    def _show_layout(self, joints: Sequence[str], lights: Sequence[str]) -> None:
        if (joints, lights) != self._names:
            self._names = (joints, lights)
            self._pages.put(LAYOUT, text_frame(LAYOUT, joints=list(joints), lights=list(lights)))

    def _show_touches(self) -> None:
        pressed = self._senses.pressed
        if pressed != self._pressed:
            self._pressed = pressed
            self._pages.put(TOUCHED, text_frame(TOUCHED, devices=sorted(pressed)))

    def _show_shapes(self) -> None:
        shapes, self._shapes = self._shapes, None
        if shapes is None:
            return
        frame = text_frame(SHAPES, shapes=[_shape(shape) for shape in shapes.shapes])
        if frame != self._pages.last(SHAPES):
            self._pages.put(SHAPES, frame)

    def _show_samples(self) -> None:
        if not any(self._watched.values()):
            return
        fresh = self._traces.fresh()
        for inbox, names in self._watched.items():
            samples = [
                (index, value, stamp) for index, name in enumerate(names) for stamp, value in fresh.get(name, ())
            ]
            if samples:
                inbox.add(samples_frame(samples))


def _shape(shape: Any) -> dict[str, Any]:
    place, turn = shape.pose.position, shape.pose.orientation
    return {
        "thing": shape.thing,
        "form": shape.kind,
        "size": list(shape.size),
        "place": [round(value, 4) for value in (place.x, place.y, place.z)],
        "turn": [round(value, 4) for value in (turn.x, turn.y, turn.z, turn.w)],
        "color": [round(value, 3) for value in (shape.color.r, shape.color.g, shape.color.b)],
    }


def _end_all(ends: Sequence[Callable[[], None]]) -> None:
    for end in ends:
        end()


def watched_traces(message: Any) -> list[str]:
    """Traces that a page asks for, from what it has sent: {"watch": [NAME, ...]}. Raises NaoError."""
    names = message.get("watch") if isinstance(message, dict) else None
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise NaoError('a page sends {"watch": [NAMES OF TRACES]}')
    return names
