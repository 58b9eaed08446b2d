"""The film process: `python -m nao_sim_bridge.render.film_worker FD ENGINE WORLD VERSION FILE VIEW WIDTH HEIGHT`.

It draws states and writes them with sound to a film. Over the inherited pipe FD it gets tuples (kind, content) and
first sends ("ready", engine) or ("error", text). Then it takes ("frame", (time, state)), ("sound", (first, bytes)) and
("caption", text) without an answer; ("end", None) is answered with ("ended", (frames, seconds)), or with
("error", text) of the first thing that went wrong. States are packed by `StateSender`. A pipe that is closed ends it,
and the film is complete until then.
"""

from __future__ import annotations

import os
import sys
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, Callable

from nao_sim_bridge.base.child_process import error_text, pipe_to_parent
from nao_sim_bridge.render.worker import quiet_import

SHARPNESS = 2
"""Rays along each edge of a pixel."""
NICENESS = 5
"""A film can wait; the simulation and the nodes of the robot cannot."""


def main(arguments: list[str]) -> int:
    """Serve one pipe until the film is complete."""
    descriptor, engine, world_name, version, file, view, width, height = arguments
    pipe = pipe_to_parent(descriptor, completes=True)
    os.nice(NICENESS)
    try:
        film, name = _open(engine, world_name, version, Path(file), view, (int(width), int(height)))
    except Exception as error:
        pipe.send(("error", error_text(error)))
        return 1
    pipe.send(("ready", name))
    try:
        _serve(pipe, film)
    except (BrokenPipeError, ConnectionResetError):
        pass  # the parent is gone
    return 0


class _Film:
    """What is drawn goes into the file."""

    def __init__(self, drawing: Any, camera: Any, file: Any) -> None:
        from nao_sim_bridge.world.render_state import StateReceiver

        self.file = file
        self._drawing = drawing
        self._camera = camera
        self._states = StateReceiver()

    def frame(self, content: Any) -> None:
        from nao_sim_bridge.render.scene.view import View

        time, packed = content
        state = self._states.unpack(packed)
        self.file.picture(self._drawing.draw(state, View.of_camera(self._camera.at(time, state))), time)

    def sound(self, content: Any) -> None:
        import numpy as np

        first, samples = content
        self.file.sound(np.frombuffer(samples, np.int16).reshape(-1, 2), first)

    def caption(self, text: str) -> None:
        self.file.caption = text


def _open(
    engine: str, world_name: str, version: str, file: Path, view: str, size: tuple[int, int]
) -> tuple[_Film, str]:
    quiet_import()
    from nao_sim_bridge.base.samples import RATE
    from nao_sim_bridge.model.model_reader import load_model
    from nao_sim_bridge.render.engines import open_engine
    from nao_sim_bridge.render.film_camera import FilmCamera
    from nao_sim_bridge.render.film_file import FilmFile
    from nao_sim_bridge.world.reader import load_world

    drawing, _ = open_engine(engine, load_world(world_name), version)
    camera = FilmCamera(view, load_model(version), *size, SHARPNESS)
    return _Film(drawing, camera, FilmFile(file, *size, RATE)), drawing.name


def _serve(pipe: Connection, film: _Film) -> None:
    kinds: dict[str, Callable[[Any], None]] = {"frame": film.frame, "sound": film.sound, "caption": film.caption}
    wrong = ""
    while True:
        try:
            kind, content = pipe.recv()
        except (EOFError, OSError):  # it may be closed in the middle of a message; nobody wants to know how it ends
            film.file.close()
            return
        try:
            if kind == "end":
                film.file.close()
            elif not wrong:
                kinds[kind](content)
        except Exception as error:
            wrong = wrong or error_text(error)
        if kind == "end":
            pipe.send(("error", wrong) if wrong else ("ended", (film.file.frames, film.file.duration)))
            return


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
