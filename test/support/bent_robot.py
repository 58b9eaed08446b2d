"""A simulated robot some of whose methods are others, as those of another model would be; all calls are real."""

from __future__ import annotations

from module_goals import WatchedRobot
from simulator import PATIENCE


class BentRobot(WatchedRobot):
    """Calls go elsewhere.

    Attributes:
        bends: (module, method) -> function of the arguments, which tells (module, method, arguments) to call instead;
            (module, None) is for all methods of the module.
        stubborn: Modules whose calls cannot be cancelled.
        patient: Whether answers are waited for longer than the product does: this one may have to start programs.
    """

    bends: dict = {}
    stubborn: tuple = ()
    patient = False

    def proxy(self, name):
        return _Bent(name, super().proxy, self)


class _Bent:
    def __init__(self, name, proxy, robot):
        self._name, self._proxy, self._robot = name, proxy, robot

    def call_async(self, method, *arguments):
        bends = self._robot.bends
        bend = bends.get((self._name, method)) or bends.get((self._name, None))
        module, method, arguments = bend(*arguments) if bend else (self._name, method, arguments)
        call = self._proxy(module).call_async(method, *arguments)
        if self._robot.patient:
            return _Patient(call)
        return _Stubborn(call) if self._name in self._robot.stubborn else call

    def __getattr__(self, name):
        return getattr(self._proxy(self._name), name)


class _Call:
    def __init__(self, call):
        self._call = call

    def __getattr__(self, name):
        return getattr(self._call, name)


class _Stubborn(_Call):
    def cancel(self):
        """Without effect."""


class _Patient(_Call):
    def result(self, timeout=None):
        return self._call.result(timeout=timeout and PATIENCE)
