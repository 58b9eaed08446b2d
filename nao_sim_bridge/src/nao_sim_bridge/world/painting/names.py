"""Names of posters and patterns; what paints them is elsewhere, and not loaded where only the names are asked for."""

from __future__ import annotations

POSTERS = ("hills", "circles", "leaves", "waves", "city", "planets")
PATTERNS = ("oak", "walnut", "pine", "checks", "stripes", "weave", "books", "window", "bricks")
