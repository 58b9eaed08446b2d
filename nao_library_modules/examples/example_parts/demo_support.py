"""What the demonstration needs beside its steps: the stack it starts, and how to look at what it left."""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import Callable, Sequence

from nao_library_modules.base.whole_file import write_whole
from nao_library_modules.processes.own_stack import OwnStack

WORLD = "lab"
SPEED = "3"
"""Of time: nobody watches. As fast as possible would leave the nodes behind."""
# Everything the loudspeakers play.
SOUND = "sound.wav"
# Root mean square of speech, of full scale.
LOUD = 0.02


class Stack(OwnStack):
    """The stack of the demonstration: in the lab, with everything that sounds in a file. This program talks to it.

    Args:
        output: Folder for pictures and the log.
    """

    def __init__(self, output: Path) -> None:
        if (output / SOUND).exists():
            (output / SOUND).unlink()  # of the last demonstration; the simulator would not replace it
        arguments = {"record_dir": str(output), "world": WORLD, "sound_file": SOUND, "speed": SPEED}
        super().__init__(output / "stack.log", arguments)
        os.environ["ROS_MASTER_URI"] = self.master_uri


def loud_time(path: Path) -> float:
    """How long a sound file is loud, s, looked at in tenths of a second."""
    import numpy as np
    import soundfile

    samples, rate = soundfile.read(path, always_2d=True)
    length = rate // 10
    tenths = samples[: len(samples) // length * length, 0].reshape(-1, length)
    return float((np.sqrt((tenths**2).mean(axis=1)) > LOUD).sum()) / 10.0


def count_green_pixels(path: Path) -> int:
    """Pixels of a picture that only a lit green LED has."""
    import numpy as np
    from PIL import Image

    red, green, blue = (np.asarray(Image.open(path).convert("RGB"))[:, :, i].astype(int) for i in range(3))
    return int(((green > 150) & (green > 1.6 * red) & (green > 1.6 * blue)).sum())


def wait_until(ready: Callable[[], bool], limit: float, what: str) -> None:
    """Wait until `ready()`, looking ten times a second: for what the robot tells nobody of, such as its LEDs.

    Raises:
        RuntimeError: It did not become ready within `limit` s.
    """
    give_up = time.monotonic() + limit
    while not ready():
        if time.monotonic() > give_up:
            raise RuntimeError(f"{what} did not become ready within {limit:g} s")
        time.sleep(0.1)


def write_table(rows: Sequence[tuple[str, str, bool]], path: Path) -> None:
    """Write the table of what was asked and what the robot reports."""
    lines = ["| asked | the robot reports | |", "|---|---|---|"]
    lines += [f"| {asked} | {reported} | {'ok' if good else 'FAIL'} |" for asked, reported, good in rows]
    write_whole(path, "\n".join(lines) + "\n")
