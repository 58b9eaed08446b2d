"""`nao sim`: what only a simulated robot can be asked."""

from __future__ import annotations

from typing import Any

import click

from ...core.errors import BadGoal
from ...core.fields import limit
from ...core.nao_facts import GROUPS, SENSORS, devices_of, names_of
from ..chain_text import Number
from ..cli_settings import CliSettings, NaoGroup, OneOf, SignedCommand, settings_of
from ..goals import start_node
from ..output import (
    CommandFailed,
    CommandInterrupted,
    bring,
    names_file,
    overwrite_option,
    passing_name,
    say_json,
    wanted_file,
)
from ..stack import SIMULATOR

VIEWS = ("front", "three_quarter", "side", "back", "stage", "far", "room", "robots", "face")
LONGER = 0.2
"""s by which a touch may last longer before that is said."""
LONGEST_FILM = limit("recording").highest
"""s of a film that ends with Ctrl-C."""
view_option = click.option("--view", type=OneOf(VIEWS), default="three_quarter", show_default=True, help="From where.")


@click.group(cls=NaoGroup, name="sim")
def sim_command() -> None:
    """Touch, push and picture a simulated robot, and rule its time."""


def _call(settings: CliSettings, name: str, kind: Any, **fields: Any) -> Any:
    """Call a service of the simulator."""
    stack = settings.stack
    service = stack.service(f"{SIMULATOR}/{name}")
    # Time that passes, and pictures on a busy computer, take as long as they take.
    answer = stack.graph.call(service, kind, kind._request_class(**fields), patient=True)
    if not getattr(answer, "success", True):
        raise CommandFailed(answer.message)
    return answer


def _complete_sensor(_context: click.Context, _parameter: click.Parameter, start: str) -> list[str]:
    words = [name.replace(" ", "_") for name in (*GROUPS, *names_of(SENSORS))]
    devices = [device for sensor in SENSORS for device in sensor.devices]
    return [word for word in (*words, *devices) if word.startswith(start)]


@sim_command.command("touch")
@click.argument("sensors", nargs=-1, metavar="[SENSOR]...", shell_complete=_complete_sensor)
@click.option("--for", "seconds", type=Number("timeout"), metavar="S", help="Let go after so long, in its time.")
@click.pass_context
def touch(context: click.Context, sensors: tuple[str, ...], seconds: float | None) -> None:
    """Press SENSORs until they are let go: `nao sim touch` without any lets go of all.

    A SENSOR is a word of NaoTactile (head, front_head, chest, ...), an event, or a device (Head/Touch/Front).
    With --for 0 they are let go at once: a tap.
    """
    from nao_library_msgs.srv import PressSensors

    settings = settings_of(context)
    try:
        devices = devices_of(sensors)
    except BadGoal as error:
        raise click.UsageError(str(error)) from None
    _call(settings, "press", PressSensors, sensors=devices)
    if seconds is not None:
        import rospy

        start_node()
        began = rospy.get_time()
        rospy.sleep(max(seconds, 0.1))  # a finger that comes and goes between two ticks was never there
        _call(settings, "press", PressSensors, sensors=[])
        held = rospy.get_time() - began
        if held > max(seconds, 0.1) + LONGER:
            text = f"held for {held:.2f} s, as this computer is busy: the service {SIMULATOR}/touch keeps its time"
            click.echo(text, err=True)
    if settings.json:
        say_json({"pressed": devices if seconds is None else []})


@sim_command.command("push", cls=SignedCommand)
@click.argument("force", nargs=3, type=Number("force"), metavar="X Y Z")
@click.option("--for", "seconds", type=Number("timeout"), default=0.1, show_default=True, metavar="S", help="How long.")
@click.option("--link", default="", help="Where: torso, Head, l_wrist, ...  [default: torso]")
@click.pass_context
def push(context: click.Context, force: tuple[float, float, float], seconds: float, link: str) -> None:
    """Push with a force X Y Z, in N, in the world."""
    import rospy
    from geometry_msgs.msg import Vector3

    from nao_library_msgs.srv import PushRobot

    settings = settings_of(context)
    _call(settings, "push", PushRobot, link=link, force=Vector3(*force), time=rospy.Duration.from_sec(seconds))
    if settings.json:
        say_json({"force": list(force), "time": seconds, "link": link or "torso"})


@sim_command.command("picture")
@click.argument("file", default="", type=click.Path())
@view_option
@click.option("--size", default="640x480", show_default=True, metavar="WxH", help="In pixels.")
@overwrite_option
@click.pass_context
def picture(context: click.Context, file: str, view: str, size: str, overwrite: bool) -> None:
    """Take a picture from outside, and put it into FILE or a folder; without, it stays in the simulator's folder."""
    from nao_library_msgs.srv import TakePicture

    settings = settings_of(context)
    target = wanted_file(file, overwrite)
    width, height = read_size(size)
    name = f"{passing_name()}.png" if names_file(target) else ""
    answer = _call(settings, "picture", TakePicture, view=view, width=width, height=height, file=name)
    path = bring(answer.path, target, overwrite)
    if settings.json:
        say_json({"path": path, "view": view})
    else:
        click.echo(path)


def read_size(text: str) -> tuple[int, int]:
    """Width and height in pixels from `640x480`. Raises click.UsageError if it is no size."""
    width, by, height = text.lower().partition("x")
    if not (by and width.isdigit() and height.isdigit()):
        raise click.UsageError(f"{text!r} is no size: 640x480")
    return int(width), int(height)


@sim_command.command("film")
@click.argument("file", default="", type=click.Path())
@click.option(
    "--for", "seconds", type=Number("recording"), metavar="S", help="How long, in its time; without: until Ctrl-C."
)
@view_option
@click.option("--size", default="480x480", show_default=True, metavar="WxH", help="In pixels, even numbers.")
@click.option(
    "--rate", type=Number("frame rate"), default=20.0, show_default=True, metavar="HZ", help="Frames a second."
)
@click.option("--caption", default="", metavar="TEXT", help="A line of text in the film.")
@overwrite_option
@click.pass_context
def film(
    context: click.Context,
    file: str,
    seconds: float | None,
    view: str,
    size: str,
    rate: float,
    caption: str,
    overwrite: bool,
) -> None:
    """Film from outside, with what the robot says, into FILE (mp4) or a folder.

    Without FILE it stays in the simulator's folder. A film that Ctrl-C ends is complete.
    """
    import rospy

    from nao_library_msgs.srv import CaptionFilm, StartFilm, StopFilm

    settings = settings_of(context)
    target = wanted_file(file, overwrite, ["mp4"])
    width, height = read_size(size)
    name = f"{passing_name()}.mp4" if names_file(target) else ""
    start_node()
    _call(settings, "film/start", StartFilm, file=name, view=view, width=width, height=height, frame_rate=rate)
    try:
        if caption:
            _call(settings, "film/caption", CaptionFilm, text=caption)
        rospy.sleep(LONGEST_FILM if seconds is None else seconds)
    except KeyboardInterrupt:
        if seconds is not None:
            raise CommandInterrupted("the film ended before its time") from None
    finally:
        answer = _call(settings, "film/stop", StopFilm)
        path = bring(answer.path, target, overwrite)
        if settings.json:
            say_json({"path": path, "view": view, "frames": answer.frames, "duration": answer.length})
        else:
            click.echo(f"{path}: {answer.length.to_sec():.2f} s")


@sim_command.command("advance")
@click.argument("seconds", type=Number("wait"))
@click.pass_context
def advance(context: click.Context, seconds: float) -> None:
    """Let SECONDS of simulated time pass as fast as possible; answers the time afterwards."""
    import rospy

    from nao_library_msgs.srv import AdvanceTime

    settings = settings_of(context)
    answer = _call(settings, "advance", AdvanceTime, time=rospy.Duration.from_sec(seconds))
    if settings.json:
        say_json({"time": answer.now})
    else:
        click.echo(f"{answer.now.to_sec():.3f}")


def _plain_command(name: str, text: str) -> None:
    @sim_command.command(name, help=text)
    @click.pass_context
    def run(context: click.Context) -> None:
        from std_srvs.srv import Empty

        settings = settings_of(context)
        _call(settings, name, Empty)
        if settings.json:
            say_json({})


_plain_command("reset", "Put robot and things back to where they began.")
_plain_command("pause", "Stop time.")
_plain_command("resume", "Let time go on.")
