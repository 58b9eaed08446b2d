"""Lights: LEDs, through the action of the server NaoLights."""

from __future__ import annotations

from collections.abc import Sequence

import rospy

from nao_library_actions.msg import NaoLedAction, NaoLedGoal
from nao_library_msgs.msg import LedFunction

from ..language.failures import LightsLowLevelFailure
from .robot_module import RobotModule

LIGHTS_ACTION = "NaoLights"
LONGEST_LIGHTS = 60.0
FACE = "FaceLeds"


class Lights(RobotModule):
    """Changes the colour and the brightness of lights."""

    name = "lights"
    methods = ("set_color", "set_intensity")

    def set_color(self, color: str, lights: Sequence[str] = (FACE,), time: float = 0.0, revert: bool = False) -> None:
        """Give lights a colour, by name or #RRGGBB; wait `time` s, then restore the former one with `revert`.

        Raises LightsLowLevelFailure if there is no such light or colour, or it failed.
        """
        self._run(LedFunction(function="setColor", lights=list(lights), str_param=color, revert=revert), time)

    def set_intensity(
        self, intensity: float, lights: Sequence[str] = (FACE,), time: float = 0.0, revert: bool = False
    ) -> None:
        """Give lights a brightness, 0..1; the rest as for `set_color`."""
        self._run(LedFunction(function="setIntensity", lights=list(lights), i_values=[intensity], revert=revert), time)

    def _run(self, function: LedFunction, time: float) -> None:
        function.time = rospy.Duration.from_sec(time)
        end = self.robot.action(LIGHTS_ACTION, NaoLedAction).call(NaoLedGoal([function]), time + LONGEST_LIGHTS)
        if not end.succeeded:
            raise LightsLowLevelFailure(f"{function.function}: {end}")
