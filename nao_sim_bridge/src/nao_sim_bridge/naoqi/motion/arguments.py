"""Arguments of ALMotion: names of joints and chains, and key frames in the many shapes that NAOqi takes."""

from __future__ import annotations

from collections import Counter
from typing import Any, Sequence

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.sizes import require_few
from nao_sim_bridge.model.robot_model import RobotModel, joint_names
from nao_sim_bridge.naoqi.binding.arguments import number, numbers
from nao_sim_bridge.naoqi.binding.errors import NaoqiError


def joint_indices(names: Any, model: RobotModel) -> list[int]:
    """Body indices of `joint_names`.

    Raises:
        NaoqiError: A joint is named twice.
    """
    found = joint_names(names, model)
    twice = sorted(name for name, count in Counter(found).items() if count > 1)
    if twice:
        raise NaoqiError(f"named twice: {', '.join(twice)}")
    return [model.joint_index[name] for name in found]


def key_frames(count: int, values: Any, times: Any, field: str) -> list[tuple[list[float], list[float]]]:
    """(times, values) of each of `count` joints from the shapes NAOqi takes.

    One value or one list for one joint; for several joints one value for all, or a list with one value or one list
    each. Times likewise; one number or one list of times serves all joints.

    Raises:
        BadValue: A size does not fit, there are too many, or times do not rise from above 0.
    """
    value_lists = _one_each(values, count, field)
    require_few(field, sum(map(len, value_lists)), "key_frames")
    time_lists = _time_lists(times, count, [len(v) for v in value_lists])
    for joint_values, joint_times in zip(value_lists, time_lists):
        if len(joint_values) != len(joint_times):
            raise BadValue("timeLists", times, f"as many times as values for each joint: {len(joint_values)} here")
        if joint_times[0] <= 0.0 or any(b <= a for a, b in zip(joint_times, joint_times[1:])):
            raise BadValue("timeLists", joint_times, "times that rise, the first above 0 s")
    return list(zip(time_lists, value_lists))


def _one_each(values: Any, count: int, field: str) -> list[list[float]]:
    if not isinstance(values, (list, tuple)):
        return [[number(values, field)]] * count
    if not values:
        raise BadValue(field, values, "at least one value")
    nested = any(isinstance(v, (list, tuple)) for v in values)
    if count == 1 and not nested:
        return [numbers(values, field)]
    if len(values) != count:
        raise BadValue(field, values, f"{count} entries, one for each joint; there are {len(values)}")
    lists = [numbers(v, field) if isinstance(v, (list, tuple)) else [number(v, field)] for v in values]
    if not all(lists):
        raise BadValue(field, values, "at least one value for each joint")
    return lists


def _time_lists(times: Any, count: int, lengths: Sequence[int]) -> list[list[float]]:
    if not isinstance(times, (list, tuple)):
        return [[number(times, "timeLists")]] * count
    if not times:
        raise BadValue("timeLists", times, "at least one time")
    if any(isinstance(t, (list, tuple)) for t in times):
        return _one_each(times, count, "timeLists")
    flat = numbers(times, "timeLists")
    if count > 1 and len(flat) == count and all(length == 1 for length in lengths):
        return [[t] for t in flat]
    return [flat] * count
