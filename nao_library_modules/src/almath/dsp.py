"""A digital filter and a PID controller, both advanced one sample at a time."""

from __future__ import annotations

from collections import deque

from almath._components import as_number, as_numbers
from almath.errors import AlmathError


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
