"""Pictures of a running simulation, and the window of `--gui`: snapshots in, drawings out, physics never waits."""

from __future__ import annotations

import io
import logging
import threading
from contextlib import suppress
from typing import TYPE_CHECKING

from nao_sim_bridge.base.errors import SimulationStopped
from nao_sim_bridge.base.imports import Library
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.render.client import RenderError, Viewer

if TYPE_CHECKING:
    from nao_sim_bridge.render.window import Ray

Image = Library("PIL.Image")

log = logging.getLogger("nao_sim.pictures")

WINDOW_PERIOD = 1.0 / 30.0


class Pictures:
    """Draws the simulated robot from outside; only its published values are read."""

    def __init__(self, runner: RobotRunner) -> None:
        self._runner = runner
        self._viewer: Viewer | None = None
        self._closing = threading.Event()

    def follow(self, runner: RobotRunner) -> None:
        """Draw another simulation from now on; the window, if there is one, shows its world."""
        before, self._runner = self._runner.simulation.renderer, runner
        if self._viewer is not None and runner.simulation.renderer is not before:
            viewer, self._viewer = self._viewer, None
            viewer.close()
            self.open_window()

    def png(self, view: str, width: int, height: int) -> bytes:
        """A PNG picture from outside; see `Simulation.picture`."""
        buffer = io.BytesIO()
        Image.fromarray(self._runner.simulation.picture(view, width, height), "RGB").save(buffer, "PNG")
        return buffer.getvalue()

    def open_window(self) -> None:
        """Show the simulation in a window from now on; a click on a robot touches the sensor that is there.

        A RenderError when there is no display.
        """
        scene = self._runner.simulation.scene
        self._viewer = Viewer(scene.world, scene.version).start()
        self._viewer.on_pointer = self._on_pointer
        threading.Thread(target=self._mirror, args=(self._viewer,), name="window", daemon=True).start()

    def close(self) -> None:
        self._closing.set()
        if self._viewer is not None:
            self._viewer.close()

    def _on_pointer(self, ray: Ray | None) -> None:
        """The mouse touches what it points at as long as its button is pressed."""
        runner = self._runner

        def point() -> None:
            for robot in runner.simulation.shared.robots:
                robot.robot.point_at(ray)

        with suppress(SimulationStopped):  # and with it all touches
            runner.execute(point, "point")

    def _mirror(self, viewer: Viewer) -> None:
        while not self._closing.wait(WINDOW_PERIOD):
            try:
                viewer.show(self._runner.simulation.render_state())
            except RenderError as error:
                if not self._closing.is_set() and viewer is self._viewer:
                    log.warning("the window is gone: %s", error)
                return
