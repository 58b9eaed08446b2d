"""`nao say`, `leds`, `pose`, `walk`, `wake`, `rest`: one thing that the robot does; and `nao stop`: nothing goes on."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Collection, Mapping
from typing import Any

import click

from ..chain_text import Angle, Number
from ..cli_settings import NaoCommand, SignedCommand, settings_of
from ..completion import choices
from ..direct_robot import DirectRobot
from ..goals import carry_out, function_message, start_node
from ..output import say_json

AUDIO_OUT, LIGHTS, MOTION = "nao_audio_out", "NaoLights", "NaoMotion"
FAR = 3.0
"""m of a walk that take longer than somebody expects who meant cm."""
SWITCHES = ("on", "off", "reset")
"""What lights can be besides a colour and an intensity: functions of their own."""


def _complete_look(context: click.Context, parameter: click.Parameter, start: str) -> list[str]:
    lights, colours = (choices(LIGHTS, "setColor", each)(context, parameter, start) for each in ("lights", "str_param"))
    return [*lights, *colours, *(word for word in SWITCHES if word.startswith(start))]


@click.command(cls=NaoCommand, name="say")
@click.argument("text", nargs=-1, required=True)
@click.option("--language", metavar="NAME", shell_complete=choices(AUDIO_OUT, "say", "language"), help="Of this text.")
@click.option("--voice", metavar="NAME", shell_complete=choices(AUDIO_OUT, "say", "voice"), help="For this text.")
@click.option("--volume", type=float, metavar="0..1", help="Of this text.")
@click.option("--speed", type=float, metavar="%", help="50 to 400, 100 is normal.")
@click.option("--pitch", type=float, metavar="%", help="50 to 200, 100 is normal.")
@click.option("--animated", is_flag=True, help="With gestures.")
@click.option("--background", is_flag=True, help="Do not wait for the end.")
@click.pass_context
def say_command(context: click.Context, text: tuple[str, ...], animated: bool, **fields: Any) -> None:
    """Say TEXT."""
    settings = settings_of(context)
    if animated:
        fields.pop("background")
    function = "animatedSay" if animated else "say"
    message = function_message(settings, AUDIO_OUT, function=function, str_param=" ".join(text), **fields)
    carry_out(settings, AUDIO_OUT, [message], quiet=True)


@click.command(cls=SignedCommand, name="leds")
@click.argument("lights", nargs=-1, required=True, shell_complete=_complete_look, metavar="LIGHT... LOOK")
@click.option("--for", "seconds", type=Number("wait"), metavar="S", help="Wait so long afterwards.")
@click.option("--fade", "duration", type=Number("wait"), metavar="S", help="Take so long to get there.")
@click.option("--revert", is_flag=True, help="Afterwards the lights go back to what they were.")
@click.pass_context
def leds_command(
    context: click.Context, lights: tuple[str, ...], seconds: float | None, duration: float | None, revert: bool
) -> None:
    """Set LIGHTs to a LOOK: a colour (green, '#FF8000'), an intensity 0..1, on, off or reset."""
    if len(lights) < 2:
        raise click.UsageError("lights and their look are wanted: nao leds FaceLeds green")
    settings = settings_of(context)
    *names, look = lights
    fields: dict[str, Any] = {"lights": names, "revert": revert}
    if seconds is not None:
        import rospy

        fields["time"] = rospy.Duration.from_sec(seconds)
    intensity = _number(look)
    if any(_number(name) is not None for name in names):
        raise click.UsageError("one look is wanted: a colour by its name or as '#FF8000', an intensity 0..1: --help")
    if intensity is not None:
        fields.update(function="setIntensity" if duration is None else "fade", i_values=[intensity], duration=duration)
    elif look in SWITCHES:
        if duration is not None:
            raise click.UsageError(f"{look} takes no time: --fade is for colours and intensities")
        fields.update(function=look)
    else:
        fields.update(function="setColor" if duration is None else "fadeRGB", str_param=look, duration=duration)
    carry_out(settings, LIGHTS, [function_message(settings, LIGHTS, **fields)], quiet=True)


def _number(text: str) -> float | None:
    try:
        return float(text)
    except ValueError:
        return None


@click.command(cls=NaoCommand, name="pose")
@click.argument("posture", default="", shell_complete=choices(MOTION, "goToPosture", "str_param"))
@click.option("--speed", type=float, metavar="0..1", help="Fraction of the top speed.")
@click.pass_context
def pose_command(context: click.Context, posture: str, speed: float | None) -> None:
    """Go to a POSTURE from wherever the robot is."""
    settings = settings_of(context)
    if not posture:
        known = choices(MOTION, "goToPosture", "str_param")(context, None, "")
        raise click.UsageError(f"a posture is wanted: {', '.join(known) or 'nao pose StandInit'}")
    message = function_message(settings, MOTION, function="goToPosture", str_param=posture, speed=speed)
    carry_out(settings, MOTION, [message], quiet=True)


@click.command(cls=SignedCommand, name="walk")
@click.argument("x", type=Number("way"))
@click.argument("y", type=Number("way"), default=0.0)
@click.argument("theta", type=Angle(), default=0.0)
@click.pass_context
def walk_command(context: click.Context, x: float, y: float, theta: float) -> None:
    """Walk X m ahead and Y m to the left, and turn THETA rad (or 90deg) to the left; answers how far it got.

    A robot that does not stand stands up before.
    """
    settings = settings_of(context)
    if math.hypot(x, y) > FAR:
        click.echo(f"{math.hypot(x, y):g} m take a while; Ctrl-C stops the robot", err=True)
    stand = function_message(settings, MOTION, function="goToPosture", str_param="StandInit")
    walk = function_message(settings, MOTION, function="moveTo", values=[x, y, theta])
    end = carry_out(settings, MOTION, [walk] if _stands(settings) else [stand, walk], quiet=True)
    if not settings.json:
        far = dict(zip(("m ahead", "m to the left", "rad to the left"), end.result["results"][-1]["values"]))
        click.echo(", ".join(f"{float(value):.3f} {unit}" for unit, value in far.items()))


def _stands(settings: Any) -> bool:
    """Whether the robot is awake and on its feet."""
    with DirectRobot(settings.stack.robot_address()) as robot:
        awake = robot.call("ALMotion", "robotIsWakeUp")
        return bool(awake and robot.call("ALRobotPosture", "getPostureFamily") == "Standing")


def _one_function(name: str, function: str, text: str) -> click.Command:
    @click.command(cls=NaoCommand, name=name, help=text)
    @click.pass_context
    def run(context: click.Context) -> None:
        settings = settings_of(context)
        carry_out(settings, MOTION, [function_message(settings, MOTION, function=function)], quiet=True)

    return run


wake_command = _one_function("wake", "wakeUp", "Switch the motors on; a robot on its feet stands up.")
rest_command = _one_function("rest", "rest", "Go to a safe posture and switch the motors off.")


# --- nao stop ---------------------------------------------------------------------------------------------------------

CANCEL = "/cancel"
CONNECT_LIMIT = 10.0
"""s until all who listen must have been found; most are within 0.2."""
GONE_AFTER = 1.0
"""s after which those are left out that do not run any more: the master does not know."""
FOUND_PERIOD = 0.02


@click.command(cls=NaoCommand, name="stop")
@click.pass_context
def stop_command(context: click.Context) -> None:
    """Cancel all goals of all servers and drivers, and stop walking."""
    settings = settings_of(context)
    space = settings.stack.namespace
    listened = settings.stack.graph.subscribed()
    types = settings.stack.graph.topic_types()
    topics = [name for name in listened if name.endswith(CANCEL) and types.get(name) == "actionlib_msgs/GoalID"]
    actions = sorted(name for name in topics if name.startswith(space))
    _cancel({name: listened[name] for name in actions})
    walk = _stop_walk(settings)
    names = [name[len(space) : -len(CANCEL)] for name in actions]
    if settings.json:
        say_json({"cancelled": names, "walk": walk})
    else:
        click.echo(f"cancelled: {', '.join(names) or 'nothing'}; {walk}")


def _cancel(listened: Mapping[str, Collection[str]]) -> None:
    """Send a cancel for all goals to each node that listens, server or not, as soon as it is connected.

    `listened`: topic of cancels -> the nodes.
    """
    import rospy
    from actionlib_msgs.msg import GoalID

    from ...ros.master_api import node_runs

    start_node()
    began, pause, looked = time.monotonic(), threading.Event(), False
    waiting = {rospy.Publisher(topic, GoalID, queue_size=1): set(nodes) for topic, nodes in listened.items()}
    reached = dict.fromkeys(waiting, 0)
    while waiting and (lasted := time.monotonic() - began) < CONNECT_LIMIT:
        if lasted > GONE_AFTER and not looked:
            looked, runs = True, {node: node_runs(node) for node in set().union(*waiting.values())}
            waiting = {each: {node for node in nodes if runs[node]} for each, nodes in waiting.items()}
        for publisher in waiting:
            there = publisher.get_num_connections()
            if there > reached[publisher]:
                reached[publisher] = there
                publisher.publish(GoalID())
        waiting = {publisher: nodes for publisher, nodes in waiting.items() if reached[publisher] < len(nodes)}
        pause.wait(FOUND_PERIOD)


def _stop_walk(settings: object) -> str:
    """Stop a walk that no goal holds any more; tells how that went."""
    try:
        with DirectRobot(settings.stack.robot_address()) as robot:
            robot.call("ALMotion", "stopMove")
    except click.ClickException as error:
        return f"the robot was not told to stop walking: {error.message}"
    return "the robot does not walk"
