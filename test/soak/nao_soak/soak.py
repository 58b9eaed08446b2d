"""The soak: starts everything, sends goals and garbage, lets accidents happen, and looks whether all stays well."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from contextlib import nullcontext
from dataclasses import asdict, dataclass, field
from pathlib import Path

import rospy
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Image, JointState

from .accidents import Accidents
from .clients import Client, until
from .ill_clients import IllClients
from .levels import MEMORY, Levels
from .machines import Machines
from .processes import Servers, Simulator, ros_environment

START_LIMIT = 120.0
RECOVERY_LIMIT = 60.0
SAMPLE_PERIOD = 2.0
LOGS, SCREEN = "logs of the nodes", "what the nodes print"
LOG_RATES = {LOGS: 12.0, SCREEN: 8.0}
"""kB a second that they may grow together: each goal that is refused leaves a line, and there are dozens a second; each
message that is none leaves twenty lines of rospy's."""
GARBAGE = Path(__file__).with_name("garbage.py")
TOPICS = {"joint_states": JointState, "odom": Odometry, "nao_robot/camera/top/image_raw": Image}
"""What the driver publishes when all is well."""


@dataclass(frozen=True)
class Plan:
    """What the soak is made of.

    Attributes:
        seconds: How long goals are sent.
        speed: Simulated seconds a second.
        kills: How often the simulator is killed.
        drops: How often the network drops, 5 s each.
        strange: Share of the fields with strange values.
        seed: Where chance comes from.
        servers: Which are tried.
        folder: Where logs and files go.
        ill: After how many s a client of the robot is killed, beside one that is stopped and one that loads files; 0
            for no such clients.
        flat: Whether it is a fault when a process holds more and more.
    """

    seconds: float
    speed: float
    kills: int
    drops: int
    strange: float
    seed: int
    servers: tuple[str, ...]
    folder: Path
    ill: float = 60.0
    flat: bool = True


@dataclass
class Findings:
    """What came out.

    Attributes:
        ends: Server -> how its goals ended.
        slowest_end_s: Server -> longest time from a cancel to the end of the goal.
        accidents: What happened.
        memory_course_mb: Process -> at each sample.
        ill_killed: How many clients of the robot were killed.
        levels: Process and what it holds -> when it had settled, at the end; of the robot if it is never killed.
        faults: What must not be; empty if all is well.
    """

    ends: dict[str, dict[str, int]] = field(default_factory=dict)
    slowest_end_s: dict[str, float] = field(default_factory=dict)
    accidents: list[str] = field(default_factory=list)
    memory_course_mb: dict[str, list[float]] = field(default_factory=dict)
    ill_killed: int = 0
    levels: dict[str, tuple[float, float]] = field(default_factory=dict)
    faults: list[str] = field(default_factory=list)

    def write(self, path: Path) -> None:
        """Write everything as JSON."""
        path.write_text(json.dumps(asdict(self), indent=2), encoding="utf-8")


def soak(plan: Plan, where: Machines) -> Findings:
    """Do it there; takes a minute or two more than the plan says."""
    plan.folder.mkdir(parents=True, exist_ok=True)
    with where as machines, Servers(machines, plan.folder) as servers:
        os.environ.update(ros_environment(machines, plan.folder))
        with Simulator(machines, plan.folder, plan.speed, plan.seed) as simulator:
            return _Soak(plan, machines, servers, simulator).run()


class _Soak:
    def __init__(self, plan: Plan, machines: Machines, servers: Servers, simulator: Simulator) -> None:
        self._plan, self._servers, self._simulator = plan, servers, simulator
        self._accidents = Accidents(machines, simulator, plan.kills, plan.drops, plan.seconds, plan.seed)
        self._levels = Levels(SAMPLE_PERIOD, log_rates=LOG_RATES)
        self._ill = IllClients(machines.robot, machines.nao_port, plan.ill)
        self._findings = Findings()
        rospy.init_node("soak", anonymous=True, disable_signals=True)
        self._clients = [Client(server, plan.seed, plan.strange) for server in plan.servers]

    def run(self) -> Findings:
        if not self._everything_works("at the start", START_LIMIT):
            return self._findings
        nodes = self._servers.nodes()
        _say(f"{len(nodes)} nodes, {len(self._clients)} servers; {self._plan.seconds:g} s of goals")
        for client in self._clients:
            client.start()
        garbage = subprocess.Popen([sys.executable, str(GARBAGE), str(self._plan.seed), *self._plan.servers])
        try:
            with self._ill if self._plan.ill else nullcontext():
                self._let_it_happen(nodes)
            if garbage.poll() is not None:
                self._findings.faults.append("the sender of garbage ended by itself")
        finally:
            garbage.kill()
            garbage.wait()
        for client in self._clients:
            client.stop()
        self._everything_works("at the end", RECOVERY_LIMIT)
        self._look_at(nodes)
        self._tell()
        return self._findings

    def _let_it_happen(self, nodes: dict[str, int]) -> None:
        began = time.monotonic()
        next_sample = 0.0
        while (now := time.monotonic() - began) < self._plan.seconds:
            for accident in self._accidents.due(now):
                _say(f"{now:6.0f} s  {accident.name}")
                self._findings.accidents.append(f"{accident.name} at {now:.0f} s")
                accident.happen()
            if now >= next_sample:
                next_sample = now + SAMPLE_PERIOD
                for name, pid in nodes.items():
                    self._levels.add(name, pid)
                self._levels.add(LOGS, log=self._servers.logs)
                self._levels.add(SCREEN, log=self._servers.screen)
                if not self._plan.kills:
                    self._levels.add(self._simulator.name, self._simulator.pid, self._simulator.log)
            time.sleep(0.05)

    def _everything_works(self, when: str, limit: float) -> bool:
        """Whether each server does what it is asked for, and the driver publishes; faults if not."""
        deadline = time.monotonic() + limit
        left = lambda: max(1.0, deadline - time.monotonic())  # noqa: E731
        faults = []
        for client in self._clients:
            if not client.wait_for_server(left()):
                faults.append(f"{client.server}: no server {when}")
                continue
            told: list[str] = []
            works = lambda client=client, told=told: bool(self._simulator.pid) and _works(client, told)  # noqa: E731
            if not until(works, left()):
                faults.append(f"{client.server}: does not work {when}: {told[-1] if told else ''}")
        for topic, kind in TOPICS.items():
            try:
                rospy.wait_for_message(topic, kind, left())
            except rospy.ROSException:
                faults.append(f"{topic}: nothing comes {when}")
        if faults:
            faults.append(self._simulator.tell_where_it_is())
        self._findings.faults += faults
        return not faults

    def _look_at(self, nodes: dict[str, int]) -> None:
        faults = self._findings.faults
        if not self._servers.running:
            faults.append("roslaunch or the ROS master ended")
        now = self._servers.nodes()
        faults += [f"{name}: is gone" for name in nodes if name not in now]
        faults += [f"{name}: was started anew" for name, pid in nodes.items() if now.get(name, pid) != pid]
        for client in self._clients:
            faults += [f"{client.server}: a goal did not end: {goal}" for goal in client.hung]
            faults += [f"{client.server}: a goal was lost: {goal}" for goal in client.lost]
            if client.unexplained:
                faults.append(f"{client.server}: {client.unexplained} goals were aborted without a word")
            if not client.ends:
                faults.append(f"{client.server}: no goal ended")
        if self._plan.flat:
            faults += self._levels.swollen()

    def _tell(self) -> None:
        findings = self._findings
        findings.ends = {client.server: dict(client.ends) for client in self._clients}
        findings.slowest_end_s = {client.server: round(client.slowest, 2) for client in self._clients}
        findings.memory_course_mb = self._levels.course(MEMORY)
        findings.ill_killed = self._ill.killed
        findings.levels = {n: (round(a, 1), round(b, 1)) for n, (a, b) in self._levels.growth().items()}


def _works(client: Client, told: list[str]) -> bool:
    end, text = client.sensible_end(RECOVERY_LIMIT)
    told.append(f"{end}: {text}")
    return end == "succeeded"


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)
