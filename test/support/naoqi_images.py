"""Pixels of the pictures that ALVideoDevice hands over."""

from __future__ import annotations

import numpy as np


def pixels(container):
    """(h, w) or (h, w, layers) uint8, of an answer of getImageRemote."""
    shape = (container[1], container[0]) + ((container[2],) if container[2] > 1 else ())
    return np.frombuffer(bytes(container[6]), np.uint8).reshape(shape)
