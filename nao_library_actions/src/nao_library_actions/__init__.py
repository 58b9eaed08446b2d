"""The actions. Each message of a function server also has its short name: LedGoal is NaoLedGoal."""

from __future__ import annotations

from typing import Any

from nao_library_msgs import load_when_asked

msg = load_when_asked(__name__, "msg")
_LONG = {name[len("Nao") :]: name for name in dir(msg) if name.startswith("Nao")}


def __getattr__(name: str) -> Any:
    if name not in _LONG:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(msg, _LONG[name])


def __dir__() -> list[str]:
    return ["msg", *_LONG]
