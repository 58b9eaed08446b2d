"""What can be done to a simulated robot and its world: shown only where there is a simulator."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any

from nicegui import ui

from naoqi.errors import NaoError

from ...nao.touch_names import SENSORS
from ..view.background import in_background
from ..view.simulator import CONTENTS, KINDS
from ..view.views import RobotViews
from .frame import PageContext

SIMULATOR_PERIOD = 3.0
"""s between two looks whether there is a simulator."""
TOUCH, PUSH = 0.5, 0.2
"""s that a touch and a push last."""
FORCES = (10, 200)
"""N."""
SPEEDS = {0.5: "half", 1.0: "1 x", 2.0: "2 x", 4.0: "4 x", 0.0: "as fast as possible"}
WAYS = {"ahead": 0.0, "to its left": math.pi / 2, "back": math.pi, "to its right": -math.pi / 2}


class SimulatorPanel:
    """Buttons and fields on one page.

    Args:
        view: The element `nao-robot-view` of the page, whose sensors can be clicked while there is a simulator.
    """

    def __init__(self, page: PageContext, views: RobotViews, view: Any) -> None:
        self._page = page
        self._views = views
        self._simulator = views.simulator
        self._view = view
        view.on("nao-touch", lambda event: self._clicked(event.args), ["detail"])
        self._holder = ui.column().classes("w-full")
        self._holder.set_visibility(False)
        self._built = False
        page.every(SIMULATOR_PERIOD, self._look)

    async def _look(self) -> None:
        there = await in_background(lambda: self._simulator.there)
        if there and not self._built:
            self._built = True
            speed = await in_background(self._simulator.speed)
            with self._holder:
                self._build(speed)
        if there != self._holder.visible:
            self._holder.set_visibility(there)
            self._view.props["touchable"] = "true" if there else "false"
            self._view.update()

    def _build(self, speed: float | None) -> None:
        with ui.card().classes("w-full nao-card"):
            ui.label("The simulator").classes("text-h6").props('role="heading" aria-level="2"')
            with ui.row().classes("items-center"):
                self._button("Pause", self._simulator.pause)
                self._button("Go on", self._simulator.resume)
                self._button("Reset", self._simulator.reset)
                speeds = SPEEDS if speed is None else {**SPEEDS, speed: SPEEDS.get(speed, f"{speed:g} x")}
                ui.select(speeds, value=speed, label="Speed", on_change=lambda e: self._do(
                    partial(self._simulator.set_speed, e.value), f"speed {speeds[e.value]}"
                )).props("dense outlined").classes("nao-speed")  # fmt: skip
            with ui.expansion("Touch it", value=True).classes("w-full"):
                ui.label("Click a sensor here, or a yellow spot on the robot.").classes("text-caption")
                with ui.row().classes("nao-sensors"):
                    for sensor in SENSORS:
                        touch = partial(self._simulator.touch, sensor.devices[:1], TOUCH)
                        self._button(sensor.name, touch, f"touches {sensor.name}")
            with ui.expansion("Push it").classes("w-full"), ui.row().classes("items-center"):
                force = ui.number("Force in N", value=60, min=FORCES[0], max=FORCES[1]).props("dense outlined")
                for way, angle in WAYS.items():
                    ui.button(way, on_click=partial(self._push, force, way, angle)).props("dense no-caps outline")
            with ui.expansion("Somebody says").classes("w-full"):
                self._build_person()
            with ui.expansion("Place a thing").classes("w-full"):
                self._build_things()

    def _build_person(self) -> None:
        text = ui.input("Text").props("dense outlined").classes("w-full")
        with ui.row().classes("items-center"):
            x, y = _number("x in m", 1.0), _number("y in m", 0.0)

            async def say() -> None:
                words = (text.value or "").strip()
                await self._do(lambda: self._simulator.person_says(words, x.value, y.value), f"a person says {words!r}")

            ui.button("Say", on_click=say).props("dense no-caps outline")
            text.on("keydown.enter", say)

    def _build_things(self) -> None:
        with ui.row().classes("items-center"):
            kind = ui.select(list(KINDS), value="ball", label="Kind").props("dense outlined")
            name = ui.input("Name", value="thing1").props("dense outlined")
            content = ui.input("Content").props("dense outlined")
            content.bind_visibility_from(kind, "value", backward=lambda value: value in CONTENTS)
            kind.on_value_change(lambda event: content.set_value(CONTENTS.get(event.value, "")))
            x, y, z = _number("x in m", 0.6), _number("y in m", 0.0), _number("z in m", 0.05)

        async def place() -> None:
            await self._do(
                lambda: self._simulator.place(name.value, kind.value, content.value or "", x.value, y.value, z.value),
                f"places {kind.value} {name.value!r}",
            )

        with ui.row():
            ui.button("Place", on_click=place).props("dense no-caps outline")
            ui.button(
                "Remove",
                on_click=lambda: self._do(lambda: self._simulator.remove(name.value), f"removes {name.value!r}"),
            ).props("dense no-caps outline")

    def _button(self, text: str, action: Callable[[], None], note: str = "") -> None:
        ui.button(text, on_click=lambda: self._do(action, note or text.lower())).props("dense no-caps outline")

    async def _clicked(self, arguments: Any) -> None:
        """A sensor of the robot was clicked; what comes from a browser may be anything."""
        detail = arguments.get("detail") if isinstance(arguments, dict) else None
        device = detail.get("device") if isinstance(detail, dict) else None
        if any(device in sensor.devices for sensor in SENSORS):
            await self._do(lambda: self._simulator.touch([device], TOUCH), f"touches {device}")

    async def _push(self, force: Any, way: str, angle: float) -> None:
        strength, heading = float(force.value or 0.0), self._views.live.heading + angle
        await self._do(lambda: self._simulator.push(strength, heading, PUSH), f"pushes it {way}, {strength:g} N")

    async def _do(self, action: Callable[[], None], note: str) -> None:
        """Carry something out for who may move the robot, and tell what went wrong."""
        if not self._page.operate(note):
            return
        self._page.robot.events.add("simulator", note, self._page.visitor.name)
        try:
            await in_background(action)
        except NaoError as error:
            self._page.failed(note, str(error))


def _number(label: str, value: float) -> Any:
    return ui.number(label, value=value, step=0.1, format="%.2f").props("dense outlined").classes("nao-number")
