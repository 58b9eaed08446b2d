"""The simulated NAO as one thing: commands in, physics, sensors out. One thread only."""

from __future__ import annotations

import random
import threading
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Callable, Iterable, Mapping, Sequence

from nao_sim_bridge.base.errors import BadValue, NotFinite, UnknownName, check_finite
from nao_sim_bridge.base.readings import Pose
from nao_sim_bridge.base.rotations import Vector3
from nao_sim_bridge.base.settings import Settings
from nao_sim_bridge.base.sizes import require_few
from nao_sim_bridge.base.tasks import TaskIds
from nao_sim_bridge.body.faults import Faults
from nao_sim_bridge.body.hand import pointed_at
from nao_sim_bridge.body.joint_commands import JointCommands
from nao_sim_bridge.body.led_animations import power_on
from nao_sim_bridge.body.leds import LedBank
from nao_sim_bridge.body.physics import NO_PUSHES, Physics
from nao_sim_bridge.body.sensors.body import BodySensors
from nao_sim_bridge.body.sensors.inertial import InertialUnit
from nao_sim_bridge.body.sensors.power import PowerSystem
from nao_sim_bridge.body.sensors.snapshot import Imu, Snapshot
from nao_sim_bridge.body.sensors.sonar import Sonars
from nao_sim_bridge.body.sensors.surroundings import PhysicalSurroundings
from nao_sim_bridge.control.balance.odometry import Odometry
from nao_sim_bridge.control.balance.reflexes import Reflexes
from nao_sim_bridge.control.balance.stability import Stability
from nao_sim_bridge.control.joints.engine import MotionEngine
from nao_sim_bridge.core.scene import Scene
from nao_sim_bridge.model.leds_layout import LedLayout
from nao_sim_bridge.model.robot_model import RobotModel

if TYPE_CHECKING:
    from nao_sim_bridge.body.sensors.imperfection import Imperfection
    from nao_sim_bridge.control.whole_body.whole_body import WholeBody
    from nao_sim_bridge.walk.locomotion import Locomotion

# The links under which the soles are.
ANKLES = ("l_ankle", "r_ankle")
DRIVES = ("position", "velocity", "torque")


@dataclass(frozen=True)
class _Push:
    link: str
    force: Vector3
    until: float


class SimulatedRobot:
    """Motors, LEDs and sensors of one NAO around its physics.

    Attributes:
        model: Its tables.
        joints: Command angles and stiffnesses.
        motion: Tasks and targets of the joints.
        stability: Balance and fall manager.
        reflexes: What protects the robot from itself, from obstacles and from heat, and moves idle chains.
        leds: The LEDs.
        power: Heat of the motors, and the battery.
        faults: What is broken.
        random: The only source of chance, so that a seed decides everything.
        driven: Whether something else than ALMotion's control drives the joints; see `drive`.
        getting_up: True while a move runs that takes the robot off its feet or back on them: leaning is no fall then.

    Its clock starts at 0 with it: after a reset equal commands must meet equal times, to the last bit.

    Args:
        angles: (26,) joint angles it was placed with, rad (hands 0..1).
    """

    def __init__(
        self,
        model: RobotModel,
        leds: LedLayout,
        settings: Settings,
        physics: Physics,
        angles: Sequence[float],
        scene: Scene,
        task_ids: TaskIds,
    ) -> None:
        self.model = model
        self.led_layout = leds
        self.random = random.Random(scene.seed)
        self._dt = settings.tick_s
        self.joints = JointCommands(model, angles)
        self.motion = MotionEngine(self.joints, task_ids)
        self.stability = Stability(model, settings, self.joints, self.motion)
        self.reflexes = Reflexes(model, self.joints, self.motion, lambda: self._sensed)
        self._settings = settings
        self._making = threading.Lock()
        self._whole_body: WholeBody | None = None
        self._locomotion: Locomotion | None = None
        self.leds = LedBank(len(leds.devices), task_ids)
        self.task_ids = task_ids
        self.leds.set(power_on(leds))
        self._sensors = BodySensors(model, settings, physics.links)
        self._physics = physics
        self._ankles = [physics.links[name] for name in ANKLES]
        self._imu = InertialUnit(model.imu["Accelerometer"].position, settings.gravity_m_s2, physics.start.yaw)
        self._imperfection = self._imperfect(scene)
        self._odometry: Odometry | None = None
        self._sonars = Sonars(model, PhysicalSurroundings(physics.engine, physics.robot))
        self.power = PowerSystem(self._sensors.motors.heat_capacities, settings, model.version != "V6")
        self.power.battery.plug(scene.charger)
        self.faults = Faults(model, self._sensors.touch_names)
        self.reflexes.faults = self.faults
        self._pushes: list[_Push] = []
        self._fingers: frozenset[str] = frozenset()
        self._pointed: frozenset[str] = frozenset()
        self._link_names = {index: name for name, index in physics.links.items()}
        self.getting_up = False
        self._measured = tuple(angles)
        self._sensed: Snapshot | None = None
        self._torques: Sequence[float] | None = None
        self.driven = False
        self._ticks = 0

    @property
    def time(self) -> float:
        """Simulated time since the robot was put into the world, s."""
        return self._ticks * self._dt

    @property
    def whole_body(self) -> WholeBody:
        """Control of all joints at once; made when somebody first asks for it. Any thread."""
        if self._whole_body is None:
            from nao_sim_bridge.control.whole_body.whole_body import WholeBody  # few ask for it

            with self._making:
                self._whole_body = self._whole_body or WholeBody(self.model, self.joints, self.motion)
        return self._whole_body

    @property
    def locomotion(self) -> Locomotion:
        """Walks; made when somebody first asks for it. Any thread."""
        if self._locomotion is None:
            from nao_sim_bridge.walk.locomotion import Locomotion  # as for `whole_body`

            with self._making:
                self._locomotion = self._locomotion or Locomotion(
                    self.model,
                    self._settings,
                    self.joints,
                    self.motion,
                    self.stability,
                    self.reflexes,
                    self.task_ids,
                    lambda: self._sensed,
                )
        return self._locomotion

    @property
    def walking(self) -> bool:
        """Whether a walk runs, from its begin until the robot stands again."""
        return self._locomotion is not None and self._locomotion.active

    @property
    def snapshot(self) -> Snapshot | None:
        """What was sensed at the last tick; None before the first one."""
        return self._sensed

    @property
    def true_positions(self) -> tuple[float, ...]:
        """(26,) joint angles as they are, not as noisy or late sensors say, rad (hands 0..1)."""
        return self._measured

    def warm_up(self, joint: str, celsius: float) -> None:
        """Put a motor to a temperature, degC, from where it goes on by itself.

        Raises:
            UnknownName: There is no such joint.
        """
        if joint not in self.model.joint_index:
            raise UnknownName("joint", joint, self.model.joint_index)
        self.power.warm_up(self.model.joint_index[joint], celsius)

    def link_name(self, index: int) -> str:
        """Name of the link that a contact names by its index."""
        return self._link_names.get(index, "torso")

    def push(self, force: Vector3, duration: float, link: str = "torso") -> None:
        """Push a link with `force` (N, in world) for `duration` s from now on."""
        if link != "torso" and link not in self._physics.links:
            raise UnknownName("link", link, ["torso", *self._physics.links])
        check_finite(f"push of {link}", (*force, duration))
        self._pushes = [push for push in self._pushes if push.until > self.time]
        require_few("push", len(self._pushes) + 1, "pushes")
        self._pushes.append(_Push(link, force, self.time + duration))

    def press(self, sensors: Iterable[str]) -> None:
        """Simulated fingers on these touch sensors, and on no others, from now on.

        Raises:
            UnknownName: There is no such sensor.
        """
        wanted = frozenset(sensors)
        for name in wanted:
            if name not in self._sensors.touch_names:
                raise UnknownName("touch sensor", name, self._sensors.touch_names)
        self._fingers = wanted

    def point_at(self, ray: tuple[Vector3, Vector3] | None) -> None:
        """Touch the sensor that a line of sight (eye in m, unit vector, in world) meets, and no other; None: none."""
        self._pointed = frozenset() if ray is None else pointed_at(self.model, self._physics, *ray)

    def drive(self, mode: str, values: Sequence[float]) -> None:
        """Drive all joints past everything that ALMotion does, until `let_go`.

        No task, target, balance or protection moves a joint meanwhile.

        Args:
            mode: "position": rad; "velocity": rad/s, at most the torque of the motors; "torque": N m, cut at what the
                motors give, and gears without friction.
            values: (26,) in the order of the body.

        Raises:
            UnknownName: There is no such mode.
            NotFinite: One of the values is not.
        """
        if mode not in DRIVES:
            raise UnknownName("drive", mode, DRIVES)
        check_finite("values of the joints", values)
        torques = None
        if mode == "torque":
            torques = [min(max(v, -limit), limit) for v, limit in zip(values, self._physics.torque_limits)]
            if self._torques is None:
                self._physics.free_joints()
        elif mode == "position":
            self._physics.drive_positions(values)
        else:
            self._physics.drive_velocities(values)
        self._torques, self.driven = torques, True

    def tell_motors(self) -> None:
        """Tell the motors anew what they were told: the engine does not keep that with the state of the bodies."""
        if not self.driven:
            self._physics.drive(self.joints)

    def let_go(self) -> None:
        """Leave the joints to ALMotion's control again, where they are now."""
        if self.driven:
            self._torques, self.driven = None, False
            self.joints.hold(self._measured, range(len(self._measured)))

    def scale_friction(self, share: float) -> None:
        """Let body and soles have this share of their friction until the next reset.

        Raises:
            BadValue: It is not above 0, or above 10.
        """
        if not 0.0 < share <= 10.0:
            raise BadValue("share of friction", share, "above 0 to 10")
        self._physics.scale_friction(share)

    def act(self) -> None:
        """First half of a tick for a robot that is alone: LEDs, motion and motors up to its end, then physics."""
        self.command()
        self._physics.step(self.take_pushes())

    def command(self) -> None:
        """First half of a tick: LEDs, motion and motors up to its end, before the step of physics."""
        self._ticks += 1
        if self.driven:
            return
        now = self.time
        self.task_ids.guard.call(self.leds.tick, now)
        walking = self.walking
        if self._whole_body is not None:
            self._whole_body.suspended = self.getting_up or walking
        self.reflexes.prepare(self._sensed, self.getting_up or self.stability.falls.falling, self.stability.on_feet)
        if walking:
            self.locomotion.tick(self._dt)
            self.motion.idle = self.locomotion.arms.over(self.motion.idle)
            self.reflexes.self_collision.suspended |= self.locomotion.arms.alone
        self.motion.tick(now, self._dt)
        if self._sensed is not None:
            self.stability.act(self._sensed, self.getting_up, self._dt)
        self.joints.slip(self._measured)
        if self._sensed is not None:
            self.reflexes.limit_efforts(self._sensed, self._dt)
        if self.joints.changed:
            try:
                self._physics.drive(self.joints)
            except NotFinite as error:
                self._put_right(error)
            self.joints.changed = False

    def _put_right(self, error: NotFinite) -> None:
        """Leave joints where they are whose commands are not finite; what moves them ends."""
        self.task_ids.guard.caught("motion", error)
        self.motion.kill_using(self.joints.put_right(self._measured))
        self._physics.drive(self.joints)

    def take_pushes(self) -> Mapping[str, Vector3]:
        """Forces on links in the coming step of physics, N, in world, by link; those on one link add up."""
        if not self._pushes:
            return NO_PUSHES
        forces: dict[str, Vector3] = {}
        for push in self._pushes:
            x, y, z = forces.get(push.link, (0.0, 0.0, 0.0))
            forces[push.link] = (x + push.force[0], y + push.force[1], z + push.force[2])
        self._pushes = [push for push in self._pushes if push.until > self.time + 1e-9]
        return forces

    def turning(self) -> Sequence[Callable[[], None]]:
        """What is to be called before each step of the engine for joints that are driven by torques."""
        return () if self._torques is None else (partial(self._physics.turn_joints, self._torques),)

    def sense(self, tick: int, now: float, landed: bool = True, ticks: int = 1) -> Snapshot:
        """Second half of a tick: read every sensor, for a snapshot of `tick` and `now`, s.

        Args:
            landed: False at the start, when nothing has pressed on the robot yet.
            ticks: How many have passed since the last time.
        """
        span = ticks * self._dt
        joints = self._physics.read_joints()
        self._measured = joints.positions
        body = self._physics.read_body()
        contacts = self._physics.read_contacts() if landed else ()
        imu = self._imu.read(body, span)
        link_poses = self._physics.link_poses({contact[0] for contact in contacts}, body.pose)
        work = self._sensors.motors.work
        self.power.advance(lambda: work(joints.torques, joints.velocities, self.joints.efforts), span)
        if self._imperfection is not None:
            joints, imu, contacts, link_poses = self._imperfection.of(joints, imu, contacts, link_poses)
        loads = self._sensors.foot_loads(contacts)
        self._sensed = Snapshot(
            tick=tick,
            time=now,
            age=self.time,
            positions=joints.positions,
            velocities=joints.velocities,
            torques=joints.torques,
            temperatures=self.power.temperatures,
            commands=self.joints.commands,
            stiffnesses=self.joints.stiffnesses,
            torso=body.pose,
            linear_velocity=body.linear_velocity,
            angular_velocity=body.angular_velocity,
            imu=imu,
            odometry=self._reckon(joints.positions, imu, loads),
            sonars=self._sonars.read(self.time, body.pose),
            echoes=self._sonars.echoes,
            head_temperature=self.power.head,
            battery=self.power.battery.reading,
            objects=self._physics.bodies.read(),
            placed=self._physics.bodies.placed,
            gone=self._physics.bodies.gone,
            contacts=contacts,
            link_poses=link_poses,
            foot_loads=loads,
            fingers=self._fingers | self._pointed,
            sensors=self._sensors,
        )
        if self.faults.sensors:
            self._sensed = self.faults.spoil(self._sensed)
        return self._sensed

    def shoot_sonars(self) -> Snapshot | None:
        """What is sensed now, with sonars that have just measured; None before the first tick."""
        if self._sensed is None:
            return None
        self._sonars.reset()
        sonars = self._sonars.read(self.time, self._physics.read_body().pose)
        now = replace(self._sensed, sonars=sonars, echoes=self._sonars.echoes)
        return self.faults.spoil(now) if self.faults.sensors else now

    def _imperfect(self, scene: Scene) -> Imperfection | None:
        """What spoils and delays the readings; None when nothing does."""
        ticks = round(scene.sensor_delay / self._dt)
        if not scene.sensor_noise and not ticks:
            return None
        from nao_sim_bridge.body.sensors.imperfection import Delay, Imperfection, Noise, load_noise  # few need them

        noise = None
        if scene.sensor_noise:
            noise = Noise(load_noise(), scene.sensor_noise, self.random, self._ankles, self._dt)
        return Imperfection(noise, Delay(ticks))

    def _reckon(self, positions: Sequence[float], imu: Imu, loads: Sequence[float]) -> Pose:
        if self._odometry is None:
            self._odometry = Odometry(self.model, positions, imu.angles)
        return self._odometry.update(positions, imu.angles, loads)
