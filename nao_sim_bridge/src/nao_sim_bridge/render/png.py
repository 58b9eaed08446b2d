"""Writing pictures to files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image

from nao_sim_bridge.base.whole_file import WholeFile


def write_png(path: str | Path, picture: np.ndarray) -> Path:
    """Write an (h, w, 3) uint8 RGB picture; folders on the way are made. Returns the path written."""
    path = Path(path)
    with WholeFile(path) as file:
        Image.fromarray(picture, "RGB").save(file, "PNG")
    return path
