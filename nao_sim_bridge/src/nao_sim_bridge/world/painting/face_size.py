"""Proportions of the heads that are painted and of those that wear what is painted."""

from __future__ import annotations

HEAD_HALF_HEIGHT = 1.45
"""Half the height of a head in halves of its width."""
