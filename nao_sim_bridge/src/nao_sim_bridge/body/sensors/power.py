"""What motors draw, what of it becomes heat, and what is left in the battery."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, Sequence, Tuple

from nao_sim_bridge.base.settings import Settings
from nao_sim_bridge.body.sensors.battery import Battery
from nao_sim_bridge.model.robot_model import Motor, RobotModel, joint_kind

# Heat and charge change slowly: the currents are looked at this often, in s.
PERIOD = 0.1


@dataclass(frozen=True)
class Work:
    """What all motors do at one moment.

    Attributes:
        losses: (26,) heat in the windings, W.
        drawn: What all of them take from the battery together, W.
        stiff: How many of them are driven.
    """

    losses: Tuple[float, ...]
    drawn: float
    stiff: int


class Motors:
    """The 26 motors.

    The torque constant is the voltage over the no-load speed of the motor, its resistance the voltage over the current
    at stall; what a motor takes is what its windings lose and what its shaft gives. A motor that is driven backwards
    gives nothing back: the boards burn it.

    Attributes:
        heat_capacities: (26,) J/K.
    """

    def __init__(self, model: RobotModel, settings: Settings) -> None:
        voltage = settings.battery.voltage_v
        motors = [motor_of(model, joint.name) for joint in model.joints]
        constants = [voltage / motor.no_load_speed for motor, _ in motors]
        self._efficiency = settings.motor.gear_efficiency
        self._amps_per_torque = tuple(
            [1.0 / (constant * ratio * self._efficiency) for constant, (_, ratio) in zip(constants, motors)]
        )
        self._resistances = tuple(
            [voltage * constant / motor.stall_torque for constant, (motor, _) in zip(constants, motors)]
        )
        big = settings.motor.big_motor
        self.heat_capacities = tuple(
            [
                settings.motor.big_heat_capacity_j_per_k
                if motor.model.startswith(big)
                else settings.motor.small_heat_capacity_j_per_k
                for motor, _ in motors
            ]
        )

    def currents(self, torques: Sequence[float]) -> Tuple[float, ...]:
        """(26,) current in A, absolute, of each motor from its torque in N m."""
        return tuple([abs(torque) * amps for torque, amps in zip(torques, self._amps_per_torque)])

    def work(self, torques: Sequence[float], velocities: Sequence[float], efforts: Sequence[float]) -> Work:
        """What the motors do.

        Args:
            torques: (26,) N m.
            velocities: (26,) of the joints, rad/s.
            efforts: (26,) share of the full torque that each may give; a limp motor is not driven, and what brakes it
                is the friction of its gears.
        """
        losses, drawn, stiff = [], 0.0, 0
        rows = zip(torques, velocities, efforts, self._amps_per_torque, self._resistances)
        for torque, velocity, effort, amps, resistance in rows:
            if effort <= 0.0:
                losses.append(0.0)
                continue
            loss = resistance * (torque * amps) ** 2
            losses.append(loss)
            drawn += max(0.0, loss + torque * velocity / self._efficiency)
            stiff += 1
        return Work(tuple(losses), drawn, stiff)


def motor_of(model: RobotModel, joint: str) -> Tuple[Motor, float]:
    """The motor that drives a joint, and the ratio of its gear.

    Raises:
        KeyError: No motor does.
    """
    kind = joint_kind(joint)
    for motor in model.motors:
        if kind in motor.gear_ratio_of:
            return motor, motor.gear_ratio_of[kind]
    raise KeyError(f"no motor drives {joint}")


class PowerSystem:
    """Temperatures of motors and head, and the battery; cold and full at the start.

    Attributes:
        temperatures: (26,) motor temperatures, degC.
        head: Temperature of the computer in the head, degC.
        battery: The battery.
    """

    def __init__(self, heat_capacities: Sequence[float], settings: Settings, tells_plugged: bool = False) -> None:
        self._settings = settings
        self._capacities = tuple(heat_capacities)
        ambient = settings.motor.ambient_c
        self.temperatures: Tuple[float, ...] = (ambient,) * len(self._capacities)
        self.head = ambient
        self.battery = Battery(settings.battery, ambient, tells_plugged)
        self._elapsed = 0.0

    def warm_up(self, motor: int, celsius: float) -> None:
        """Put a motor to a temperature, degC."""
        self.temperatures = (*self.temperatures[:motor], celsius, *self.temperatures[motor + 1 :])

    def advance(self, read_work: Callable[[], Work], dt: float) -> None:
        """Let `dt` s pass; `read_work()` gives what the motors do when it is needed."""
        self._elapsed += dt
        if self._elapsed < PERIOD:
            return
        motor, head = self._settings.motor, self._settings.head
        work, dt = read_work(), self._elapsed
        ambient, cooling = motor.ambient_c, motor.cooling_per_s
        self.temperatures = tuple(
            [
                warmth + dt * (watts / capacity - cooling * (warmth - ambient))
                for warmth, watts, capacity in zip(self.temperatures, work.losses, self._capacities)
            ]
        )
        self.head += dt * (ambient + head.warmth_k - self.head) / head.time_constant_s
        draw = self._settings.battery.idle_w + self._settings.battery.driver_w * work.stiff + work.drawn
        self.battery.advance(draw, dt)
        self._elapsed = 0.0
