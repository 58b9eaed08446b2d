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
        film, kinds, name = _open(engine, world_name, version, Path(file), view, (int(width), int(height)))
    except Exception as error:
        pipe.send(("error", error_text(error)))
        return 1
    pipe.send(("ready", name))
    try:
        _serve(pipe, film, kinds)
    except (BrokenPipeError, ConnectionResetError):
        pass  # the parent is gone
    return 0


def _open(
    engine: str, world_name: str, version: str, file: Path, view: str, size: tuple[int, int]
) -> tuple[Any, dict[str, Callable[[Any], None]], str]:
    """The file, what becomes of each kind of request, and what draws."""
    quiet_import()
    import numpy as np

    from nao_sim_bridge.base.samples import RATE
    from nao_sim_bridge.model.model_reader import load_model
    from nao_sim_bridge.render.engines import open_engine
    from nao_sim_bridge.render.film_camera import FilmCamera
    from nao_sim_bridge.render.film_file import FilmFile
    from nao_sim_bridge.render.scene.view import View
    from nao_sim_bridge.world.reader import load_world
    from nao_sim_bridge.world.render_state import StateReceiver

    drawing, _ = open_engine(engine, load_world(world_name), version)
    camera = FilmCamera(view, load_model(version), *size, SHARPNESS)
    film, states = FilmFile(file, *size, RATE), StateReceiver()

    def frame(content: Any) -> None:
        time, packed = content
        state = states.unpack(packed)
        film.picture(drawing.draw(state, View.of_camera(camera.at(time, state))), time)

    def sound(content: Any) -> None:
        first, samples = content
        film.sound(np.frombuffer(samples, np.int16).reshape(-1, 2), first)

    def caption(text: str) -> None:
        film.caption = text

    return film, {"frame": frame, "sound": sound, "caption": caption}, drawing.name


def _serve(pipe: Connection, film: Any, kinds: dict[str, Callable[[Any], None]]) -> None:
    wrong = ""
    while True:
        try:
            kind, content = pipe.recv()
        except (EOFError, OSError):  # it may be closed in the middle of a message; nobody wants to know how it ends
            film.close()
            return
        try:
            if kind == "end":
                film.close()
            elif not wrong:
                kinds[kind](content)
        except Exception as error:
            wrong = wrong or error_text(error)
        if kind == "end":
            pipe.send(("error", wrong) if wrong else ("ended", (film.frames, film.duration)))
            return


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
