"""Joints by what callers name: a joint, a chain, or a list of both."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.base.errors import BadValue, UnknownName
from nao_sim_bridge.model.robot_model import RobotModel


def joint_names(names: Any, model: RobotModel) -> list[str]:
    """Joint names behind a joint, a chain, or a list of both, in order.

    Raises:
        UnknownName: A name is neither a joint nor a chain.
        BadValue: `names` is no string and no list, or empty, or holds something else than strings.
    """
    if isinstance(names, str):
        names = [names]
    if not isinstance(names, (list, tuple)) or not names:
        raise BadValue("names", names, "a joint, a chain, or a list of them")
    found: list[str] = []
    for name in names:
        if not isinstance(name, str):
            raise BadValue("names", name, "the name of a joint or of a chain")
        if name in model.joint_index:
            found.append(name)
        elif name in model.chains and all(n in model.joint_index for n in model.chains[name]):
            found.extend(model.chains[name])
        else:
            raise UnknownName("joint or chain", name, [*model.joint_index, *model.chains])
    return found
