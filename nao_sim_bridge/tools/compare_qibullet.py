#!/usr/bin/env python3
"""Real-time factor of qiBullet's NAO beside that of nao_sim_bridge: simulated seconds per second, without a display.

Needs `pip install qibullet ./nao_sim_bridge`. qiBullet's meshes have a licence of their own and an installer for Python
up to 3.9, so its nao.urdf is loaded by its own classes with a stand-in for each mesh. `--shape box`: the box that has
the link's mass and moments of inertia; that of a foot ends where the pads of its sensors begin; links of fingers, which
weigh nothing, get cubes of 8 mm. `hull`: the ellipsoids in these boxes, but for the feet, as meshes of 98 points.
`none`: only the pads below the feet can touch anything. The home directory stays as it is.

All cases are measured in turns, in one process, so that what else the computer does meets all of them.
"""

from __future__ import annotations

import argparse
import math
import tempfile
import time
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from statistics import median
from typing import Callable

import pybullet
from qibullet import SimulationManager, simulation_manager, tools
from qibullet.fsr import NaoFsr

from nao_sim_bridge import NaoSim

STEP = 1.0 / 240.0
"""The time step of both, s: PyBullet's own, which qiBullet leaves as it is."""
PADS = -0.0441
"""Upper side of the pads below a foot, in the foot's frame, m."""
RINGS, SIDES = 7, 14
"""Of points on an ellipsoid."""
WARM_UP = 2.0
"""Simulated before anything is measured, s."""


def box_of(link: ElementTree.Element) -> tuple[list[float], list[float]]:
    """Size and centre of the box that stands in for a link's mesh, m."""
    mass = float(link.find("inertial/mass").get("value"))
    if mass < 0.001:
        return [0.008] * 3, [0.0] * 3
    moments = [float(link.find("inertial/inertia").get(key)) for key in ("ixx", "iyy", "izz")]
    size = [math.sqrt(max(1e-4, 6.0 * (sum(moments) - 2.0 * moment) / mass)) for moment in moments]
    centre = [float(value) for value in link.find("inertial/origin").get("xyz").split()]
    if link.get("name").endswith("_ankle"):
        top = centre[2] + size[2] / 2.0
        size[2], centre[2] = top - PADS, (top + PADS) / 2.0
    return size, centre


def write_ellipsoid(file: Path, size: list[float]) -> None:
    angles = [(math.pi * (i + 1) / (RINGS + 1), math.tau * k / SIDES) for i in range(RINGS) for k in range(SIDES)]
    points = [(math.sin(a) * math.cos(b), math.sin(a) * math.sin(b), math.cos(a)) for a, b in angles]
    lines = ["v " + " ".join(str(x * s / 2.0) for x, s in zip(point, size)) for point in points]
    for a in range(1, (RINGS - 1) * SIDES + 1):
        b = a + 1 if a % SIDES else a + 1 - SIDES
        lines += [f"f {a} {a + SIDES} {b}", f"f {b} {a + SIDES} {b + SIDES}"]
    file.write_text("\n".join(lines) + "\n")


def write_stand_in(folder: Path, shape: str) -> None:
    """Write qiBullet's nao.urdf with stand-ins for its meshes."""
    tree = ElementTree.parse(Path(tools.__file__).parent / "robot_data" / "nao.urdf")
    for link in tree.iter("link"):
        for part in [part for part in link if part.find("geometry/mesh") is not None]:
            if shape == "none":
                link.remove(part)
                continue
            size, centre = box_of(link)
            geometry, name = part.find("geometry"), link.get("name")
            geometry.clear()
            if shape == "hull" and not name.endswith("_ankle"):
                write_ellipsoid(folder / f"{name}.obj", size)
                ElementTree.SubElement(geometry, "mesh", filename=f"{name}.obj")
            else:
                ElementTree.SubElement(geometry, "box", size=" ".join(map(str, size)))
            part.find("origin").attrib.update(xyz=" ".join(map(str, centre)), rpy="0 0 0")
    tree.write(folder / "nao.urdf")


class QiBullet:
    """qiBullet's NAO on its plane, with a free base, in DIRECT mode, told once to stand."""

    def __init__(self, folder: str) -> None:
        tools._check_resources_installed = lambda: True
        tools._get_resources_folder = lambda: folder
        simulation_manager.time = self  # its loop calls time() once, and sleep() after each step
        self.time, self._left = time.time, 0
        self._manager = SimulationManager()
        self._client = self._manager.launchSimulation(gui=False, auto_step=False)
        self._nao = self._manager.spawnNao(self._client, spawn_ground_plane=True)
        self._nao.goToPosture("Stand", 0.5)
        self._names = [name for name in self._nao.joint_dict if "Finger" not in name and "Thumb" not in name]

    def sleep(self, seconds: float) -> None:
        time.sleep(seconds)
        self._left -= 1
        if not self._left:
            raise StopIteration  # which ends the loop

    def loop(self, seconds: float) -> None:
        """What its thread does with `auto_step=True`, which is the default."""
        self._left = round(seconds / STEP)
        self._manager._stepSimulation(self._client)

    def step(self, seconds: float) -> None:
        for _ in range(round(seconds / STEP)):
            self._manager.stepSimulation(self._client)

    def step_and_read(self, seconds: float) -> None:
        """Step, and read joints and feet after every second step, as often as nao_sim_bridge does."""
        for _ in range(round(seconds / STEP / 2)):
            self.step(2 * STEP)
            self._nao.getAnglesPosition(self._names)
            self._nao.getAnglesVelocity(self._names)
            self._nao.getFsrValues(NaoFsr.LFOOT + NaoFsr.RFOOT)

    def __str__(self) -> str:
        body = self._nao.getRobotModel()
        place, turn = pybullet.getBasePositionAndOrientation(body, physicsClientId=self._client)
        lean = math.degrees(math.acos(min(1.0, pybullet.getMatrixFromQuaternion(turn)[8])))
        contacts = pybullet.getContactPoints(body, physicsClientId=self._client)
        own = sum(contact[1] == contact[2] for contact in contacts)
        return f"torso {place[2]:.2f} m high, leans {lean:.0f} deg, {len(contacts)} contacts, {own} with itself"


def measure(cases: dict[str, Callable[[float], None]], rounds: int, seconds: float) -> dict[str, tuple[float, ...]]:
    """Real-time factors: the best and the median by the clock, and the median by the processor's time."""
    walls, processors = {name: [] for name in cases}, {name: [] for name in cases}
    for case in cases.values():
        case(WARM_UP)
    for number in range(rounds):
        names = list(cases)
        for name in names[number % len(names) :] + names[: number % len(names)]:
            wall, processor = time.perf_counter(), time.process_time()
            cases[name](seconds)
            walls[name].append(seconds / (time.perf_counter() - wall))
            processors[name].append(seconds / (time.process_time() - processor))
    return {name: (max(walls[name]), median(walls[name]), median(processors[name])) for name in cases}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=40)
    parser.add_argument("--seconds", type=float, default=1.0, help="simulated per case and round")
    parser.add_argument("--shape", choices=("box", "hull", "none"), default="box", help="in place of qiBullet's meshes")
    arguments = parser.parse_args()
    stand = {"posture": "Stand", "seed": 1}
    with tempfile.TemporaryDirectory() as folder, NaoSim(**stand) as standing, NaoSim(**stand) as walking:
        write_stand_in(Path(folder), arguments.shape)
        other = QiBullet(folder)
        walking.walk(0.08, 0.0, 0.15)
        cases = {
            "qiBullet, `stepSimulation`": other.step,
            "qiBullet, the loop of its thread": other.loop,
            "qiBullet, `stepSimulation`, joints and feet read": other.step_and_read,
            "nao_sim_bridge, stands": standing.step,
            "nao_sim_bridge, walks": walking.step,
        }
        factors = measure(cases, arguments.rounds, arguments.seconds)
        print("qiBullet:", other)
        print("nao_sim_bridge: fallen", standing.fallen, walking.fallen, "walked to", walking.pose_on_ground)
    print("\n| | best | median | by processor's time | of the first: best | median | by processor's time |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    first = next(iter(factors.values()))
    for name, values in factors.items():
        cells = [*values, *(value / base for value, base in zip(values, first))]
        print(f"| {name} | " + " | ".join(f"{cell:.2f}" for cell in cells) + " |")


if __name__ == "__main__":
    main()
