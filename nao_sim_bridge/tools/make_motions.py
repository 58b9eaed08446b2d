#!/usr/bin/env python3
"""Makes the motions that come with the library: `nao_library_modules/config/motions/*.yaml`, all of them composed.

    PYTHONPATH=nao_sim_bridge/src:nao_library_modules/src python3 nao_sim_bridge/tools/make_motions.py

Each motion is a function of `motion_tables.py` or `motion_dance.py`; the name of the function is that of the motion.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from choreography import Choreographer
from motion_dance import dance
from motion_tables import bow_deep, bow_small, look_around, offer, point_to_self, tai_chi, wave

from nao_library_modules.motion.recorded_motion import MotionStore, recorded
from nao_sim_bridge.model.model_reader import load_model

FOLDER = Path(__file__).resolve().parents[2] / "nao_library_modules" / "config" / "motions"
MOTIONS = (wave, bow_small, bow_deep, point_to_self, offer, look_around, tai_chi, dance)


def main() -> int:
    """Write the files."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--folder", type=Path, default=FOLDER, help="where the motions go (default: that of the library)"
    )
    parser.add_argument("names", nargs="*", help="only these")
    options = parser.parse_args()
    store, choreographer = MotionStore(options.folder), Choreographer(load_model())
    for make in MOTIONS:
        if options.names and make.__name__ not in options.names:
            continue
        joints, samples = choreographer.samples(make())
        motion = recorded(joints, samples).key_frames()
        store.save(make.__name__, motion)
        print(f"{make.__name__}: {motion.duration:.1f} s, {len(joints)} joints, {len(motion.times)} key frames")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
