"""Eyes that blink in random colours until they are stopped. No ROS."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Tuple

from naoqi.errors import NaoError
from naoqi.limits import CLEAN_UP_LIMIT

from ...base.cancellation import CancellationToken
from ...base.errors import BadGoal, Preempted
from ...base.field_checks import require_within, require_zero_or
from ...base.limits import limit
from ...robot.robot_task import run_task
from ...ros.concurrent_action_server import Replaced

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
            raise BadGoal("colors", [], "at least one colour", problem="there is no colour to blink in")
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
    tell: Callable[[Colour], None],
    chance: random.Random,
) -> bool:
    """Blink until the interrupt comes; the eyes have the background colour then.

    `clock` is the time of holds and pauses. `tell` gets the colour of each blink that begins. `chance` picks colours
    and pauses. Returns whether a newer goal replaces this one. Raises NaoError if the robot refuses or is lost.
    """
    third = blinks.duration / 3.0
    try:
        while True:
            colour = chance.choice(blinks.colours)
            tell(colour)
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
