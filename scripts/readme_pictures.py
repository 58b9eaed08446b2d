#!/usr/bin/env python3
"""Draws the pictures of README.md and docs/ anew: the simulated robot standing, sitting, lying, waving, and in rooms.

And what it leaves behind when it walks: its footprints; what its microphones hear of a dialogue; what its cameras see
and what it recognises there. The drawing of the architecture needs the Debian package graphviz, as nothing else does:
scripts/setup does not install it.
"""

from __future__ import annotations

import argparse
import math
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import qi
from readme_dialogue import Dialogue
from readme_sight import draw_sight

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "nao_library_modules" / "examples"))
from example_parts import dialogue_record
from nao_sim_bridge.core.simulation import Scene
from nao_sim_bridge.server.options import ServerOptions
from nao_sim_bridge.server.simulator_server import SimulatorServer

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "docs" / "images"
ARCHITECTURE = ROOT / "docs" / "architecture.dot"
EXAMPLES = ROOT / "nao_library_modules" / "examples"
PLOT_WALK, PLOT_SOUND = EXAMPLES / "plot_walk.py", EXAMPLES / "plot_sound.py"
TEN_LINES = ROOT / "nao_sim_bridge" / "examples" / "nao_in_ten_lines.py"
VIEW, SIZE = "three_quarter", 320
ROOM_SIZE = (640, 400)
POSTURES = {"standing": "Stand", "sitting": "Sit", "lying": "LyingBelly"}
SPEED = 0.8
# Until nothing swings any more, s.
SETTLE = 0.5
LIMIT = 60.0
WAVE = {"RShoulderPitch": -0.2, "RShoulderRoll": -0.7, "RElbowYaw": 1.3, "RElbowRoll": 1.3, "RHand": 1.0}


class Sitter:
    """A simulated robot that poses for pictures, under physics.

    Args:
        scene: Where.
        folder: Where its pictures go.
    """

    def __init__(self, scene: Scene, folder: Path) -> None:
        self._folder = folder
        self._server = SimulatorServer(ServerOptions(scene, port=0, speed=math.inf))
        self._session = qi.Session()

    def __enter__(self) -> Sitter:
        self._server.start()
        self._session.connect(f"tcp://127.0.0.1:{self._server.broker.port}")
        return self

    def __exit__(self, *_: object) -> None:
        self._session.close()
        self._server.stop()

    def go_to(self, posture: str) -> None:
        """Go to a posture."""
        if not self._session.service("ALRobotPosture").goToPosture(posture, SPEED):
            raise SystemExit(f"the robot did not reach {posture}")

    def wave(self) -> None:
        """Lift a hand."""
        motion = self._session.service("ALMotion")
        motion.angleInterpolation(list(WAVE), [[angle] for angle in WAVE.values()], [[1.0]] * len(WAVE), True)

    def save(self, name: str, view: str = VIEW, width: int = SIZE, height: int = SIZE) -> None:
        """Draw the robot as it is when nothing swings any more."""
        self._server.runner.advance(SETTLE).result(LIMIT)
        (self._folder / f"{name}.png").write_bytes(self._server.picture(view, width, height))
        print(f"{name}.png", flush=True)


def draw(folder: Path) -> None:
    """Bring the robot into each pose and draw it."""
    with Sitter(Scene(), folder) as robot:
        for name, posture in POSTURES.items():
            robot.go_to(posture)
            robot.save(name)
        robot.go_to("Stand")
        robot.wave()
        robot.save("waving")
    with Sitter(Scene(world="lab"), folder) as robot:
        robot.go_to("Stand")
        robot.save("lab", "room", *ROOM_SIZE)
    with Sitter(Scene(world="gallery"), folder) as robot:
        robot.go_to("Stand")
        robot.save("gallery", "room", *ROOM_SIZE)


def draw_walk(folder: Path) -> None:
    """Let a robot walk and draw its footprints, as the example does it."""
    # Not faster than real: the example looks at the robot at times of the wall clock.
    server = SimulatorServer(ServerOptions(Scene(), port=0, speed=1.0))
    server.start()
    try:
        command = [sys.executable, str(PLOT_WALK), "--overwrite", "--port", str(server.broker.port)]
        subprocess.run([*command, "--output", str(folder / "walk.png")], check=True, timeout=LIMIT)
    finally:
        server.stop()


def draw_dialogue(folder: Path) -> None:
    """Let a robot talk with a person and draw what it hears, as the example does it."""
    with tempfile.TemporaryDirectory() as kept:
        sound, words = Path(kept) / "dialogue.wav", Path(kept) / "dialogue.json"
        dialogue = Dialogue(Path(kept))
        dialogue.record(sound.name)
        dialogue_record.save(dialogue.turns, words)
        command = [sys.executable, str(PLOT_SOUND), "--overwrite", str(sound), "--words", str(words)]
        subprocess.run([*command, "--output", str(folder / "dialogue.png")], check=True, timeout=LIMIT)


def draw_library(folder: Path) -> None:
    """Keep what the ten lines of the library draw."""
    with tempfile.TemporaryDirectory() as here:
        subprocess.run([sys.executable, str(TEN_LINES)], cwd=here, check=True, timeout=LIMIT)
        shutil.copy(Path(here) / "nao.png", folder / "library.png")
    print("library.png", flush=True)


def draw_architecture(folder: Path) -> None:
    """Have graphviz draw the architecture."""
    picture = folder / f"{ARCHITECTURE.stem}.png"
    subprocess.run(["dot", "-Tpng", str(ARCHITECTURE), "-o", str(picture)], check=True, timeout=LIMIT)
    print(picture.name, flush=True)


def main() -> int:
    """Draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--folder", type=Path, default=FOLDER, help="where the pictures go (default: docs/images)")
    folder = parser.parse_args().folder
    if shutil.which("dot") is None:
        raise SystemExit("there is no dot for the architecture: apt-get install --no-install-recommends graphviz")
    folder.mkdir(parents=True, exist_ok=True)
    draw_architecture(folder)
    draw(folder)
    draw_sight(folder / "sight.png")
    print("sight.png", flush=True)
    draw_walk(folder)
    draw_dialogue(folder)
    draw_library(folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
