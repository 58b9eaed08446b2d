"""The error of this package."""

from __future__ import annotations


class AlmathError(ValueError):
    """A value that no position, rotation or function of this package can be made from.

    It stands apart from the errors of the `naoqi` package because `almath` must be importable on a machine
    without libqi; every message names the class or function, the value it was given and what it takes.
    """
