"""Projection of a behaviour: it runs on a simulated robot of its own, faster than real time, and tells how long it took.

Nothing happens on the robot of the console.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Tuple

from naoqi.errors import NaoError

from ...processes.own_stack import OwnStack

LIMIT = 600.0
"""s of this computer that a projected behaviour may take."""
READY = 60.0
"""s of this computer until the servers must be there."""
LAUNCH = {"driver": "false", "speed": "0"}
"""The action servers alone, as fast as possible."""
_CALL = "import sys; from nao_library_modules.cli.app import main; sys.exit(main())"


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
