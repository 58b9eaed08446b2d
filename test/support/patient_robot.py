"""A simulated robot whose answers are waited for longer than the product does: it may have to start programs."""

from __future__ import annotations

from module_goals import WatchedRobot
from simulator import PATIENCE


class PatientRobot(WatchedRobot):
    def proxy(self, name):
        return _Proxy(super().proxy(name))


class _Wrapped:
    def __init__(self, wrapped):
        self._wrapped = wrapped

    def __getattr__(self, name):
        return getattr(self._wrapped, name)


class _Proxy(_Wrapped):
    def call_async(self, method, *arguments):
        return _Call(self._wrapped.call_async(method, *arguments))


class _Call(_Wrapped):
    def result(self, timeout=None):
        return self._wrapped.result(timeout=timeout and PATIENCE)
