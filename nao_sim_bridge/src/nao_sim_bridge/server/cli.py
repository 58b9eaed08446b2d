"""Command line of the simulator, with and without ROS."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING, Callable, Sequence

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.limits import kind, world_kind
from nao_sim_bridge.base.record_dir import DEFAULT_RECORD_DIR
from nao_sim_bridge.base.renderers import RENDERERS
from nao_sim_bridge.base.whole_file import write_whole
from nao_sim_bridge.core.simulation import Scene
from nao_sim_bridge.model.postures import load_postures
from nao_sim_bridge.model.robot_model import VERSIONS
from nao_sim_bridge.server.options import ServerOptions
from nao_sim_bridge.world.places import MOST_ROBOTS, RobotPlace, parse_places
from nao_sim_bridge.world.reader import world_names

if TYPE_CHECKING:
    from nao_sim_bridge.server.robots_server import RobotsServer
    from nao_sim_bridge.server.simulator_server import SimulatorServer

# Options that have the names of attributes of the scene, and of the server.
OF_SCENE = "world posture seed friction payload sensor_noise sensor_delay charger".split()
OF_SERVER = (
    "port speed paused gui record_dir sound_file sound_card renderer robots places allow_private_streams"
).split()


def parser(prog: str) -> argparse.ArgumentParser:
    """The options of `nao_sim` and of `python -m nao_sim_bridge`."""
    options = argparse.ArgumentParser(
        prog=prog,
        description="A physically simulated NAO that serves NAOqi's modules over libqi.",
        formatter_class=argparse.ArgumentDefaultsHelpFormatter,
    )
    options.add_argument("--port", type=_port, default=9559, help="port to listen on; 0: the system gives one")
    options.add_argument(
        "--port-file",
        default="",
        metavar="FILE",
        help="write the ports there, one a line, when it listens; empty: no",
    )
    options.add_argument("--listen", default="127.0.0.1", help="address to listen on; 0.0.0.0 for the whole network")
    options.add_argument(
        "--speed", type=_speed, default=1.0, help="simulated seconds per second; 0 or max: as fast as possible"
    )
    options.add_argument("--gui", action="store_true", help="show the robot in a window")
    options.add_argument("--world", default="empty", help=f"world file, or one of: {', '.join(world_names())}")
    options.add_argument("--seed", type=int, default=0, help="seed of all random numbers")
    options.add_argument("--robot", choices=VERSIONS, default="V6", help="robot version")
    options.add_argument(
        "--posture", choices=sorted(load_postures().by_name), default="Crouch", help="posture at the start"
    )
    options.add_argument(
        "--friction", type=_friction, default="world", help="coefficient between soles and floor; world: as it says"
    )
    options.add_argument(
        "--payload", type=_amount("payload"), default=0.0, help="mass that the torso carries besides its own, kg"
    )
    options.add_argument(
        "--sensor-noise",
        type=_amount("sensor_noise"),
        default=0.0,
        help="errors of the sensors: 0 none, 1 as those of a real robot",
    )
    options.add_argument(
        "--sensor-delay", type=_amount("sensor_delay"), default=0.0, help="how late readings of sensors arrive, s"
    )
    options.add_argument("--charger", action="store_true", help="the charger is plugged in from the start")
    options.add_argument(
        "--record-dir",
        type=Path,
        default=DEFAULT_RECORD_DIR,
        help="folder of the robot's files, its /home/nao: recordings, pictures and others",
    )
    options.add_argument(
        "--sound-file",
        default="",
        metavar="FILE",
        help="keep everything that the loudspeakers play as this WAV, a name inside the folder above; empty: don't",
    )
    options.add_argument(
        "--sound-card", action="store_true", help="let it be heard on this computer, too (at speed 1; needs PortAudio)"
    )
    options.add_argument(
        "--renderer",
        choices=RENDERERS,
        default="auto",
        help="what draws what the cameras see: opengl, builtin (slower), or auto: OpenGL where it can be had",
    )
    options.add_argument(
        "--robots",
        type=_robots,
        default=1,
        help=f"how many robots there are, up to {MOST_ROBOTS}, on as many ports: nao1, nao2...",
    )
    options.add_argument(
        "--places",
        type=_places,
        default="",
        metavar="X,Y,HEADING;...",
        help="where they stand, in m and deg; empty: where the world says, or on a circle, facing each other",
    )
    options.add_argument(
        "--allow-private-streams",
        action="store_true",
        help="playWebStream may fetch from this computer and from private networks",
    )
    options.add_argument("--paused", action="store_true", help="start without time passing")
    options.add_argument("--verbose", action="store_true", help="log more")
    return options


def server_options(arguments: argparse.Namespace) -> ServerOptions:
    """Options of the server from parsed arguments."""
    given = vars(arguments)
    scene = Scene(version=arguments.robot, **{name: given[name] for name in OF_SCENE})
    return ServerOptions(scene, arguments.listen, **{name: given[name] for name in OF_SERVER})


def parse(prog: str, arguments: Sequence[str] | None = None) -> argparse.Namespace:
    """Parsed command line; ends the program with a clear text when it is wrong."""
    return parser(prog).parse_args(arguments)


def tell_ports(server: SimulatorServer | RobotsServer, file: str) -> None:
    """For programs: the address of each robot, a line each on standard output, and the ports in a file if wanted."""
    robots = getattr(server, "servers", (server,))
    for robot in robots:
        print(f"tcp://{robot.options.address}:{robot.broker.port}", flush=True)
    if file:
        write_whole(Path(file).expanduser(), "".join(f"{robot.broker.port}\n" for robot in robots).encode())


def _speed(text: str) -> float:
    if text in ("max", "0"):
        return math.inf
    try:
        speed = float(text)
    except ValueError:
        speed = math.nan
    if speed == 0.0:
        return math.inf
    pace = kind("pace")
    if not pace.fits(speed):
        raise argparse.ArgumentTypeError(
            f"{text!r} is not a speed: a number above 0, or max ({pace.smallest:g} to {pace.highest:g})"
        )
    return speed


def _friction(text: str) -> float | None:
    return None if text == "world" else _amount("friction")(text)


def _amount(option: str) -> Callable[[str], float]:
    most = world_kind(option).highest

    def amount(text: str) -> float:
        try:
            number = float(text)
        except ValueError:
            number = math.nan
        if not 0.0 <= number <= most:
            raise argparse.ArgumentTypeError(f"{text!r} is not an amount: a number of 0 or more, {most:g} at most")
        return number

    return amount


def _robots(text: str) -> int:
    if not text.isdigit() or not 1 <= int(text) <= MOST_ROBOTS:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of robots: 1 to {MOST_ROBOTS}")
    return int(text)


def _places(text: str) -> tuple[RobotPlace, ...]:
    try:
        return parse_places(text) if text.strip() else ()
    except BadValue as error:
        raise argparse.ArgumentTypeError(str(error)) from error


def _port(text: str) -> int:
    if not text.isdigit() or int(text) > 65535:
        raise argparse.ArgumentTypeError(f"{text!r} is not a port: 0 to 65535")
    return int(text)
