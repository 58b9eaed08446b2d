"""What is made to be given to something: made and dropped, it has no effect, and says so."""

from __future__ import annotations

import sys
import warnings


class MadeToBeUsed:
    """Warns when it is dropped unused, as Python does of a coroutine that was never awaited."""

    _used = False

    def use(self) -> None:
        """Note that something has been done with it."""
        object.__setattr__(self, "_used", True)  # of frozen ones as well

    def unused(self) -> str:
        """What to say of it; empty for one that may be dropped."""
        return ""

    def __del__(self) -> None:
        if not self._used and not sys.is_finalizing():
            text = self.unused()
            if text:
                warnings.warn(text, RuntimeWarning, stacklevel=2)


def use_all(values: object) -> None:
    """Note that what is among values, or in lists of them, has been given to something."""
    for value in values if isinstance(values, (list, tuple)) else (values,):
        if isinstance(value, MadeToBeUsed):
            value.use()
        elif isinstance(value, (list, tuple)):
            use_all(value)
