"""How a simulator is started."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from nao_sim_bridge.base.record_dir import DEFAULT_RECORD_DIR
from nao_sim_bridge.core.scene import Scene
from nao_sim_bridge.world.places import RobotPlace


@dataclass(frozen=True)
class ServerOptions:
    """How a simulated robot is started."""

    scene: Scene = field(default_factory=Scene)  # world, robot version, posture, seed
    address: str = "127.0.0.1"
    port: int = 9559  # 0: the system gives one
    speed: float = 1.0  # simulated seconds per wall second, infinity for as fast as possible
    paused: bool = False
    gui: bool = False  # show the robot in a window
    record_dir: Path = DEFAULT_RECORD_DIR  # folder for files of clients; "~" stands for the home of the user
    sound_file: str = ""  # name in `record_dir` of a WAV for everything that the loudspeakers play; empty for none
    sound_card: bool = False  # let it be heard on this computer, too; only at speed 1
    renderer: str = "auto"  # what draws: "auto", "opengl" or "builtin"; see `Renderer`
    name: str = "nao"
    robots: int = 1  # how many there are in the world; with more than one the port is that of the first
    places: tuple[RobotPlace, ...] = ()  # where they stand; empty for where the world says, or else the usual places
    allow_private_streams: bool = False  # whether playWebStream may fetch from this computer and from private networks
    ports: tuple[int, ...] = ()  # of the robots, instead of `port`: those that they had before; 0 as there
