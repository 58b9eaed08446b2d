"""What is drawn at random in a trial: the same again for the same participant, trial, place and seed. Pure."""

from __future__ import annotations

import random
from collections.abc import Mapping
from typing import Any


def generator(seed: int, values: Mapping[str, Any], path: str) -> random.Random:
    """What draws for one place of a protocol. `values`: of the trial. `path`: of the step."""
    return random.Random(f"{seed}:{values['number']}:{values['trial']}:{path}")
