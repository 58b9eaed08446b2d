"""What all pages show live of a robot: pose, lights, touches, things of its world, camera pictures, traces for plots.

A frame is binary for what comes often, JSON for what seldom changes. A binary frame begins with a byte that says what
it is, little-endian throughout:

    pose      01  flags u8  count u16  f32 x 3 place (m)  f32 x 4 turn (x, y, z, w)  f64 stamp (s)  f32 x count joints
    lights    02  0         count u16  u8 x 3 x count: red, green, blue
    samples   03  0         count u16  count x (u32 index of the trace, f32 value, f64 stamp)
    picture   04  kind u8   0 u16      u32 0  f64 stamp  the picture as it came: kind 0 JPEG, 1 PNG

Joints and lights are in the order of the last `layout`, a text frame; so are traces in that of the last `traces`.

Traces are numbers of the robot over the last minute, read while a page plots them. Their names:

    velocity:JOINT, effort:JOINT    rad/s, N m
    stiffness:JOINT                 0..1
    sonar:left, sonar:right         m
    foot:left, foot:right           N
    imu:roll, imu:pitch             rad
    gyro:x, gyro:y, gyro:z          rad/s
    acceleration:x, ...             m/s^2
    memory:KEY                      what the robot's memory has there, a number or a truth value

Angles of joints (`joint:JOINT`) are in every pose frame already: pages plot them from there.
"""

from __future__ import annotations

import asyncio
import json
import math
import struct
import threading
from collections import deque
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Deque, Tuple, Union

from naoqi.errors import NaoError

from ...core.errors import did_you_mean
from ...core.geometry import yaw_of_quaternion
from ...core.nao_facts import CAMERAS
from .alarms import AlarmWatch
from .background import in_background
from .robot_state import BodyWatch
from .senses import FLOAT, MemoryTopics, Senses
from .simulator import Simulator

POSE_FRAME, LIGHTS_FRAME, SAMPLES_FRAME, PICTURE_FRAME = 1, 2, 3, 4
PLACED = 1
"""Flag of a pose: it is known where the base is; else the robot stands on its feet at the origin."""
JPEG, PNG = 0, 1
HEAD = struct.Struct("<BBH")
BASE = struct.Struct("<7fd")
SAMPLE = struct.Struct("<Ifd")
SHOT = struct.Struct("<BBHId")
Base = Tuple[float, float, float, float, float, float, float]
"""Place in m and turn as a quaternion (x, y, z, w)."""
UNPLACED: Base = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
STAMP_AT = HEAD.size + 28
"""Where the stamp of a pose is: what is the same but for it shows the same."""


def pose_frame(stamp: float, base: Base | None, joints: Sequence[float]) -> bytes:
    """A pose; `base` is None where the robot's place is not known. Joints are in rad, or m."""
    head = HEAD.pack(POSE_FRAME, 0 if base is None else PLACED, len(joints))
    return head + BASE.pack(*(base or UNPLACED), stamp) + struct.pack(f"<{len(joints)}f", *joints)


def same_pose(first: bytes, second: bytes) -> bool:
    """Whether two frames show the same but for their stamps."""
    end = STAMP_AT + 8
    return first[:STAMP_AT] == second[:STAMP_AT] and first[end:] == second[end:]


def lights_frame(colours: Iterable[Sequence[float]]) -> bytes:
    """Colours, each red, green and blue in 0..1."""
    parts = bytes(min(max(round(255 * part), 0), 255) for colour in colours for part in colour)
    return HEAD.pack(LIGHTS_FRAME, 0, len(parts) // 3) + parts


def samples_frame(samples: Sequence[tuple[int, float, float]]) -> bytes:
    """Readings of traces: index of the trace, value, and ROS time in s."""
    return HEAD.pack(SAMPLES_FRAME, 0, len(samples)) + b"".join(SAMPLE.pack(*sample) for sample in samples)


def picture_frame(stamp: float, picture: bytes, png: bool = False) -> bytes:
    """A compressed picture as it came, and when it was taken, ROS time in s."""
    return SHOT.pack(PICTURE_FRAME, PNG if png else JPEG, 0, 0, stamp) + picture


def text_frame(kind: str, **values: Any) -> str:
    """Something that seldom changes: an object of JSON with a `kind`."""
    return json.dumps({"kind": kind, **values}, ensure_ascii=False)


Frame = Union[bytes, str]
MOST_QUEUED = 200
"""Frames of a kind that must not be lost, kept for a page that does not take them; then the oldest go."""


class FrameInbox:
    """What one page has still to be sent."""

    def __init__(self) -> None:
        self._latest: dict[Hashable, Frame] = {}
        self._queued: list[Frame] = []
        self._filled = asyncio.Event()

    def put(self, kind: Hashable, frame: Frame) -> None:
        """Send a frame; one of the same kind that waits is left out."""
        self._latest.pop(kind, None)  # what changed last goes last
        self._latest[kind] = frame
        self._filled.set()

    def add(self, frame: Frame) -> None:
        """Send a frame that no later one replaces."""
        self._queued.append(frame)
        del self._queued[:-MOST_QUEUED]
        self._filled.set()

    def forget(self) -> None:
        """Leave out what was added and waits: it would be read wrongly from now on."""
        self._queued.clear()

    async def take(self) -> list[Frame]:
        """Wait for frames; texts come first, as they say how to read the others."""
        await self._filled.wait()
        self._filled.clear()
        frames = [*self._latest.values(), *self._queued]
        self._latest.clear()
        self._queued.clear()
        return sorted(frames, key=lambda frame: not isinstance(frame, str))


class Broadcast:
    """The pages that look at one thing, and what each was last shown of it."""

    def __init__(self) -> None:
        self._inboxes: set[FrameInbox] = set()
        self._last: dict[Hashable, Frame] = {}

    def __len__(self) -> int:
        return len(self._inboxes)

    def attach(self) -> FrameInbox:
        """One more page looks; it gets the last frame of each kind at once."""
        inbox = FrameInbox()
        for kind, frame in self._last.items():
            inbox.put(kind, frame)
        self._inboxes.add(inbox)
        return inbox

    def detach(self, inbox: FrameInbox) -> None:
        self._inboxes.discard(inbox)
        if not self._inboxes:
            self._last.clear()  # it would be out of date for who comes next

    def put(self, kind: Hashable, frame: Frame) -> None:
        """Show a frame to all pages."""
        self._last[kind] = frame
        for inbox in self._inboxes:
            inbox.put(kind, frame)

    def last(self, kind: Hashable) -> Frame | None:
        return self._last.get(kind)


CAMERA_VIEWS = tuple(CAMERAS.values())
PICTURE = "picture"


class CameraFeed:
    """One camera of one robot; the topic is listened to while a page looks. Event loop only.

    ROS API (relative name):
        Subscribes `nao_robot/camera/NAME/image_raw/compressed` (sensor_msgs/CompressedImage).
    """

    def __init__(self, robot: Any, camera: str) -> None:
        self._robot = robot
        self._camera = camera
        self._pages = Broadcast()
        self._changing = asyncio.Lock()  # one page comes or goes at a time
        self._end: Callable[[], None] | None = None

    async def attach(self) -> FrameInbox:
        """One more page looks."""
        async with self._changing:
            if self._end is None:
                self._end = await in_background(self._subscribe, asyncio.get_running_loop())
            return self._pages.attach()

    async def detach(self, inbox: FrameInbox) -> None:
        """A page has gone."""
        async with self._changing:
            self._pages.detach(inbox)
            if not len(self._pages) and self._end is not None:
                end, self._end = self._end, None
                await in_background(end)

    def _subscribe(self, loop: asyncio.AbstractEventLoop) -> Callable[[], None]:
        from sensor_msgs.msg import CompressedImage

        def show(told: Any) -> None:  # in a thread of ROS
            frame = picture_frame(told.header.stamp.to_sec(), told.data, told.format.lower().endswith("png"))
            loop.call_soon_threadsafe(self._pages.put, PICTURE, frame)

        return self._robot.topic(f"nao_robot/camera/{self._camera}/image_raw/compressed", CompressedImage, show)


SPAN = 60.0
"""s that are kept."""
CLOSEST = 0.045
"""s between two readings of a trace, at least."""
MOST_TRACES = 12
"""Traces of one page, at most."""
LONGEST_NAME = 200
JOINT_FIELDS = {"velocity": "velocity", "effort": "effort"}
SIDES, AXES, TILTS = ("left", "right"), ("x", "y", "z"), ("roll", "pitch")
TRACE_NAMES = {
    **{kind: () for kind in (*JOINT_FIELDS, "stiffness", "memory")},
    **{kind: SIDES for kind in ("sonar", "foot")},
    **{kind: AXES for kind in ("gyro", "acceleration")},
    "imu": TILTS,
}
"""Kind of a trace -> what may stand after its colon; empty: a joint, or a key."""
Reading = Tuple[float, float]
"""ROS time in s, and a value."""


def split_trace(name: Any) -> tuple[str, str]:
    """Kind of a trace and of what it is. Raises NaoError if there is no such trace."""
    kind, _, what = str(name)[: LONGEST_NAME + 1].partition(":")
    if len(str(name)) > LONGEST_NAME or not what:
        raise NaoError(f"{str(name)[:60]!r} is no trace: KIND:NAME, such as sonar:left")
    if kind not in TRACE_NAMES:
        raise NaoError(
            f"{kind!r} is no kind of trace{did_you_mean(kind, TRACE_NAMES)}; there are {', '.join(TRACE_NAMES)}"
        )
    if TRACE_NAMES[kind] and what not in TRACE_NAMES[kind]:
        raise NaoError(f"{kind}:{what}: there are {', '.join(f'{kind}:{name}' for name in TRACE_NAMES[kind])}")
    return kind, what


def listed_value(names: Sequence[str], values: Sequence[float], name: str) -> float:
    """The value of a name in two lists that belong together; not a number where it is missing."""
    try:
        return float(values[list(names).index(name)])
    except (ValueError, IndexError):
        return math.nan


class Trace:
    """Readings of one number. Readings come in threads of ROS; a lock guards them."""

    def __init__(self) -> None:
        self.problem = ""
        self.users = 0
        self.end: Callable[[], None] | None = None
        self._lock = threading.Lock()
        self._kept: Deque[Reading] = deque()
        self._fresh: list[Reading] = []

    def add(self, stamp: float, value: float) -> None:
        """One more reading; left out if it comes too soon after the last one. Time that went back begins anew."""
        with self._lock:
            if self._kept:
                since = stamp - self._kept[-1][0]
                if 0.0 <= since < CLOSEST:
                    return
                if since < 0.0:
                    self._kept.clear()
            self._kept.append((stamp, value))
            self._fresh.append((stamp, value))
            while self._kept[0][0] < stamp - SPAN:
                self._kept.popleft()

    def fresh(self) -> list[Reading]:
        """Readings since the last call."""
        with self._lock:
            fresh, self._fresh = self._fresh, []
        return fresh

    def kept(self) -> list[Reading]:
        with self._lock:
            return list(self._kept)


class Traces:
    """All traces of one robot that a page plots. `want` and `leave` come from one thread, and may take a while."""

    def __init__(self, robot: Any, memory: MemoryTopics) -> None:
        self._robot = robot
        self._memory = memory
        self._traces: dict[str, Trace] = {}

    def want(self, name: str) -> Trace:
        """A trace, which is read from now on; its `problem` says what is wrong with it."""
        trace = self._traces.get(name)
        if trace is None:
            trace = self._traces[name] = Trace()
        trace.users += 1
        if trace.end is None:
            try:
                trace.end, trace.problem = self._begin(name, trace), ""
            except NaoError as error:
                trace.problem = str(error)
        return trace

    def leave(self, name: str) -> None:
        trace = self._traces[name]
        trace.users -= 1
        if trace.users == 0:
            del self._traces[name]
            if trace.end is not None:
                trace.end()

    def fresh(self) -> dict[str, list[Reading]]:
        """New readings by trace; the event loop asks for them."""
        return {name: trace.fresh() for name, trace in list(self._traces.items())}

    def _begin(self, name: str, trace: Trace) -> Callable[[], None]:
        kind, what = split_trace(name)
        if kind == "memory":
            return self._memory.watch(what, FLOAT, lambda told: trace.add(told.header.stamp.to_sec(), told.data))
        topic, message, value = _source(kind, what)
        return self._robot.topic(topic, message, lambda told: trace.add(told.header.stamp.to_sec(), value(told)))


def _source(kind: str, what: str) -> tuple[str, type, Callable[[Any], float]]:
    """Topic of a trace, its type, and what gives the value of a message."""
    from sensor_msgs.msg import Imu, JointState, Range

    from nao_library_msgs.msg import Fsr

    if kind in JOINT_FIELDS:
        field = JOINT_FIELDS[kind]
        return "joint_states", JointState, lambda told: listed_value(told.name, getattr(told, field), what)
    if kind == "stiffness":
        topic = "nao_joint_states/joint_stiffness"
        return topic, JointState, lambda told: listed_value(told.name, told.effort, what)
    if kind == "sonar":
        return f"nao_robot/sonar/{what}", Range, lambda told: told.range
    if kind == "foot":
        return f"nao_robot/fsr/{what}", Fsr, lambda told: told.total
    if kind == "imu":
        return "imu", Imu, lambda told: _tilt(told.orientation)[TILTS.index(what)]
    field = "angular_velocity" if kind == "gyro" else "linear_acceleration"
    return "imu", Imu, lambda told: getattr(getattr(told, field), what)


def _tilt(turn: Any) -> tuple[float, float]:
    """Roll and pitch of a quaternion, rad."""
    x, y, z, w = turn.x, turn.y, turn.z, turn.w
    sine = min(max(2.0 * (w * y - z * x), -1.0), 1.0)
    return math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)), math.asin(sine)


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


@dataclass(frozen=True)
class RobotViews:
    """Of one robot; nothing is listened to before somebody wants it."""

    robot: Any  # its RobotClient
    senses: Senses
    body: BodyWatch
    alarms: AlarmWatch
    simulator: Simulator
    live: LiveView
    cameras: Mapping[str, CameraFeed]


class Views:
    """Of all robots, made when a page or a trial first asks. Any thread.

    `folder`: of the studies.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._lock = threading.Lock()
        self._robots: dict[str, RobotViews] = {}

    def of(self, robot: Any) -> RobotViews:
        """Those of a RobotClient."""
        with self._lock:
            found = self._robots.get(robot.namespace)
            if found is None or found.robot is not robot:
                memory, simulator = MemoryTopics(robot), Simulator(robot)
                senses, body = Senses(robot, memory), BodyWatch(robot, memory)
                alarms = AlarmWatch(robot, body, self._folder)
                live = LiveView(robot, senses, memory, simulator)
                cameras = {name: CameraFeed(robot, name) for name in CAMERA_VIEWS}
                found = RobotViews(robot, senses, body, alarms, simulator, live, cameras)
                self._robots[robot.namespace] = found
            return found
