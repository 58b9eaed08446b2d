"""`nao stop`: nothing goes on."""

from __future__ import annotations

import threading

import click

from ..goals import start_node
from ..output import say_json
from ..robot_link import DirectRobot
from ..settings import NaoCommand, settings_of

CANCEL = "/cancel"
CONNECT_LIMIT = 3.0
"""s until the servers must have been found."""
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
    _cancel(actions)
    walk = _stop_walk(settings)
    names = [name[len(space) : -len(CANCEL)] for name in actions]
    if settings.json:
        say_json({"cancelled": names, "walk": walk})
    else:
        click.echo(f"cancelled: {', '.join(names) or 'nothing'}; {walk}")


def _cancel(topics: list[str]) -> None:
    """Send each server a cancel for all its goals, as soon as it listens."""
    import rospy
    from actionlib_msgs.msg import GoalID

    start_node()
    waiting = [rospy.Publisher(topic, GoalID, queue_size=1) for topic in topics]
    pause = threading.Event()
    tries = int(CONNECT_LIMIT / FOUND_PERIOD)
    for _ in range(tries):
        found = [publisher for publisher in waiting if publisher.get_num_connections()]
        for publisher in found:
            publisher.publish(GoalID())
        waiting = [publisher for publisher in waiting if publisher not in found]
        if not waiting:
            return
        pause.wait(FOUND_PERIOD)


def _stop_walk(settings: object) -> str:
    """Stop a walk that no goal holds any more; tells how that went."""
    try:
        with DirectRobot(settings.stack.robot_address()) as robot:
            robot.call("ALMotion", "stopMove")
    except click.ClickException as error:
        return f"the robot was not told to stop walking: {error.message}"
    return "the robot does not walk"
