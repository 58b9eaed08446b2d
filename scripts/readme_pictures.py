#!/usr/bin/env python3
"""Draws the pictures of README.md anew: the simulated robot standing, sitting, lying and waving."""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path

import qi

from nao_sim_bridge.server import ServerOptions, SimulatorServer
from nao_sim_bridge.sim.simulation import Scene

FOLDER = Path(__file__).resolve().parents[1] / "docs" / "images"
VIEW, SIZE = "three_quarter", 320
POSTURES = {"standing": "Stand", "sitting": "Sit", "lying": "LyingBelly"}
SPEED = 0.8
# Until nothing swings any more, s.
SETTLE = 0.5
LIMIT = 60.0
WAVE = {"RShoulderPitch": -0.2, "RShoulderRoll": -0.7, "RElbowYaw": 1.3, "RElbowRoll": 1.3, "RHand": 1.0}


def draw(folder: Path) -> None:
    """Bring the robot into each pose, under physics, and draw it."""
    server = SimulatorServer(ServerOptions(Scene(), port=0, speed=math.inf))
    server.start()
    session = qi.Session()
    try:
        session.connect(f"tcp://127.0.0.1:{server.broker.port}")
        postures, motion = session.service("ALRobotPosture"), session.service("ALMotion")

        def save(name: str) -> None:
            server.runner.advance(SETTLE).result(LIMIT)
            (folder / f"{name}.png").write_bytes(server.picture(VIEW, SIZE, SIZE))
            print(f"{name}.png", flush=True)

        for name, posture in POSTURES.items():
            if not postures.goToPosture(posture, SPEED):
                raise SystemExit(f"the robot did not reach {posture}")
            save(name)
        postures.goToPosture("Stand", SPEED)
        motion.angleInterpolation(list(WAVE), [[angle] for angle in WAVE.values()], [[1.0]] * len(WAVE), True)
        save("waving")
    finally:
        session.close()
        server.stop()


def main() -> int:
    """Draw."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--folder", type=Path, default=FOLDER, help="where the pictures go (default: docs/images)")
    folder = parser.parse_args().folder
    folder.mkdir(parents=True, exist_ok=True)
    draw(folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
