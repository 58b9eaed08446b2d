"""The actions. Each message of a function server also has its short name: LedGoal is NaoLedGoal."""

from __future__ import annotations

from . import msg

for _name in [name for name in dir(msg) if name.startswith("Nao")]:
    setattr(msg, _name[len("Nao") :], getattr(msg, _name))
