"""The picture process: `python -m nao_sim_bridge.sim.render.worker FD (pictures|window) WORLD VERSION`.

It talks over the inherited pipe FD in tuples (kind, content). First it sends ("ready", None) or
("error", text). Then it answers ("render", (state, camera)) with ("picture", shape) and the raw pixels, or
with ("error", text); ("show", state) is answered with ("shown", None). It ends when the pipe is closed.
"""

from __future__ import annotations

import os
import sys
from multiprocessing.connection import Connection
from typing import Any

from nao_sim_bridge.sim.child_process import error_text, pipe_to_parent


def main(arguments: list[str]) -> int:
    """Serve one pipe until it is closed."""
    descriptor, mode, world_name, version = arguments
    pipe = pipe_to_parent(descriptor)
    try:
        serve = (
            _open_pictures(pipe, world_name, version) if mode == "pictures" else _open_window(pipe, world_name, version)
        )
    except Exception as error:
        pipe.send(("error", error_text(error)))
        return 1
    pipe.send(("ready", None))
    try:
        serve()
    except (EOFError, BrokenPipeError, ConnectionResetError):
        pass  # the parent is gone or wants no more
    return 0


def _quiet_import() -> Any:
    """PyBullet, without the line it prints on import."""
    sys.stderr.flush()
    kept, silence = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    os.dup2(silence, 2)
    try:
        import pybullet
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(silence)
    return pybullet


def _open_pictures(pipe: Connection, world_name: str, version: str) -> Any:
    """Build the studio; returns what serves the pipe."""
    _quiet_import()
    from nao_sim_bridge.sim.render.studio import Studio
    from nao_sim_bridge.sim.world import load_world

    studio = Studio(load_world(world_name), version)

    def serve() -> None:
        while True:
            _, (state, camera) = pipe.recv()
            try:
                picture = studio.take(state, camera)
            except Exception as error:
                pipe.send(("error", error_text(error)))
                continue
            pipe.send(("picture", picture.shape))
            pipe.send_bytes(picture.tobytes())

    return serve


def _open_window(pipe: Connection, world_name: str, version: str) -> Any:
    """Open the window; returns what serves the pipe."""
    _quiet_import()
    from nao_sim_bridge.sim.render.window import Window
    from nao_sim_bridge.sim.world import load_world

    return Window(pipe, load_world(world_name), version).serve


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
