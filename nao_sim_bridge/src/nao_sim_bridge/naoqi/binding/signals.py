"""The libqi signals of a module whose parts are made later, or anew."""

from __future__ import annotations

from typing import Any, Mapping

import qi


class _Outlet:
    """A signal, and whether somebody is connected to it: libqi keeps what one was raised with for ever."""

    def __init__(self, signature: str) -> None:
        self.heard = False
        self.signal = qi.Signal(signature, self._connected)

    def _connected(self, heard: bool) -> None:
        self.heard = heard


class Signals:
    """Signals by name, made when the service is published; called with a name and its values they are raised.

    Args:
        signatures: Name -> libqi's letters for the values, such as "(ss)".
    """

    def __init__(self, signatures: Mapping[str, str]) -> None:
        self._signatures = signatures
        self._outlets: dict[str, _Outlet] = {}

    @property
    def published(self) -> dict[str, Any]:
        """What to publish, by name."""
        self._outlets = self._outlets or {name: _Outlet(letters) for name, letters in self._signatures.items()}
        return {name: outlet.signal for name, outlet in self._outlets.items()}

    def take_over(self, former: Signals) -> None:
        """Go on with the signals that clients are connected to; the former ones reach nobody any more."""
        self._outlets, former._outlets = former._outlets, {}

    def __call__(self, name: str, *values: Any) -> None:
        outlet = self._outlets.get(name)
        if outlet is not None and outlet.heard:
            outlet.signal(*values)
