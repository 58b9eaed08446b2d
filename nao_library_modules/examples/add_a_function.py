#!/usr/bin/env python3
"""A new function for the light server: one key-value pair. `blink` switches lights on and off again.

Try it in place of the node NaoLights; then a goal may hold
LedFunction(function="blink", lights=["FaceLeds"], times=[0.2, 0.4, 0.2]).
"""

from __future__ import annotations

import sys
from typing import Any, List

from nao_library_modules.core.fields import Annotated, numbers
from nao_library_modules.function_chain import checked_by
from nao_library_modules.light_checks import check_lights
from nao_library_modules.lights import NaoLights
from nao_library_modules.lights.light_fields import Lights
from nao_library_modules.node import run_module

Flashes = Annotated[List[float], numbers((0.01, 60.0), "length of each flash and of the pause after it", "s", least=1)]


class BlinkingLights(NaoLights):
    """The light server and one function more."""

    def __init__(self, ip: str, port: int, **options: Any) -> None:
        """Start the server."""
        super().__init__(ip, port, **options)
        self.function_table["blink"] = self.blink

    @checked_by(check_lights)
    def blink(self, lights: Lights, times: Flashes) -> int:
        """Flash lights; a new goal or a cancel ends it at any moment, and the lights are as before.

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
