"""States on their way to another process: what was placed goes over only when it has changed, for it may be much."""

from __future__ import annotations

from dataclasses import replace
from typing import Optional, Tuple

from nao_sim_bridge.world.render_state import RenderState
from nao_sim_bridge.world.world import WorldObject

Placed = Tuple[WorldObject, ...]
Packed = Tuple[RenderState, Optional[Placed]]


class StateSender:
    """The end that sends; one for each process that receives."""

    def __init__(self) -> None:
        self._sent: Placed = ()

    def pack(self, state: RenderState) -> Packed:
        placed = state.placed
        if placed is self._sent:
            return replace(state, placed=()), None
        self._sent = placed
        return replace(state, placed=()), placed


class StateReceiver:
    """The end that receives."""

    def __init__(self) -> None:
        self._placed: Placed = ()

    def unpack(self, packed: Packed) -> RenderState:
        """The state that was sent; what was placed is the same tuple until it changes."""
        state, placed = packed
        if placed is not None:
            self._placed = placed
        return replace(state, placed=self._placed)
