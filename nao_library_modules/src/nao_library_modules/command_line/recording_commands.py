"""`nao photo` and `nao record`: pictures, videos, sounds, motions, behaviours."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import click

from .errors import CommandFailed, Interrupted
from .goals import GoalEnd, GoalRun, fail, function_message, run_functions, show
from .output import say_json
from .settings import NaoCommand, NaoGroup, Settings, settings_of
from .simulator_commands import bring, read_size

VISION, AUDIO_IN, MOTION, BEHAVIOR = "NaoVision", "nao_audio_in", "NaoMotion", "NaoBehavior"
LONGEST = 3600.0
"""s of a recording that ends with Ctrl-C; servers take no longer ones."""


@click.command(cls=NaoCommand, name="photo")
@click.argument("file", default="", type=click.Path())
@click.option("--camera", type=click.Choice(("top", "bottom")), default="top", show_default=True, help="Which one.")
@click.option("--size", default="", metavar="WxH", help="In pixels; as the camera has them without.")
@click.pass_context
def photo_command(context: click.Context, file: str, camera: str, size: str) -> None:
    """Take a picture and put it into FILE; without, it stays in the server's folder."""
    settings = settings_of(context)
    width, height = read_size(size) if size else (0, 0)
    message = function_message(
        settings,
        VISION,
        function="takePicture",
        camera=camera,
        width=width,
        height=height,
        str_param=f"photo-{os.getpid()}" if file else "",
        file_type=Path(file).suffix.lstrip(".").lower().replace("jpeg", "jpg"),
        overwrite=True,
    )
    end = run_functions(settings, VISION, [message])
    _bring_file(settings, end, "pictures", file)


@click.group(cls=NaoGroup, name="record", context_settings={"help_option_names": ["-h", "--help"]})
def record_command() -> None:
    """Record a video, a sound, a motion or a behaviour, for a time or until Ctrl-C."""


def _seconds_option(text: str) -> Any:
    return click.option("--for", "seconds", type=click.FloatRange(min=0.0, min_open=True), metavar="S", help=text)


@record_command.command("video")
@click.argument("file", default="", type=click.Path())
@_seconds_option("How long, in the robot's time; without: until Ctrl-C.")
@click.option("--camera", type=click.Choice(("top", "bottom")), default="top", show_default=True, help="Which one.")
@click.option("--rate", type=float, metavar="HZ", help="At most so many frames a second.")
@click.pass_context
def video(context: click.Context, file: str, seconds: float | None, camera: str, rate: float | None) -> None:
    """Record a video into FILE (mp4, avi); without, it stays in the server's folder."""
    import rospy

    settings = settings_of(context)
    ident = f"nao-{os.getpid()}"
    start = function_message(
        settings,
        VISION,
        function="startRecording",
        id=ident,
        camera=camera,
        rate=rate,
        str_param=ident if file else "",
        file_type=Path(file).suffix.lstrip(".").lower(),
        overwrite=True,
        time=rospy.Duration.from_sec(seconds or LONGEST),
    )
    stop = function_message(settings, VISION, function="deleteThread", id=ident)
    try:
        end = _until_interrupt(settings, VISION, [start, stop], seconds)
        if not end.succeeded:  # what was begun goes on by itself
            end = run_functions(settings, VISION, [stop])
    except Interrupted:
        run_functions(settings, VISION, [stop])
        raise
    _bring_file(settings, end, "recordings", file)


@record_command.command("sound")
@click.argument("file", default="recording.wav")
@_seconds_option("How long, in the robot's time; without: until Ctrl-C.")
@click.option("--channels", default="", metavar="NAMES", help="Of left, right, front and rear, with commas between.")
@click.pass_context
def sound(context: click.Context, file: str, seconds: float | None, channels: str) -> None:
    """Record what the microphones hear into FILE (wav, ogg) in the robot's folder for sounds."""
    settings = settings_of(context)
    message = function_message(
        settings,
        AUDIO_IN,
        function="record",
        str_param=file,
        duration=seconds or LONGEST,
        channels=[name.strip() for name in channels.split(",") if name.strip()],
    )
    end = _until_interrupt(settings, AUDIO_IN, [message], seconds)
    show(settings, end)


@record_command.command("motion")
@click.argument("name")
@click.argument("joints", nargs=-1)
@_seconds_option("How long, in the robot's time; without: until Ctrl-C.")
@click.option("--limp", is_flag=True, help="The joints can be moved by hand meanwhile.")
@click.pass_context
def motion(context: click.Context, name: str, joints: tuple[str, ...], seconds: float | None, limp: bool) -> None:
    """Record JOINTS (all without) as the motion NAME; playMotion of NaoMotion replays it."""
    settings = settings_of(context)
    message = function_message(
        settings,
        MOTION,
        function="recordMotion",
        str_param=name,
        names=list(joints) or ["Body"],
        duration=seconds or LONGEST,
        limp=limp,
    )
    end = _until_interrupt(settings, MOTION, [message], seconds)
    show(settings, end)


@record_command.command("behavior")
@click.argument("name")
@_seconds_option("How long, in the robot's time; without: until Ctrl-C.")
@click.option("--overwrite", is_flag=True, help="Replace one of that name.")
@click.pass_context
def behavior(context: click.Context, name: str, seconds: float | None, overwrite: bool) -> None:
    """Keep what is sent to the servers meanwhile as the behaviour NAME; `nao run NAME` does it again."""
    settings = settings_of(context)
    message = function_message(
        settings,
        BEHAVIOR,
        function="recordBehavior",
        str_param=name,
        duration=seconds or LONGEST,
        overwrite=overwrite,
    )
    end = _until_interrupt(settings, BEHAVIOR, [message], seconds)
    show(settings, end)


def _until_interrupt(settings: Settings, server: str, functions: list[Any], seconds: float | None) -> GoalEnd:
    """Run a recording. Without a time Ctrl-C is how it ends, and no interruption."""
    run = GoalRun(settings, server)
    try:
        end = run.run(functions)
    except Interrupted:
        if seconds is not None or run.last is None:
            raise
        return run.last
    if not end.succeeded:
        fail(settings, end)
    return end


def _bring_file(settings: Settings, end: GoalEnd, field: str, file: str) -> None:
    """Put the file that a goal has written where it is wanted, and tell of it."""
    files = end.result.get(field) or []
    if not files:
        raise CommandFailed(end.text or "there is no file")
    described = files[-1]
    if described.get("error"):
        raise CommandFailed(described["error"])
    described["path"] = bring(described["path"], file)
    if settings.json:
        say_json(described)
    else:
        click.echo(described["path"])
