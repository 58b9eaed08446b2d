"""Pictures of a running simulation, and the window of `--gui`: snapshots in, drawings out, physics never waits."""

from __future__ import annotations

import io
import logging
import threading
from contextlib import suppress
from typing import TYPE_CHECKING

from PIL import Image

from nao_sim_bridge.base.errors import SimulationStopped
from nao_sim_bridge.core.runner import SimulationRunner
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.render.client import RenderError, Viewer

if TYPE_CHECKING:
    from nao_sim_bridge.render.window import Ray

log = logging.getLogger("nao_sim.pictures")

WINDOW_PERIOD = 1.0 / 30.0


class Pictures:
    """Draws the simulated robot from outside; only its published values are read."""

    def __init__(self, simulation: Simulation, runner: SimulationRunner) -> None:
        self._simulation = simulation
        self._runner = runner
        self._viewer: Viewer | None = None
        self._closing = threading.Event()

    def follow(self, simulation: Simulation) -> None:
        """Draw another simulation from now on; the window, if there is one, shows its world."""
        before, self._simulation = self._simulation.renderer, simulation
        if self._viewer is not None and simulation.renderer is not before:
            viewer, self._viewer = self._viewer, None
            viewer.close()
            self.open_window()

    def png(self, view: str, width: int, height: int) -> bytes:
        """A PNG picture from outside; see `Simulation.picture`."""
        buffer = io.BytesIO()
        Image.fromarray(self._simulation.picture(view, width, height), "RGB").save(buffer, "PNG")
        return buffer.getvalue()

    def open_window(self) -> None:
        """Show the simulation in a window from now on; a click on a robot touches the sensor that is there.

        A RenderError when there is no display.
        """
        self._viewer = Viewer(self._simulation.scene.world, self._simulation.scene.version).start()
        self._viewer.on_pointer = self._on_pointer
        threading.Thread(target=self._mirror, args=(self._viewer,), name="window", daemon=True).start()

    def close(self) -> None:
        self._closing.set()
        if self._viewer is not None:
            self._viewer.close()

    def _on_pointer(self, ray: Ray | None) -> None:
        """The mouse touches what it points at as long as its button is pressed."""

        def point() -> None:
            for robot in self._simulation.shared.robots:
                robot.robot.point_at(ray)

        with suppress(SimulationStopped):  # and with it all touches
            self._runner.execute(point, "point")

    def _mirror(self, viewer: Viewer) -> None:
        while not self._closing.wait(WINDOW_PERIOD):
            try:
                viewer.show(self._simulation.render_state())
            except RenderError as error:
                if not self._closing.is_set() and viewer is self._viewer:
                    log.warning("the window is gone: %s", error)
                return
