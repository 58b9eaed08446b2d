"""The picture process: `python -m nao_sim_bridge.render.worker FD (pictures:ENGINE|window) WORLD VERSION`.

It talks over the inherited pipe FD in tuples (kind, content). First it sends ("ready", (engine, complaint or None)),
of a window ("ready", None), or ("error", text). Then it answers ("render", (state, camera)) with ("picture", shape)
and the raw pixels, ("capture", (state, shot)) with ("picture", None) and the bytes of the camera, or with
("error", text); ("show", state) is answered with ("shown", None). States are packed by `StateSender`. It ends when
the pipe is closed.
"""

from __future__ import annotations

import os
import sys
from multiprocessing.connection import Connection
from typing import Any

from nao_sim_bridge.base.child_process import error_text, pipe_to_parent


def main(arguments: list[str]) -> int:
    """Serve one pipe until it is closed."""
    descriptor, mode, world_name, version = arguments
    pipe = pipe_to_parent(descriptor)
    try:
        if mode == "window":
            serve, told = _open_window(pipe, world_name, version), None
        else:
            serve, told = _open_pictures(pipe, mode.partition(":")[2], world_name, version)
    except Exception as error:
        pipe.send(("error", error_text(error)))
        return 1
    pipe.send(("ready", told))
    try:
        serve()
    except (EOFError, BrokenPipeError, ConnectionResetError):
        pass  # the parent is gone or wants no more
    return 0


def quiet_import() -> None:
    """Import PyBullet without the line it prints then."""
    sys.stderr.flush()
    kept, silence = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    os.dup2(silence, 2)
    try:
        import nao_sim_bridge.base.engine  # noqa: F401
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(silence)


def _open_pictures(pipe: Connection, engine: str, world_name: str, version: str) -> tuple[Any, Any]:
    """Build what draws; returns what serves the pipe, and what draws with a complaint about it or None."""
    quiet_import()
    import cv2

    from nao_sim_bridge.cameras.sensor import photograph
    from nao_sim_bridge.render.engines import open_engine
    from nao_sim_bridge.render.scene.view import View
    from nao_sim_bridge.world.reader import load_world
    from nao_sim_bridge.world.render_state import StateReceiver

    cv2.setNumThreads(1)  # the other cores are for physics
    drawing, complaint = open_engine(engine, load_world(world_name), version)
    states = StateReceiver()

    def render(state: Any, camera: Any) -> tuple[tuple, Any]:
        picture = drawing.draw(state, View.of_camera(camera))
        return picture.shape, picture.tobytes()

    def capture(state: Any, shot: Any) -> tuple[None, Any]:
        return None, photograph(drawing.draw(state, View.of_shot(shot)), shot)

    answers = {"render": render, "capture": capture}

    def serve() -> None:
        while True:
            kind, (packed, subject) = pipe.recv()
            state = states.unpack(packed)
            try:
                told, pixels = answers[kind](state, subject)
            except Exception as error:
                pipe.send(("error", error_text(error)))
                continue
            pipe.send(("picture", told))
            pipe.send_bytes(pixels)

    return serve, (drawing.name, complaint)


def _open_window(pipe: Connection, world_name: str, version: str) -> Any:
    """Open the window; returns what serves the pipe."""
    quiet_import()
    from nao_sim_bridge.render.window import Window
    from nao_sim_bridge.world.reader import load_world

    return Window(pipe, load_world(world_name), version).serve


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
