"""Projection of a behaviour: it runs on a simulated robot of its own, faster than real time, and its steps are timed.

Nothing happens on the robot of the console.
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

from ...processes.own_stack import OwnStack, StackFailed

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
