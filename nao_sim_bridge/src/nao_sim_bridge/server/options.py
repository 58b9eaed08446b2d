"""How a simulator is started."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from nao_sim_bridge.base.record_dir import DEFAULT_RECORD_DIR
from nao_sim_bridge.core.scene import Scene
from nao_sim_bridge.world.places import RobotPlace


@dataclass(frozen=True)
class ServerOptions:
    """How a simulated robot is started.

    Attributes:
        scene: World, robot version, posture, seed.
        port: Port; 0 takes a free one.
        speed: Simulated seconds per wall second, infinity for as fast as possible.
        gui: Show the robot in a window.
        record_dir: Folder for files of clients; "~" stands for the home of the user.
        sound_file: Name in `record_dir` of a WAV for everything that the loudspeakers play; empty for none.
        sound_card: Let it be heard on this computer, too; only at speed 1.
        renderer: What draws: "auto", "opengl" or "builtin"; see `Renderer`.
        robots: How many there are in the world; with more than one the port is that of the first.
        places: Where they stand; empty for where the world says, or else the usual places.
        allow_private_streams: Whether playWebStream may fetch from this computer and from private networks.
    """

    scene: Scene = field(default_factory=Scene)
    address: str = "127.0.0.1"
    port: int = 9559
    speed: float = 1.0
    paused: bool = False
    gui: bool = False
    record_dir: Path = DEFAULT_RECORD_DIR
    sound_file: str = ""
    sound_card: bool = False
    renderer: str = "auto"
    name: str = "nao"
    robots: int = 1
    places: tuple[RobotPlace, ...] = ()
    allow_private_streams: bool = False
