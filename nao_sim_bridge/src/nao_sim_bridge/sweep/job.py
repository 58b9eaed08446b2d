"""What each worker of a sweep does: call the function, and make a row of what it returns."""

from __future__ import annotations

import time
from typing import Any, Callable, Iterable, Iterator, Mapping

from nao_sim_bridge.sweep.table import ERROR, SECONDS, Value


class Job:
    """A function of a sweep."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self._function = function

    def run(self, inputs: Mapping[str, Any]) -> dict[str, Any]:
        """The row of one run, with the error if it raises."""
        began = time.monotonic()
        try:
            result = self._function(**inputs)
            answer = dict(result) if isinstance(result, Mapping) else {"result": result}
            answer = {name: _plain(name, value) for name, value in answer.items()}
            taken = [name for name in answer if name in (*inputs, SECONDS, ERROR)]
            if taken:
                raise ValueError(
                    f"the function returns {', '.join(taken)}, which the row has already: name it otherwise"
                )
            error = ""
        except Exception as failure:
            answer, error = {}, f"{type(failure).__name__}: {failure}"
        return {**inputs, **answer, SECONDS: round(time.monotonic() - began, 3), ERROR: error}

    def run_all(self, runs: Iterable[Mapping[str, Any]]) -> Iterator[dict[str, Any]]:
        """The rows of all runs, made in this process; closes the function afterwards."""
        try:
            for inputs in runs:
                yield self.run(inputs)
        finally:
            self.close()

    def close(self) -> None:
        """Call the function's `close`, if it has one."""
        close = getattr(self._function, "close", None)
        if close is not None:
            close()


def _plain(name: str, value: Any) -> Value:
    """A value that a CSV file keeps; NumPy's become Python's."""
    value = value.item() if hasattr(value, "item") else value
    if not isinstance(value, (bool, int, float, str)):
        raise TypeError(f"{name!r} is a {type(value).__name__}, not a number, truth value or text")
    return value
