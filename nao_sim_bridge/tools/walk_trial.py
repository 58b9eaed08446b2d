"""A simulated robot that walks, disturbed or not, and what really happens to it; for `check_walk.py`."""

from __future__ import annotations

import contextlib
import math
import random
from typing import Any, Callable

from nao_sim_bridge.base.errors import MoveRefused
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.core.posture_change import PostureChange
from nao_sim_bridge.core.posture_moves import load_moves
from nao_sim_bridge.core.simulation import Scene, Simulation
from nao_sim_bridge.walk.body import WalkingBody, robot_on_ground
from nao_sim_bridge.walk.footsteps import FootPose
from nao_sim_bridge.walk.gait import feet_gait

# A robot that nobody has idealised: errors of its sensors and their delay, s.
REAL = {"sensor_noise": 1.0, "sensor_delay": 0.016}
# Until a robot that was put into the world stands still, s.
SETTLE = 0.5
# What hits the floor in a fall; hands and forearms are put there on purpose.
BODY = ("torso", "Neck", "Head", "LShoulder", "RShoulder", "LBicep", "RBicep")
# Length of a push, s; name -> where one goes, degrees from straight ahead, counter-clockwise.
PUSH_TIME, SIDES = 0.1, {"front": 0, "left": 90, "back": 180, "right": 270}
# A foot on the ground carries this, N; a robot that stands moves no faster, m/s.
CARRIES, STILL = 3.0, 0.05


class Trial:
    """One robot, stiff in a posture, from the start of its walk on.

    Attributes:
        simulation: The world with the robot.
        robot: The robot.
        chance: All that differs from seed to seed.
        noticed: When the fall manager raised its alarm, simulated s; None as long as it has not.
        impact: When torso, head or an upper arm hit the floor; None as long as they have not.
        ended: Why a walk could not begin or ended before time; empty when none did.
        fastest: Largest share of its top speed that a leg's joint has had, by name.
        longest_above: Longest time without a break over the top speed, s, by name.
    """

    def __init__(self, seed: int, posture: str = "StandInit", **scene: Any) -> None:
        self.simulation = Simulation(Scene(posture=posture, seed=seed, **scene))
        self.robot = self.simulation.robot
        self.chance = random.Random(seed)
        self.noticed: float | None = None
        self.impact: float | None = None
        self.ended = ""
        model = self.simulation.model
        self._tops = [(i, joint.name, joint.max_velocity) for i, joint in enumerate(model.joints)]
        self.fastest = dict.fromkeys((joint.name for joint in model.joints), 0.0)
        self.longest_above = dict.fromkeys(self.fastest, 0.0)
        self._above = dict.fromkeys(self.fastest, 0.0)
        self._body = WalkingBody(model)
        self.robot.motion.set_stiffness_now(dict.fromkeys(range(len(model.joints)), 1.0))
        self.robot.locomotion.failures.append(self._failed)
        self.simulation.run(SETTLE)

    def __enter__(self) -> Trial:
        return self

    def __exit__(self, *_: object) -> None:
        self.simulation.close()

    @property
    def time(self) -> float:
        """Simulated time, s."""
        return self.simulation.time

    @property
    def up(self) -> bool:
        """Whether it has not fallen and nothing has ended its walk."""
        return self.noticed is None and self.impact is None and not self.ended

    @property
    def place(self) -> FootPose:
        """Where it really is: half way between its feet, in the world."""
        now = self.simulation.snapshot
        return robot_on_ground(self._body, now.torso, now.positions)

    @property
    def believed(self) -> FootPose:
        """Where it thinks that it is, in the world of its odometry."""
        return self.robot.locomotion.position(use_sensors=True)

    @property
    def stands(self) -> bool:
        """Whether both feet carry an upright body that hardly moves."""
        now = self.simulation.snapshot
        loads = now.left_foot.total, now.right_foot.total
        return self.up and min(loads) > CARRIES and math.hypot(*now.linear_velocity) < STILL

    def go(self, x: float, y: float, theta: float, gait: dict[str, float] | None = None) -> None:
        """Walk at a velocity, m/s, m/s, rad/s, with gait parameters by their NAOqi names."""
        with contextlib.suppress(MoveRefused):  # `ended` tells why
            self.robot.locomotion.move(x, y, theta, feet_gait(gait or {}))

    def wander(self) -> None:
        """Walk at random shares -1..1 of the largest velocities."""
        x, y, theta = (self.chance.uniform(-1.0, 1.0) for _ in range(3))
        with contextlib.suppress(MoveRefused):  # `ended` tells why
            self.robot.locomotion.move_toward(x, y, theta, feet_gait({}))

    def walk_to(self, x: float, y: float, theta: float) -> Task:
        """Walk to a place as seen from here, m, m, rad."""
        return self.robot.locomotion.move_to([FootPose(x, y, theta)], feet_gait({}))

    def push(self, impulse: float, angle: float) -> None:
        """Push the torso, N s, where the world's angle points, rad."""
        force = impulse / PUSH_TIME
        self.robot.push((force * math.cos(angle), force * math.sin(angle), 0.0), PUSH_TIME)

    def stop(self) -> bool:
        """End the walk and give the robot 2 s more; whether it stands then."""
        task = self.robot.locomotion.stop()
        self.until(lambda: task.finished, 10.0)
        self.run(2.0)
        return task.finished and self.stands

    def run(self, seconds: float) -> bool:
        """Let time pass, until the robot is no longer up; whether it still is."""
        self.until(lambda: False, seconds)
        return self.up

    def until(self, over: Callable[[], bool], longest: float) -> bool:
        """Let time pass until something holds or the robot is no longer up, at most so long, s; whether it holds."""
        end = self.time + longest - 1e-9
        while self.up and self.time < end and not over():
            self._tick()
        return over()

    def fall(self, longest: float = 4.0) -> None:
        """Let time pass until a body that falls has hit the floor, at most so long, s."""
        end = self.time + longest
        while self.impact is None and self.time < end:
            self._tick()

    def get_up(self, longest: float = 60.0) -> bool:
        """Let a robot that lies stand up by the way that everybody takes; whether it stands."""
        self.simulation.run(2.0)
        simulation = self.simulation
        way = PostureChange(self.robot, lambda: simulation.snapshot, "StandInit", 0.8, 3, load_moves())
        task, end = way.start(), self.time + longest
        while not task.finished and self.time < end:
            simulation.tick()
        return way.reached

    def _tick(self) -> None:
        now = self.simulation.tick()
        if self.noticed is None and self.robot.stability.falls.falling:
            self.noticed = now.time
        if any(self.robot.link_name(contact.link) in BODY for contact in now.contacts):
            self.impact = now.time if self.impact is None else self.impact
        dt = self.simulation.settings.tick_s
        for index, name, top in self._tops:
            share = abs(now.velocities[index]) / top
            self.fastest[name] = max(self.fastest[name], share)
            self._above[name] = self._above[name] + dt if share > 1.0 else 0.0
            self.longest_above[name] = max(self.longest_above[name], self._above[name])

    def _failed(self, cause: str, started: bool, obstacle: object) -> None:
        del started, obstacle
        self.ended = self.ended or cause
