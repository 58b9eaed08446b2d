"""Writing pictures to files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image


def write_png(path: str | Path, picture: np.ndarray) -> Path:
    """Write an (h, w, 3) uint8 RGB picture; folders on the way are made.

    Returns:
        The path written.
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(picture, "RGB").save(path, "PNG")
    return path
