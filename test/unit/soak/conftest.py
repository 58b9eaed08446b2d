"""The soak is a program, not a package of the workspace: its folder goes on the search path here."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "soak"))
