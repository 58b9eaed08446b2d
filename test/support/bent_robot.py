"""A simulated robot some of whose methods are others, as those of another model would be; all calls are real."""

from __future__ import annotations

from module_goals import WatchedRobot


class BentRobot(WatchedRobot):
    """Calls go elsewhere.

    Attributes:
        bends: (module, method) -> function of the arguments, which tells (module, method, arguments) to call instead;
            (module, None) is for all methods of the module.
        stubborn: Modules whose calls cannot be cancelled.
    """

    bends: dict = {}
    stubborn: tuple = ()

    def proxy(self, name):
        return _Bent(name, super().proxy, self.bends, name in self.stubborn)


class _Bent:
    def __init__(self, name, proxy, bends, stubborn):
        self._name, self._proxy, self._bends, self._stubborn = name, proxy, bends, stubborn

    def call_async(self, method, *arguments):
        bend = self._bends.get((self._name, method)) or self._bends.get((self._name, None))
        module, method, arguments = bend(*arguments) if bend else (self._name, method, arguments)
        call = self._proxy(module).call_async(method, *arguments)
        return _Stubborn(call) if self._stubborn else call

    def __getattr__(self, name):
        return getattr(self._proxy(self._name), name)


class _Stubborn:
    def __init__(self, call):
        self._call = call

    def cancel(self):
        """Without effect."""

    def __getattr__(self, name):
        return getattr(self._call, name)
