"""Names that ALLeds takes: the robot's own LEDs and groups, and the groups that clients make."""

from __future__ import annotations

from nao_sim_bridge.base.errors import UnknownName
from nao_sim_bridge.model.leds_layout import LedLayout
from nao_sim_bridge.naoqi.binding.errors import NaoqiError


class LedNames:
    """LED and group names."""

    def __init__(self, layout: LedLayout) -> None:
        self._layout = layout
        self._made: dict[str, tuple[str, ...]] = {}

    def devices(self, name: str) -> tuple[int, ...]:
        """Indices of the devices behind a name.

        Raises:
            UnknownName: There is no LED or group of this name.
        """
        if name in self._made:
            return tuple(dict.fromkeys(i for member in self._made[name] for i in self.devices(member)))
        self._check(name)
        return self._layout.devices_of(name)

    def make_group(self, name: str, members: list[str]) -> None:
        """Define a group, or define it anew.

        Raises:
            NaoqiError: The robot itself has the name, or the group is empty or would hold itself.
        """
        if name in self._layout.groups or name in self._layout.short_names or not name:
            raise NaoqiError(f"the name {name!r} is taken by the robot's own LEDs")
        if not members:
            raise NaoqiError(f"group {name!r} has no members")
        for member in members:
            self._check(member)
            if self._leads_to(member, name):
                raise NaoqiError(f"group {name!r} would hold itself")
        self._made[name] = tuple(members)

    def groups(self) -> list[str]:
        """All group names."""
        return sorted([*self._layout.groups, *self._made])

    def members(self, group: str) -> list[str]:
        """What a group was made of."""
        if group in self._made:
            return list(self._made[group])
        if group not in self._layout.groups:
            raise UnknownName("group", group, self.groups())
        return list(self._layout.groups[group])

    def short_names(self) -> list[str]:
        """Names of the single LEDs."""
        return list(self._layout.short_names)

    def device_names(self, name: str) -> list[str]:
        """Device names behind a short name."""
        if name not in self._layout.short_names:
            raise UnknownName("LED", name, self._layout.short_names)
        return [self._layout.devices[i] for i in self._layout.short_names[name]]

    def _leads_to(self, member: str, name: str) -> bool:
        """Whether a member is `name`, or a made group that holds it at any depth."""
        return member == name or any(self._leads_to(inner, name) for inner in self._made.get(member, ()))

    def _check(self, name: str) -> None:
        known = (self._made, self._layout.groups, self._layout.short_names, self._layout.device_index)
        if not any(name in names for names in known):
            raise UnknownName("LED or group", name, [n for names in known for n in names])
