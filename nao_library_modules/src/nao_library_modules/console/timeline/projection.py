"""Projection of a behaviour: it runs on a simulated robot of its own, faster than real time, and its steps are timed.

Nothing happens on the robot of the console. Run as a program, this module is the client on the stack of the projection:
it reads a goal as JSON, and prints the outcome as JSON.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import threading
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Tuple

from naoqi.errors import NaoError

from ...ros.own_stack import OwnStack, StackFailed

LIMIT = 600.0
"""s of this computer that a projected behaviour may take."""
LOOK_PERIOD = 0.2
"""s between two looks whether somebody wants it ended."""
LAUNCH = {"driver": "false", "speed": "0"}
"""The action servers alone, as fast as possible."""
CLIENT = f"{__package__}.projection"


class NotProjected(NaoError):
    """A behaviour could not be projected, and why."""


@dataclass(frozen=True)
class ProjectedRun:
    """How a behaviour went there.

    Attributes:
        state: succeeded, aborted, ...
        text: What its server said.
        duration: s of simulated time.
        lengths: Path -> s, of each step that ended.
        failures: What went wrong, a line each.
    """

    state: str
    text: str
    duration: float
    lengths: Mapping[str, float]
    failures: Tuple[str, ...]


def project_behavior(text: str, file: str, given: Sequence[str], cancelled: threading.Event) -> ProjectedRun:
    """Run a behaviour on a robot of its own; takes a minute or so, in the thread that calls.

    Raises NotProjected if the stack does not come up, the run takes too long, or it was cancelled.

    Args:
        text: Its YAML.
        file: What problems call its file.
        given: Values of its parameters as "name=value".
        cancelled: Set by whoever does not want it any more.
    """
    with tempfile.TemporaryDirectory(prefix="nao_projection_") as folder:
        launch = {**LAUNCH, "record_dir": folder}
        with OwnStack(Path(folder) / "stack.log", launch) as stack:
            try:
                stack.wait_for_robot()
            except StackFailed as error:
                raise NotProjected(str(error)) from error
            if cancelled.is_set():
                raise NotProjected("it was cancelled")
            goal = {"text": text, "file": file, "parameters": list(given)}
            return read_run(_answer(goal, stack.master_uri, Path(folder), cancelled))


def read_run(answer: Mapping[str, Any]) -> ProjectedRun:
    """What the client of a projection has printed: state, text, duration, and the steps with their times."""
    steps = answer["steps"]
    lengths = {each["path"]: each["ended"] - each["began"] for each in steps if each["state"] == "ended"}
    failures = [f"{each['path']} {each['what']} {each['state']}: {each['error']}" for each in steps if each["error"]]
    return ProjectedRun(answer["state"], answer["text"], answer["duration"], lengths, tuple(failures))


def _answer(goal: Mapping[str, Any], master_uri: str, folder: Path, cancelled: threading.Event) -> Mapping[str, Any]:
    with (folder / "client.log").open("w+") as log:
        client = subprocess.Popen(
            [sys.executable, "-m", CLIENT],
            env={**os.environ, "ROS_MASTER_URI": master_uri},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=log,
            text=True,
        )
        asked: str | None = json.dumps(goal)
        left = LIMIT
        while True:
            try:
                output, _ = client.communicate(asked, timeout=LOOK_PERIOD)
                break
            except subprocess.TimeoutExpired:
                asked, left = None, left - LOOK_PERIOD
            if cancelled.is_set() or left <= 0.0:
                client.kill()
                client.communicate()
                raise NotProjected("it was cancelled" if cancelled.is_set() else f"it took longer than {LIMIT:g} s")
        try:
            return json.loads(output)
        except ValueError:
            log.seek(0)
            reason = log.read().strip().rpartition("\n")[2] or f"its client ended with status {client.returncode}"
            raise NotProjected(reason) from None


SERVER_LIMIT = 60.0
"""s of this computer until the server must be there."""
FIELDS = ("path", "what", "state", "began", "ended", "error")


def run_client(goal: Mapping[str, Any]) -> dict[str, Any]:
    """Run a behaviour on the stack of a projection; state, text, duration (s of ROS time), and its steps."""
    import actionlib
    import rospy
    from actionlib_msgs.msg import GoalStatus

    from nao_library_actions.msg import NaoBehaviorAction, NaoBehaviorGoal
    from nao_library_msgs.msg import BehaviorFunction

    rospy.init_node("projection", anonymous=True, disable_rosout=True)
    client = actionlib.SimpleActionClient("NaoBehavior", NaoBehaviorAction)
    # Simulated time passes faster than this computer's: the limit is counted in both.
    if not client.wait_for_server(rospy.Duration(100 * SERVER_LIMIT)):
        raise SystemExit("the server NaoBehavior does not come up")
    client.send_goal(NaoBehaviorGoal([BehaviorFunction(function="runBehavior", **goal)]))
    client.wait_for_result()
    result = client.get_result()
    steps = [] if result is None else [{name: getattr(step, name) for name in FIELDS} for step in result.steps]
    state = GoalStatus.to_string(client.get_state()).lower()
    duration = max((step["ended"] for step in steps), default=0.0)
    return {"state": state, "text": client.get_goal_status_text(), "duration": duration, "steps": steps}


if __name__ == "__main__":
    print(json.dumps(run_client(json.load(sys.stdin))))
