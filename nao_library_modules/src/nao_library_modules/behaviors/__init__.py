"""Behaviours: what the robot does with all its modules, written down in a file, run by name.

The format is described in docs/behaviors.md. To look at one without running it:

    behavior = read(path.read_text(), path.stem)
    check(behavior, store.load)

The action server is in `server`; what is needed to run behaviours elsewhere is in `execution`.
"""

from __future__ import annotations

from .behavior_errors import BehaviorError, NoSuchBehavior, Problem, StepFailed
from .behavior_reader import read
from .behavior_store import BehaviorStore, from_goal
from .binder import bind
from .checking import check, problems_of
from .model import Behavior

__all__ = [
    "Behavior",
    "BehaviorError",
    "BehaviorStore",
    "NoSuchBehavior",
    "Problem",
    "StepFailed",
    "bind",
    "check",
    "from_goal",
    "problems_of",
    "read",
]
