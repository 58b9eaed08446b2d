"""The element with the tracks of a behaviour: draws them in the browser, and tells what is done to them there."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any

from nicegui import ui

from ..timeline.tracks import Tracks

MODULE = "/console/static/timeline.js"
KEYS = (
    "Arrow keys choose a step; Shift+Left and Shift+Right move it; [ and ] make it shorter and longer, { and } by 1 s; "
    "D doubles it, Delete removes it, Enter edits it; + and - zoom, 0 shows all; Ctrl+Z and Ctrl+Y undo and redo."
)


class TimelineCanvas:
    """Tracks in the container that is open.

    Args:
        chosen: Called with the path of a step that was chosen.
        edited: Called with the name of an edit (shift, stretch, move, key) and what belongs to it.
    """

    def __init__(self, chosen: Callable[[str], Any], edited: Callable[[str, Mapping[str, Any]], Any]) -> None:
        self._element = ui.element("div").classes("nao-timeline w-full").style("max-height: 48vh; min-height: 7rem")
        self._element.props["role"] = "group"
        self._element.props["aria-label"] = f"Tracks of the behaviour. {KEYS}"
        self._servers = ui.row().classes("gap-3 items-center")
        emit = "(event) => emit(event.detail)"
        self._element.on("tlselect", lambda event: chosen(str(event.args["path"])), js_handler=emit)
        self._shown: list[str] = []
        for name in ("shift", "stretch", "move", "key"):
            self._element.on(f"tl{name}", lambda event, name=name: edited(name, event.args), js_handler=emit)

    def show(self, tracks: Tracks, selected: str, whole: bool = False) -> None:
        """Draw tracks. `whole`: zoom such that all of them are seen."""
        self._call("show", tracks.to_json(), selected, whole)
        servers = sorted({box.server for box in tracks.boxes if box.server}, key=str.lower)
        if servers != self._shown:
            self._shown = servers
            self._servers.clear()
            with self._servers:
                for server in servers:
                    with ui.row().classes("items-center gap-1 no-wrap"):
                        ui.element("span").classes("tl-colour").props["data-server"] = server
                        ui.label(server).classes("text-xs")

    def mark(self, states: Mapping[str, str], at: float | None) -> None:
        """Show states of steps by path, and a cursor. `at`: s from the beginning; None: no cursor."""
        self._call("mark", dict(states), at)

    def zoom(self, factor: float) -> None:
        """Zoom; 0: to the whole."""
        self._call("zoom", factor)

    def _call(self, name: str, *arguments: Any) -> None:
        given = ", ".join(map(json.dumps, (self._element.html_id, *arguments)))
        with self._element:
            ui.run_javascript(f"import({json.dumps(MODULE)}).then((timeline) => timeline.{name}({given}))")
