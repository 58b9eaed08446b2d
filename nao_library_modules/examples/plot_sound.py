#!/usr/bin/env python3
"""Draws a recording: waveform, spectrogram, and who said and heard what: `plot_sound.py a.wav --words a.json`.

`dialogue.py --record a.wav --log a.json` leaves both. Recordings of a simulated robot are in its record_dir. No ROS.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import soundfile

# In the devel space rosrun starts a relay from another folder.
sys.path.insert(0, str(Path(__file__).resolve().parent))
from example_parts.dialogue_record import load
from example_parts.sound_picture import draw
from nao_library_modules.whole_file import WholeFile, require_new
from naoqi.errors import NaoError

# Enough for a drawing, and a small file.
COLORS = 64


def main() -> int:
    """Draw."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sound", type=Path, help="the recording, 1 to 4 channels")
    parser.add_argument("--words", type=Path, metavar="FILE", help="what dialogue.py --log wrote, for below the axis")
    parser.add_argument("--output", type=Path, default=Path("sound.png"), help="picture to write (sound.png)")
    parser.add_argument("--overwrite", action="store_true", help="replace a file of that name")
    options = parser.parse_args()
    try:
        output = require_new(options.output, options.overwrite)
        samples, rate = soundfile.read(str(options.sound), dtype="float32", always_2d=True)
        turns = load(options.words) if options.words else []
        with WholeFile(output) as file:
            draw(samples, rate, turns).quantize(COLORS).save(file, "PNG", optimize=True)
    except (NaoError, OSError, ValueError, soundfile.LibsndfileError) as error:
        print(error)
        return 1
    print(f"written: {output}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
