"""What can go wrong in a benchmark."""

from __future__ import annotations


class BenchmarkError(Exception):
    """A row could not be measured, or what it measured was not what it should have been."""
