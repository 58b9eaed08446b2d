#!/usr/bin/env python3
"""A new function for the light server: one key-value pair. `blink` switches lights on and off again.

Try it in place of the node NaoLights; then a goal may hold
LedFunction(function="blink", lights=["FaceLeds"], times=[0.2, 0.4, 0.2]).
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

from nao_library_modules.errors import BadGoal
from nao_library_modules.function_chain import checked_by
from nao_library_modules.light_checks import check_lights
from nao_library_modules.lights import NaoLights
from nao_library_modules.node import run_module


def check_blink(self: BlinkingLights, lights: Sequence[str], times: Sequence[float], context: dict[str, Any]) -> None:
    """Looks at the fields before anything of the chain runs; it takes those that it needs, by name."""
    check_lights(self, lights, context)
    if not times or min(times) <= 0.0:
        raise BadGoal("times", list(times), "lengths of the flashes in s, above 0")


class BlinkingLights(NaoLights):
    """The light server and one function more."""

    def __init__(self, ip: str, port: int, **options: Any) -> None:
        """Start the server."""
        super().__init__(ip, port, **options)
        self.function_table["blink"] = self.blink

    @checked_by(check_blink)
    def blink(self, lights: Sequence[str], times: Sequence[float]) -> int:
        """Flash lights; a new goal or a cancel ends it at any moment, and the lights are as before.

        Args:
            lights: Lights and groups.
            times: Length of each flash and of the pause after it, in s.

        Returns:
            How many flashes there were; the client finds it in memList.
        """
        self.after_wait(self.leds.restorer(lights))
        for time in times:
            self.on(lights, revert=False)
            self.wait(time)
            self.off(lights, revert=False)
            self.wait(time)
        return len(times)


if __name__ == "__main__":
    sys.exit(run_module(BlinkingLights, "NaoLights", __doc__))
