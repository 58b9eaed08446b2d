"""Functions that read touch, sonars, feet, battery and temperatures, and functions that wait for a touch."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from genpy import Time
from sensor_msgs.msg import BatteryState

from nao_library_msgs.msg import TouchBinding
from naoqi.errors import RobotError

from ..core.chain import Part, checked_by
from ..core.fields import require_known
from ..core.memory_functions import MEMORY
from ..core.nao_facts import (
    BATTERY_STATUS,
    BY_EVENT,
    CHARGE,
    CHARGING_BIT,
    CORNERS,
    CURRENT,
    FULL_BIT,
    SIDES,
    SONARS,
    Sensor,
    echo_of,
    sensor_key,
    sensors_of,
    temperature_key,
    weight_keys,
)
from ..core.robot_events import ExtractorUse, subscriber_name
from ..nao_basic import NaoBasic
from .tactile_fields import (
    CLICKS,
    DEFAULT_DISTANCE,
    FEET,
    Bumpers,
    Clicks,
    Contact,
    Distance,
    Enable,
    Feet,
    Presses,
    Revert,
    Sensors,
    Sonars,
    Timeout,
    Touch,
    TouchTime,
    TouchWatch,
    Warm,
    require_touch,
    timeout_of,
    wanted_of,
    words_of,
)

SONAR = "ALSonar"
BATTERY_KEYS = (
    CHARGE,
    CURRENT,
    temperature_key("Battery"),
    *(sensor_key("Battery/Charge", part) for part in ("TotalVoltage", "RemainingCapacity", "FullChargeCapacity")),
    BATTERY_STATUS,
)
HEAD, PACK = "head", "battery"
SONAR_START = 0.35
"""s until a sonar that was switched on has measured: it does ten times a second."""


class Measurements:
    """What the functions of one chain felt."""

    def __init__(self) -> None:
        self.touched: list[Contact] = []
        self.sonars: list[tuple[str, float]] = []
        self.weights: list[tuple[str, float]] = []
        self.batteries: list[BatteryState] = []
        self.heat: list[tuple[str, float, int]] = []
        self.fell = False
        self.bindings: list[TouchBinding] = []

    def touch(self, contacts: Sequence[Contact]) -> list[str]:
        """Note what was touched, and answer the names."""
        self.touched += contacts
        return [contact.name for contact in contacts]

    def fill(self, result: Any) -> None:
        result.touched = [contact.name for contact in self.touched]
        result.touch_times = [Time.from_sec(contact.begin) for contact in self.touched]
        result.sonar_names, result.sonar = _columns(self.sonars, 2)
        result.fsr_names, result.fsr = _columns(self.weights, 2)
        result.battery = self.batteries
        result.devices, result.temperatures, result.heat = _columns(self.heat, 3)
        result.fell = self.fell
        result.bindings = self.bindings


class Senses(ExtractorUse):
    """What the robot feels now, and what the chain has felt.

    `measurements`: what the chain has felt so far; new for each goal. `sonar_on`: whether a goal has switched the
    sonars on for longer.
    """

    def __init__(self, module: NaoBasic, namespace: str) -> None:
        super().__init__(module, subscriber_name("NaoTactile", namespace))
        self.measurements = Measurements()
        self.sonar_on = False
        self._publish_feedback = module.publish_feedback

    def publish(
        self, status: str, touched: Sequence[str] = (), sonar: Sequence[float] = (), stamp: float | None = None
    ) -> None:
        """Publish what is felt meanwhile. Called from the thread that executes goals.

        `touched`: what is pressed. `sonar`: m, left and right. `stamp`: ROS time of the change, s; None for now.
        """
        self._publish_feedback(stamp=stamp, status=status, touched=list(touched), sonar=list(sonar))

    def pressed(self, sensors: Sequence[Sensor]) -> list[str]:
        """Short names of those that are pressed now."""
        keys = [key for sensor in sensors for key in sensor.keys]
        values = dict(zip(keys, self.values(keys)))
        return [sensor.name for sensor in sensors if any(_number(values[key]) > 0.5 for key in sensor.keys)]

    def contacts(self, sensors: Sequence[Sensor]) -> list[Contact]:
        """Those that are pressed now, and since when: now, where the robot does not tell."""
        pressed, now = self.pressed(sensors), self.clock.now()
        return [Contact(each.name, min(self._said(each, 1.0), now)) for each in sensors if each.name in pressed]

    def released(self, sensors: Sequence[Sensor]) -> list[Contact]:
        """Those that were let go at last, by their events, and when; the beginning of the touch is not asked for.

        A V6 refreshes the keys of its sensors twice a second only.
        """
        ends = [Contact(sensor.name, 0.0, self._said(sensor, 0.0)) for sensor in sensors]
        return [contact for contact in ends if contact.end < math.inf]

    def _said(self, sensor: Sensor, value: float) -> float:
        """ROS time, s, at which the event of a sensor had this value, if it was its last; else infinity."""
        try:
            return self.robot_clock.event_time(self.call, sensor.event, value, math.inf)
        except RobotError:  # it has not been raised yet
            return math.inf

    def sonar(self, sides: Sequence[str]) -> list[float]:
        """Distances in m; infinite where nothing is heard, not a number where a sonar failed."""
        return [echo_of(value) for value in self.values([SONARS[side] for side in sides])]

    def renew_sonar(self) -> None:
        """Switch the sonars of a robot on that has come back, if they were to be on."""
        if self.sonar_on:
            self.call_now(self.robot.proxy(SONAR), "subscribe", self.subscriber_for("goals"))

    def drop_sonar(self) -> None:
        """Let the sonars be silent, as far as this server is concerned."""
        if self.sonar_on:
            self.sonar_on = False
            self.stop_extractor(SONAR, "goals")

    def switch_sonar(self, enable: bool) -> None:
        if enable and not self.sonar_on:
            self.start_extractor(SONAR, "goals")
            self.sonar_on = True
        elif not enable:
            self.drop_sonar()

    def values(self, keys: Sequence[str]) -> list[Any]:
        return list(self.call(self.robot.proxy(MEMORY), "getListData", list(keys)))


class ReadingFunctions(Part):
    def __init__(self, module: NaoBasic, senses: Senses) -> None:
        self._module = module
        self._senses = senses

    def get_touched(self, sensors: Sensors) -> list[str]:
        """Which sensors are touched now."""
        return self._senses.measurements.touch(self._senses.contacts(sensors_of(sensors)))

    def get_bumpers(self, sensors: Bumpers) -> list[str]:
        """Which bumpers are pressed now."""
        return self._senses.measurements.touch(self._senses.contacts(sensors_of(sensors or ["bumpers"])))

    def get_sonar(self, sensors: Sonars) -> list[float]:
        """How far away what the sonars hear is, m, infinite if they hear nothing; they are switched on for it."""
        sides = words_of(sensors, SIDES, "sonar")
        if self._senses.sonar_on:
            distances = self._senses.sonar(sides)
        else:
            with self._senses.subscribed(SONAR, "read"):
                self._senses.wait(SONAR_START)
                distances = self._senses.sonar(sides)
        self._senses.measurements.sonars += zip(sides, distances)
        return distances

    def get_fsr(self, sensors: Feet) -> list[float]:
        """What rests on the corners of the feet and on each of them, kg."""
        names, keys = [], []
        for foot in words_of(sensors, FEET, "foot"):
            names += [f"{foot} {_words(corner)}" for corner in CORNERS] + [foot]
            keys += weight_keys(foot.split()[0])
        weights = [_number(value) for value in self._senses.values(keys)]
        self._senses.measurements.weights += zip(names, weights)
        return weights

    def get_battery(self) -> float:
        """Charge of the battery, 0..1; current, voltage and what else is known are in the result."""
        charge, current, temperature, voltage, rest, full, status = self._senses.values(BATTERY_KEYS)
        state = BatteryState(present=charge is not None, percentage=_number(charge), current=_number(current))
        state.header.stamp = Time.from_sec(self._module.clock.now())
        state.temperature = _number(temperature)
        state.voltage = _number(voltage) / 1000.0  # mV
        state.charge, state.capacity = _number(rest) / 1000.0, _number(full) / 1000.0  # mAh
        state.design_capacity = math.nan
        state.power_supply_technology = BatteryState.POWER_SUPPLY_TECHNOLOGY_LION
        state.power_supply_status = _supply(status, state.current)
        self._senses.measurements.batteries.append(state)
        return _number(charge)

    def get_temperatures(self, sensors: Warm) -> list[float]:
        """How warm motors, the computer in the head and the battery are, degrees Celsius."""
        sensors = [name.strip() for name in sensors]
        joints = self._joints(sensors)
        names = [name for name in (*joints, HEAD, PACK) if not sensors or name in joints or name in sensors]
        devices = [{HEAD: "Head", PACK: "Battery"}.get(name, name) for name in names]
        warmths = [_number(value) for value in self._senses.values([temperature_key(device) for device in devices])]
        states = self._senses.values([sensor_key(f"{device}/Temperature", "Status") for device in devices])
        self._senses.measurements.heat += [
            (name, warmth, int(state or 0)) for name, warmth, state in zip(names, warmths, states)
        ]
        return warmths

    def set_sonar_enabled(self, enable: Enable, revert: Revert) -> None:
        """Keep the sonars measuring until they are switched off again, or let them be silent."""
        before = self._senses.sonar_on
        self._senses.switch_sonar(enable)
        if revert:
            self._module.after_wait(lambda: self._senses.switch_sonar(before))
        if enable and not before:
            self._senses.wait(SONAR_START)  # what follows finds no old distances

    def _joints(self, sensors: Sequence[str]) -> list[str]:
        """Joints behind names of joints and chains."""
        motion = self._module.robot.proxy("ALMotion")
        body = list(self._module.call(motion, "getBodyNames", "Body"))
        if not sensors:
            return body
        known = ["Head", "LArm", "RArm", "LLeg", "RLeg", "Body", HEAD, PACK, *body]
        found: list[str] = []
        for name in sensors:
            if name in body:
                found.append(name)
            elif name not in (HEAD, PACK):
                require_known("sensors", name, known, "device whose temperature is known")
                found += self._module.call(motion, "getBodyNames", name)
        return list(dict.fromkeys(found))

    functions = {
        "getTouched": get_touched,
        "getBumpers": get_bumpers,
        "getSonar": get_sonar,
        "getFsr": get_fsr,
        "getBattery": get_battery,
        "getTemperatures": get_temperatures,
        "setSonarEnabled": set_sonar_enabled,
    }


def _columns(rows: Sequence[tuple[Any, ...]], count: int) -> tuple[list[Any], ...]:
    return tuple([row[place] for row in rows] for place in range(count))


def _number(value: Any) -> float:
    return float(value) if isinstance(value, (int, float)) else math.nan


def _words(corner: str) -> str:
    return "".join(f" {letter.lower()}" if letter.isupper() else letter for letter in corner).strip()


def _supply(status: Any, current: float) -> int:
    bits = int(status or 0)
    if bits >> FULL_BIT & 1:
        return BatteryState.POWER_SUPPLY_STATUS_FULL
    if bits >> CHARGING_BIT & 1 or current > 0.0:
        return BatteryState.POWER_SUPPLY_STATUS_CHARGING
    return BatteryState.POWER_SUPPLY_STATUS_DISCHARGING


SONAR_PERIOD = 0.1
"""s between two measurements of a sonar."""
FALLEN = "robotHasFallen"
WAITING = "waiting"
CHEST = sensors_of(["chest"])


class WaitingFunctions(Part):
    """Parameters are fields of TactileFunction. What a function waited for has the robot's own times."""

    def __init__(self, module: NaoBasic, senses: Senses) -> None:
        self._module = module
        self._senses = senses

    def _check_touch(self, touch: str, count: int, duration: float) -> None:
        require_touch(touch, count, duration)

    @checked_by(_check_touch)
    def wait_for_touch(
        self, sensors: Sensors, touch: Touch, count: Presses, duration: TouchTime, timeout: Timeout
    ) -> list[str]:
        """Wait until a sensor is pressed, let go, held, or pressed several times; answers which it was."""
        wanted = sensors_of(sensors)
        end = self._module.clock.now() + timeout_of(timeout)
        with self._senses.events_of(*(sensor.event for sensor in wanted)) as events:
            pressed = {contact.name: contact.begin for contact in self._senses.contacts(wanted)}
            watch = TouchWatch(wanted_of(touch, count, duration), pressed, self._module.clock.now())
            self._senses.publish(WAITING, touched=watch.pressed)
            while True:
                due = watch.due
                for event in events.until(end if due is None else min(due, end)):
                    when = self._senses.event_time(event)
                    touched = watch.tell(BY_EVENT[event.name].name, bool(event.value), when)
                    self._senses.publish(WAITING, touched=watch.pressed, stamp=when)
                    if touched:
                        return self._touched(touched)
                    if watch.due != due:
                        break  # something is held, or no longer
                else:
                    touched = self._held(watch, wanted)
                    if touched:
                        return self._touched(touched)
                    if self._module.clock.now() >= end:
                        already = "".join(f"; {name} is pressed already" for name in watch.pressed)
                        self._module.remark(f"no touch within {timeout_of(timeout):g} s{already}")
                        return []

    def _held(self, watch: TouchWatch, sensors: Sequence[Sensor]) -> list[Contact]:
        """What has been held long enough, also by the robot's times: that it was let go may be on the way."""
        if watch.due is None:
            return []
        held = [sensor for sensor in sensors if sensor.name in watch.pressed]
        told = [watch.tell(contact.name, False, contact.end) for contact in self._senses.released(held)]
        return [*(contact for contacts in told for contact in contacts), *watch.look(self._module.clock.now())]

    def _touched(self, contacts: Sequence[Contact]) -> list[str]:
        ends = [contact.end for contact in contacts]
        self._module.happened = (min(contact.begin for contact in contacts), max(ends) if all(ends) else 0.0)
        return self._senses.measurements.touch(contacts)

    def wait_for_chest_button(self, count: Clicks, timeout: Timeout) -> list[str]:
        """Wait until the chest button is clicked once, twice or three times; answers chest."""
        clicked, (button,) = CLICKS[count or 1], CHEST
        end = self._module.clock.now() + timeout_of(timeout)
        with self._senses.events_of(clicked, button.event) as events:
            presses = [contact.begin for contact in self._senses.contacts(CHEST)]
            self._senses.publish(WAITING, touched=["chest"] * len(presses))
            for event in events.until(end):
                if event.name == clicked:
                    # Of clicks that began before the wait the first contact is not known.
                    first = presses[-(count or 1)] if len(presses) >= (count or 1) else 0.0
                    # Where it is pressed again, its end is not known.
                    (last,) = self._senses.released(CHEST) or [Contact("chest", 0.0)]
                    return self._touched([Contact("chest", first, last.end)])
                when = self._senses.event_time(event)
                if event.value and when not in presses:
                    presses.append(when)
                self._senses.publish(WAITING, touched=["chest"] if event.value else [], stamp=when)
        self._module.remark(f"no click within {timeout_of(timeout):g} s")
        return []

    def wait_for_obstacle(self, sensors: Sonars, distance: Distance, timeout: Timeout) -> list[str]:
        """Wait until a sonar hears something nearer than a distance; answers which of them do."""
        sides = words_of(sensors, SIDES, "sonar")
        limit = distance or DEFAULT_DISTANCE
        end = self._module.clock.now() + timeout_of(timeout)
        with self._senses.subscribed(SONAR, "wait"):
            self._senses.publish(WAITING)
            # NAOqi's own events have a distance of their own; what the sonars measure is in the memory.
            self._senses.wait(SONAR_START)
            while True:
                now = self._module.clock.now()
                distances = dict(zip(sides, self._senses.sonar(sides)))
                self._senses.publish(WAITING, sonar=[distances.get(side, math.inf) for side in SIDES])
                near = {side: metres for side, metres in distances.items() if metres < limit}
                if near or self._module.clock.now() >= end:
                    self._senses.measurements.sonars += near.items()
                    self._module.happened = (now if near else 0.0, 0.0)
                    if not near:
                        self._module.remark(f"nothing nearer than {limit:g} m within {timeout_of(timeout):g} s")
                    return list(near)
                self._senses.wait(SONAR_PERIOD)

    def wait_for_fall(self, timeout: Timeout) -> bool:
        """Wait until the robot has fallen; answers whether it has."""
        end = self._module.clock.now() + timeout_of(timeout)
        with self._senses.events_of(FALLEN) as events:
            self._senses.publish(WAITING)
            for event in events.until(end):
                if event.value:
                    self._module.happened = (self._senses.event_time(event), 0.0)
                    self._senses.measurements.fell = True
                    return True
        self._module.remark(f"no fall within {timeout_of(timeout):g} s")
        return False

    functions = {
        "waitForTouch": wait_for_touch,
        "waitForChestButton": wait_for_chest_button,
        "waitForObstacle": wait_for_obstacle,
        "waitForFall": wait_for_fall,
    }
