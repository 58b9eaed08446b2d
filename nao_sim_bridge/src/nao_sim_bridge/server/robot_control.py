"""What clients may do to the robot: touch it, charge it, warm it, break its devices. For any thread."""

from __future__ import annotations

from typing import Any, Callable, Sequence

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.body.temperatures import BATTERY, HEAD
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.binding.arguments import known, number

COLDEST, HOTTEST = -40.0, 200.0


class HandsControl:
    def __init__(self, runner: RobotRunner) -> None:
        self._runner = runner

    def touch(self, sensors: Sequence[str], duration: float, wait: bool = True) -> Task:
        """Touch a sensor, or stroke over several, by their names or those of their events, for `duration` s.

        The time is simulated, see `Hands.touch`. The task ends when the hand has gone or, without a duration, when it
        is felt; without `wait`, when it begins to come.
        """
        wanted, lasting = _names(sensors), number(duration, "duration", 0.0)

        def touch() -> Task | None:
            task = self._runner.simulation.hands.touch(wanted, lasting)
            return task if wait else None

        return self._runner.execute(touch, "touch")

    def release(self, sensors: Sequence[str] = ()) -> Task:
        """Let go; the task ends when the hands begin to leave: those on these sensors or, if none is named, all."""
        wanted = _names(sensors)
        return self._runner.execute(lambda: self._runner.simulation.hands.release(wanted), "release")


def _names(sensors: Any) -> list[str]:
    if not isinstance(sensors, (list, tuple)) or not all(isinstance(name, str) for name in sensors):
        raise BadValue("sensors", sensors, "a list of names")
    return list(sensors)


class HealthControl:
    """Changes what a user of a robot cannot: each task ends when it is done."""

    def __init__(self, runner: RobotRunner) -> None:
        self._simulation = runner.simulation
        self._runner = runner

    def plug_charger(self, plugged: bool) -> Task:
        return self._run(lambda: self._simulation.robot.power.battery.plug(bool(plugged)), "plugCharger")

    def set_battery_charge(self, charge: float) -> Task:
        """Have the battery this full, 0..1; it goes on from there. A BadValue when `charge` is not within 0..1."""
        wanted = number(charge, "charge", 0.0, 1.0)
        return self._run(lambda: self._simulation.robot.power.battery.put(wanted), "setBatteryCharge")

    def set_temperature(self, device: str, celsius: float) -> Task:
        """Have the motor of a joint, the computer in the `Head` or the `Battery` this warm, degC.

        A BadValue when the temperature makes no sense, an UnknownName when there is no such device.
        """
        wanted = number(celsius, "temperature", COLDEST, HOTTEST)
        joints = self._simulation.model.joint_index
        known(device, "device", (*joints, HEAD, BATTERY))

        def warm_up() -> None:
            power = self._simulation.robot.power
            if device == HEAD:
                power.head = wanted
            elif device == BATTERY:
                power.battery.warm_up(wanted)
            else:
                power.warm_up(joints[device], wanted)

        return self._run(warm_up, "setTemperature")

    def break_device(self, name: str) -> Task:
        """Let the motor of a joint or a sensor fail, see `Faults`; the task fails where there is no such device."""
        return self._run(lambda: self._simulation.robot.faults.break_device(name), "breakDevice")

    def repair_device(self, name: str) -> Task:
        """Have a device work again; the task fails where there is no such device."""
        return self._run(lambda: self._simulation.robot.faults.repair(name), "repairDevice")

    def devices(self) -> list[str]:
        return list(self._simulation.robot.faults.known)

    def _run(self, change: Callable[[], None], name: str) -> Task:
        return self._runner.execute(change, name)
