"""Constants, angles on the circle, limits, inertia, a digital filter and a PID controller."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import MutableSequence
from numbers import Real
from typing import List, Union

from almath._components import AlmathError, as_number, as_numbers, require
from almath.positions import Position3D

PI = math.pi
PI_2 = math.pi / 2.0
PI_4 = math.pi / 4.0
TO_RAD = math.pi / 180.0
TO_DEG = 180.0 / math.pi

AXIS_MASK_NONE = 0
AXIS_MASK_X = 1
AXIS_MASK_Y = 2
AXIS_MASK_Z = 4
AXIS_MASK_WX = 8
AXIS_MASK_WY = 16
AXIS_MASK_WZ = 32
AXIS_MASK_XY = AXIS_MASK_X | AXIS_MASK_Y
AXIS_MASK_WYWZ = AXIS_MASK_WY | AXIS_MASK_WZ
AXIS_MASK_PLANEZ = AXIS_MASK_Z | AXIS_MASK_WX | AXIS_MASK_WY
AXIS_MASK_VEL = AXIS_MASK_X | AXIS_MASK_Y | AXIS_MASK_Z
AXIS_MASK_ROT = AXIS_MASK_WX | AXIS_MASK_WY | AXIS_MASK_WZ
AXIS_MASK_ALL = AXIS_MASK_VEL | AXIS_MASK_ROT


def isAxisMask(mask: int) -> bool:
    """Tell whether `mask` selects at least one of the six axes and nothing else."""
    return AXIS_MASK_NONE < mask <= AXIS_MASK_ALL


# A mean direction shorter than this is the rounding of directions that cancel out.
_SHORTEST_MEAN = 0.001

Clippable = Union[List[float], List[List[float]]]


def modulo2PI(angle: float) -> float:
    """Wrap an angle, in rad, to ]-pi, pi]."""
    # math.remainder is exact and lies in [-pi, pi]; only the lower end has to move.
    wrapped = math.remainder(as_number(angle, "modulo2PI angle"), 2.0 * PI)
    return PI if wrapped == -PI else wrapped


def modulo2PIInPlace(angles: list[float]) -> None:
    """Wrap each angle of a list, in rad, to ]-pi, pi].

    Raises AlmathError if it is a number: Python numbers cannot change, use `modulo2PI`.
    """
    if not isinstance(angles, MutableSequence):
        raise AlmathError(f"modulo2PIInPlace takes a list of angles, got {angles!r}; modulo2PI returns a wrapped angle")
    angles[:] = [modulo2PI(angle) for angle in as_numbers(angles, "modulo2PIInPlace")]


def meanAngle(angles: list[float]) -> float:
    """Direction of the mean of the unit vectors at some angles, in rad in ]-pi, pi].

    Raises AlmathError if there are no angles, or their directions cancel out.
    """
    angles = as_numbers(angles, "meanAngle")
    return weightedMeanAngle(angles, [1.0] * len(angles))


def weightedMeanAngle(angles: list[float], weights: list[float]) -> float:
    """Direction of the weighted mean of the unit vectors at some angles.

    `angles`: in rad. `weights`: one for each angle, all above zero. Returns the mean, in rad in ]-pi, pi]. Raises
    AlmathError if the lengths differ, a weight is not above zero, or the directions cancel out.
    """
    angles = as_numbers(angles, "weightedMeanAngle angles")
    weights = as_numbers(weights, "weightedMeanAngle weights")
    if len(angles) != len(weights):
        raise AlmathError(f"weightedMeanAngle takes a weight for each angle, got {len(weights)} for {len(angles)}")
    if not all(weight > 0.0 for weight in weights):
        raise AlmathError(f"weightedMeanAngle takes weights above zero, got {weights}")
    x = sum(weight * math.cos(angle) for angle, weight in zip(angles, weights))
    y = sum(weight * math.sin(angle) for angle, weight in zip(angles, weights))
    if math.hypot(x, y) < _SHORTEST_MEAN:
        raise AlmathError(f"the angles {angles} with the weights {weights} have no mean direction")
    return modulo2PI(math.atan2(y, x))


def clipData(minimum: float, maximum: float, values: Clippable) -> bool:
    """Clip the numbers of a list, or of a list of lists, in place.

    `minimum`: smallest value allowed. `maximum`: largest value allowed. Returns True if a number had to change. Raises
    AlmathError if `values` is a number: Python numbers cannot change, use `min(max(value, minimum), maximum)`.
    """
    if not isinstance(values, MutableSequence):
        raise AlmathError(f"clipData takes a list to clip in place, got {values!r}")
    if not minimum <= maximum:
        raise AlmathError(f"clipData takes a minimum up to the maximum, got {minimum} and {maximum}")
    clipped = False
    for index, value in enumerate(values):
        if isinstance(value, Real):
            values[index] = min(max(value, minimum), maximum)
            clipped = clipped or values[index] != value
        else:
            clipped = clipData(minimum, maximum, value) or clipped
    return clipped


def pointMassRotationalInertia(mass: float, point: Position3D, out: list[float]) -> None:
    """Rotational inertia of a point mass about the origin.

    Args:
        mass: In kg.
        point: Where it is, in m.
        out: List to overwrite with the nine numbers of the 3x3 matrix, row by row, in kg m^2.
    """
    require(point, Position3D, "pointMassRotationalInertia")
    mass = as_number(mass, "pointMassRotationalInertia mass")
    place = point._values()
    square = point.dotProduct(point)
    out[:] = [
        mass * ((square if row == column else 0.0) - place[row] * place[column])
        for row in range(3)
        for column in range(3)
    ]


class DigitalFilter:
    """A linear filter of the last inputs and outputs. As made it passes its input on."""

    def __init__(self) -> None:
        """Pass the input on."""
        self.configureFilter([1.0], [], 1.0)

    def configureFilter(self, input_weights: list[float], output_weights: list[float], dc_gain: float) -> None:
        """Set the weights and forget what was filtered before.

        Args:
            input_weights: One for each input that counts, the oldest first.
            output_weights: One for each output that counts, the oldest first.
            dc_gain: Each input is divided by it.
        """
        self._input_weights = as_numbers(input_weights, "DigitalFilter input weights")
        self._output_weights = as_numbers(output_weights, "DigitalFilter output weights")
        self._dc_gain = as_number(dc_gain, "DigitalFilter DC gain")
        if self._dc_gain == 0.0:
            raise AlmathError("DigitalFilter takes a DC gain other than zero")
        self.resetFilter()

    def resetFilter(self) -> None:
        """Forget what was filtered before."""
        self._inputs: deque[float] = deque(maxlen=len(self._input_weights))
        self._outputs: deque[float] = deque(maxlen=len(self._output_weights))

    def processFilter(self, sample: float) -> float:
        """Take one input and return one output; until enough are known the input is passed on."""
        sample = as_number(sample, "DigitalFilter sample")
        self._inputs.append(sample / self._dc_gain)
        output = sample
        if len(self._inputs) == self._inputs.maxlen and len(self._outputs) == self._outputs.maxlen:
            output = sum(weight * value for weight, value in zip(self._input_weights, self._inputs))
            output += sum(weight * value for weight, value in zip(self._output_weights, self._outputs))
        self._outputs.append(output)
        return output


class PIDController:
    """A controller with proportional, derivative and integral gain and a dead zone.

    Made from nothing all gains are zero and the period is 1 s.
    """

    def __init__(self, *settings: float) -> None:
        """Take no settings, or the six of `initialize`."""
        self.initialize(*(settings or (0.0, 0.0, 0.0, 0.0, 0.0, 1.0)))

    def initialize(self, *settings: float) -> None:
        """Forget all errors seen and, if given, take new settings.

        Args:
            *settings: Nothing; or the gains of the error, of its derivative and of its integral, the
                threshold below which an error counts as none, an offset that is always added, and the
                period in s.
        """
        if settings:
            if len(settings) != 6:
                raise AlmathError(f"PIDController takes 6 settings, got {len(settings)}: {settings!r}")
            *gains, threshold, offset, period = as_numbers(settings, "PIDController settings")
            if min(threshold, offset) < 0.0 or not period > 0.0:
                raise AlmathError(
                    "PIDController takes a threshold and an offset of zero or more and a period above zero, "
                    f"got {threshold}, {offset} and {period}"
                )
            self.setGains(*gains)
            self._threshold, self._offset, self._period = threshold, offset, period
        self._last_error: float | None = None
        self._integral = 0.0

    def setGains(self, proportional: float, derivative: float, integral: float) -> None:
        """Set the three gains, each zero or more."""
        gains = as_numbers((proportional, derivative, integral), "PIDController gains")
        if min(gains) < 0.0:
            raise AlmathError(f"PIDController takes gains of zero or more, got {gains}")
        self._proportional_gain, self._derivative_gain, self._integral_gain = gains

    def computeFeedback(self, command: float, sensor: float, period: float = -1.0) -> float:
        """Answer a deviation.

        Args:
            command: What is wanted.
            sensor: What is measured.
            period: Time since the call before, in s; the set period if it is not above zero.
        """
        error = as_number(command, "PIDController command") - as_number(sensor, "PIDController sensor")
        size = max(abs(error) - self._threshold, 0.0)
        return self._feedback(size if error > 0.0 else -size, period if period > 0.0 else self._period)

    def computeFeedbackAbsolute(self, error: float) -> float:
        """Answer the size of a deviation; so does the derivative, whichever way it goes."""
        size = max(as_number(error, "PIDController error") - self._threshold, 0.0)
        return self._feedback(size, self._period, absolute=True)

    def _feedback(self, error: float, period: float, absolute: bool = False) -> float:
        slope = 0.0 if self._last_error is None else (error - self._last_error) / period
        self._last_error = error
        self._integral += error * period
        return (
            self._offset
            + self._proportional_gain * error
            + self._derivative_gain * (abs(slope) if absolute else slope)
            + self._integral_gain * self._integral
        )
