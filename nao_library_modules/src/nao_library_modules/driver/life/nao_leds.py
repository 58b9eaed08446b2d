"""The node nao_leds: colours, blinking and states of the LEDs."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Tuple

import rospy
from std_msgs.msg import ColorRGBA

from nao_library_actions.msg import BlinkAction, BlinkFeedback, BlinkResult
from nao_library_msgs.msg import FadeRGB, LedStates
from naoqi.errors import NaoError
from naoqi.limits import ANSWER_LIMIT, CLEAN_UP_LIMIT

from ...core.errors import BadGoal, Preempted
from ...core.fields import limit, require_within, require_zero_or
from ...core.health import Report
from ...core.lights_and_colours import COLOUR_PARTS, colour_part
from ...core.nao_facts import PREFIX
from ...core.robot import run_task
from ...core.waiting import CancellationToken, OncePerConnection
from ...ros.action_server import ConcurrentActionServer, GoalOutcome, Replaced
from ...ros.node_interface import NodeInterface
from ...ros.time_and_frames import RosClock
from ..base.driver_node import LazyTopic, interrupt_when_lost, number, publish
from ..base.polling import Polling

LEDS = "ALLeds"
EYES = "FaceLeds"
DURATION = limit("duration")
LONGEST_PAUSE = 3.0
"""Standard deviations above the mean that a pause may last."""

Colour = Tuple[float, float, float]
"""Red, green and blue, 0 to 1."""


@dataclass(frozen=True)
class Blinks:
    """How to blink."""

    colours: Sequence[Colour]  # to choose from
    background: Colour  # between the blinks
    duration: float  # of one blink, s: a third each to fade in, hold and fade out
    mean_pause: float  # s
    deviation: float  # standard deviation of the pause, s

    def check(self) -> None:
        """Raises BadGoal if they cannot be carried out."""
        if not self.colours:
            raise BadGoal("colors", [], "at least one colour", problem="no colour to blink in")
        fields = [("bg_color", self.background), *((f"colors[{i}]", each) for i, each in enumerate(self.colours))]
        for field, colour in fields:
            if not all(0.0 <= part <= 1.0 for part in colour):
                raise BadGoal(field, tuple(colour), "red, green and blue, each 0 to 1")
        require_within("blink_duration", self.duration, DURATION)
        require_within("blink_rate_mean", self.mean_pause, DURATION)
        require_zero_or("blink_rate_sd", self.deviation, DURATION)

    def pause(self, chance: random.Random) -> float:
        longest = self.mean_pause + LONGEST_PAUSE * self.deviation
        return min(max(chance.gauss(self.mean_pause, self.deviation), 0.0), longest)


def fade(robot: Any, light: str, colour: Colour, duration: float, interrupt: CancellationToken) -> None:
    """Fade a light or a group to a colour in `duration` s, and wait for the end.

    Raises NaoError if the robot refuses or is lost; Preempted, or whatever reason the interrupt has.
    """
    call = robot.proxy(LEDS).call_async("fadeRGB", light, *(float(part) for part in colour), float(duration))
    run_task(call, interrupt, lambda: None)  # a robot that cannot cancel ends the fade by itself


def blink(
    robot: Any,
    blinks: Blinks,
    clock: Any,
    interrupt: CancellationToken,
    report: Callable[[Colour], None],
    chance: random.Random,
) -> bool:
    """Blink until the interrupt comes; the eyes have the background colour then.

    `clock` is the time of holds and pauses. `report` gets the colour of each blink that begins. `chance` picks colours
    and pauses. Returns whether a newer goal replaces this one. Raises NaoError if the robot refuses or is lost.
    """
    third = blinks.duration / 3.0
    try:
        while True:
            colour = chance.choice(blinks.colours)
            report(colour)
            fade(robot, EYES, colour, third, interrupt)
            clock.wait(third, interrupt)
            interrupt.check()
            fade(robot, EYES, blinks.background, third, interrupt)
            clock.wait(blinks.pause(chance), interrupt)
            interrupt.check()
    except Replaced:
        return True
    except Preempted:
        call = robot.proxy(LEDS).call_async("fadeRGB", EYES, *(float(part) for part in blinks.background), 0.0)
        try:
            call.result(timeout=CLEAN_UP_LIMIT)
        except NaoError as error:
            raise NaoError(f"the eyes may not have the colour of the background: {error}") from error
        return False


MEMORY = "ALMemory"
BLUE_DEVICES = "Ears/"
"""What the names of LEDs begin with that are blue; those that have no colour in their names and are not are white."""


class LedReader:
    """Reads the lights of one robot. For one thread."""

    def __init__(self, robot: Any) -> None:
        self._robot = robot
        self._names = OncePerConnection(robot, self._read_names)

    def read(self) -> dict[str, Colour]:
        """Colour of each light by its short name. Raises NaoError if the robot cannot be asked."""
        lights = self._names()
        devices = [device for light in lights.values() for device in light]
        values = self._robot.proxy(MEMORY).call_async("getListData", [PREFIX + device for device in devices])
        found = values.result(timeout=ANSWER_LIMIT)
        if len(found) != len(devices):
            raise NaoError(f"the robot's memory holds {len(found)} values of {len(devices)} LEDs")
        return shown(lights, dict(zip(devices, found)))

    def _read_names(self) -> dict[str, tuple[str, ...]]:
        """LEDs of each light; all at once, for one after the other takes a second on a wireless network."""
        leds = self._robot.proxy(LEDS)
        names = leds.call_async("listLEDs").result(timeout=ANSWER_LIMIT)
        calls = [leds.call_async("listLED", name) for name in names]
        return joined({name: tuple(call.result(timeout=ANSWER_LIMIT)) for name, call in zip(names, calls)})


def joined(lights: Mapping[str, tuple[str, ...]]) -> dict[str, tuple[str, ...]]:
    """Lights as one sees them: ChestLedsRed, ChestLedsGreen and ChestLedsBlue are one, ChestLeds."""
    found: dict[str, tuple[str, ...]] = {}
    for name, devices in lights.items():
        part = next((part for part in COLOUR_PARTS if name.endswith(part)), "")
        whole = name[: len(name) - len(part)]
        found[whole] = (*found.get(whole, ()), *devices)
    return found


def shown(lights: Mapping[str, tuple[str, ...]], values: Mapping[str, Any]) -> dict[str, Colour]:
    """Colour of each light, red, green and blue in 0..1.

    `lights`: name -> its LEDs. `values`: LED -> intensity 0..1; what is no number counts as 0.
    """
    return {
        name: _colour({device: _number(values.get(device)) for device in devices}) for name, devices in lights.items()
    }


def _colour(values: Mapping[str, float]) -> Colour:
    parts = {colour_part(device): value for device, value in values.items()}
    if any(part in parts for part in COLOUR_PARTS):
        red, green, blue = (parts.get(part, 0.0) for part in COLOUR_PARTS)
        return red, green, blue
    strongest = max(values.values(), default=0.0)
    if all(device.startswith(BLUE_DEVICES) for device in values):
        return 0.0, 0.0, strongest
    return strongest, strongest, strongest


def _number(value: Any) -> float:
    return min(max(float(value), 0.0), 1.0) if isinstance(value, (int, float)) else 0.0


QUEUE = 100
COMPLAINT_PERIOD = 5.0
SHUTDOWN_LIMIT = 2.0
DEFAULT_RATE = 10.0


class NaoLeds:
    """Lights of one robot, under the names of nao_robot.

    ROS API (relative names):
        Subscribes `fade_rgb` (nao_library_msgs/FadeRGB): fades one after the other, in the order of the messages.
        Action `blink` (nao_library_actions/Blink): the eyes blink until the goal is cancelled or a newer one comes;
        so it never succeeds. `still_blinking` in its result says that a newer one has come.
        Publishes `led_states` (nao_library_msgs/LedStates): what each light shows, while it has subscribers.
        Parameter `~led_rate` (10 Hz).
    """

    def __init__(self, robot: Any, node: NodeInterface) -> None:
        rate = number(node, "~led_rate", DEFAULT_RATE, "reading rate")
        self._robot = robot
        self._clock = RosClock()
        self._chance = random.Random()
        self._interrupt = CancellationToken()
        self._server = ConcurrentActionServer(lambda _: frozenset({EYES}), self._blink, with_feedback=True, robot=robot)
        node.action("blink", BlinkAction, self._server)
        self._stop_watching = interrupt_when_lost(robot, node, self._server)
        node.subscriber("fade_rgb", FadeRGB, self._fade, queue_size=QUEUE)
        self._reader = LedReader(robot)
        self._states = node.publisher("led_states", LedStates, queue_size=1)
        self._polling = Polling(robot, "lights", rate, self._clock, self._read)
        node.if_it_fails(self._polling.close)
        self._lazy = LazyTopic(self._polling.want, self._states)

    def reports(self) -> dict[str, Callable[[], Report]]:
        return {"goals blink": self._server.counter.report, "lights": self._polling.report}

    def close(self) -> None:
        self._polling.close()
        self._stop_watching()
        self._interrupt.stop()
        self._server.close(SHUTDOWN_LIMIT)

    def _read(self) -> None:
        message = LedStates()
        message.header.stamp = rospy.Time.now()
        shown = self._reader.read()
        message.lights, message.colors = list(shown), [ColorRGBA(*colour, 1.0) for colour in shown.values()]
        publish(self._states, message)

    def _fade(self, message: FadeRGB) -> None:
        colour, duration = _rgb(message.color), message.fade_duration.to_sec()
        try:
            if not all(0.0 <= part <= 1.0 for part in colour):
                raise BadGoal("color", colour, "red, green and blue, each 0 to 1")
            require_zero_or("fade_duration", duration, DURATION)
            fade(self._robot, message.led_name, colour, duration, self._interrupt)
        except Preempted:
            return  # the node ends
        except NaoError as error:
            rospy.logerr_throttle(COMPLAINT_PERIOD, f"fade_rgb: {error}")

    def _blink(self, goal: Any, interrupt: CancellationToken, publish: Callable[[Any], None]) -> GoalOutcome:
        blinks = Blinks(
            [_rgb(color) for color in goal.colors],
            _rgb(goal.bg_color),
            goal.blink_duration.to_sec(),
            goal.blink_rate_mean,
            goal.blink_rate_sd,
        )
        blinks.check()

        def report(colour: Colour) -> None:
            publish(BlinkFeedback(last_color=ColorRGBA(*colour, 1.0)))

        replaced = blink(self._robot, blinks, self._clock, interrupt, report, self._chance)
        return GoalOutcome(BlinkResult(still_blinking=replaced), preempted=True)


def _rgb(color: ColorRGBA) -> tuple[float, float, float]:
    return color.r, color.g, color.b
