"""Runs a function over all seeds and parameters, and writes down what came of each as soon as it is there."""

from __future__ import annotations

import csv
import itertools
import time
from contextlib import contextmanager
from io import StringIO
from pathlib import Path
from typing import Any, Callable, Iterable, Iterator, Mapping, Sequence, TextIO

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.whole_file import write_whole
from nao_sim_bridge.sweep.table import ERROR, SECONDS, SEED, Table, Value, read_value

RETRIES = 3
"""How often a run is begun again whose worker has died."""
CLOSE_LIMIT = 60.0
"""s that workers may take to close what they have."""
MIB = 2**20


def sweep(
    function: Callable[..., Any],
    seeds: int | Sequence[int],
    output: str | Path | None = None,
    workers: int | None = None,
    address: str | None = None,
    progress: bool = True,
    memory: float = 0.0,
    **parameters: Sequence[Value],
) -> Table:
    """Call `function(seed=..., **parameters)` for all seeds and all combinations of parameters.

    A run that raises is a row with its error; one whose worker dies is begun again. A file that is there already is
    gone on with: what it has is not run again.

    Args:
        function: Returns a number, a truth value, or a mapping of names to such and to short texts. Each worker has a
            copy, which may keep between runs what takes long to make; its method `close`, if it has one, is called when
            there are no more runs.
        seeds: So many, from 0 on; or which ones.
        output: CSV file with a row for each run, written as they end; None to keep them only in memory.
        workers: Processes; None: as many as there are processors, and memory. 0: all runs in this process, one after
            the other, without Ray.
        address: Of a Ray cluster ("ray://head:10001", "auto"), which then does the work. Where `ray.init` was called
            before, that Ray does it.
        progress: Show how far it is.
        memory: MiB that a worker needs.
        parameters: A sequence of values for each, of numbers, truth values or texts.

    Raises:
        BadValue: There are no seeds or values, or the file is of another sweep.
        ImportError: There is no Ray.
    """
    numbers = range(seeds) if isinstance(seeds, int) else list(seeds)
    if not len(numbers):
        raise BadValue("seeds", seeds, "1 or more")
    for name, values in parameters.items():
        if isinstance(values, str) or not len(values):
            raise BadValue(name, values, "a sequence of values")
    names = list(parameters)
    wanted = [
        {SEED: seed, **dict(zip(names, values))}
        for values in itertools.product(*parameters.values())
        for seed in numbers
    ]
    path = None if output is None else Path(output)
    done = _read(path, names) if path is not None and path.exists() else []
    finished = {_key(row, names) for row in done}
    left = [run for run in wanted if _key(run, names) not in finished]
    runs = _one_by_one(function, left) if workers == 0 else _by_ray(function, left, workers, address, memory)
    with _Writer(path, names, done) as writer:
        for row in _shown(runs, len(wanted) - len(left), len(wanted), progress):
            writer.add(row)
    rows = {_key(row, names): row for row in writer.rows}
    return Table(names, [rows[_key(run, names)] for run in wanted])


def _call(function: Callable[..., Any], run: Mapping[str, Any]) -> dict[str, Any]:
    """The row of one run."""
    began = time.monotonic()
    try:
        result = function(**run)
        answer = dict(result) if isinstance(result, Mapping) else {"result": result}
        answer = {name: _plain(name, value) for name, value in answer.items()}
        error = ""
    except Exception as failure:
        answer, error = {}, f"{type(failure).__name__}: {failure}"
    return {**run, **answer, SECONDS: round(time.monotonic() - began, 3), ERROR: error}


def _plain(name: str, value: Any) -> Value:
    """A value that a CSV file keeps; NumPy's become Python's."""
    value = value.item() if hasattr(value, "item") else value
    if not isinstance(value, (bool, int, float, str)):
        raise TypeError(f"{name} is a {type(value).__name__}, not a number, truth value or text")
    return value


def _one_by_one(function: Callable[..., Any], runs: Iterable[Mapping[str, Any]]) -> Iterator[dict[str, Any]]:
    try:
        for run in runs:
            yield _call(function, run)
    finally:
        _close(function)


def _close(function: Callable[..., Any]) -> None:
    close = getattr(function, "close", None)
    if close is not None:
        close()


def _by_ray(
    function: Callable[..., Any],
    runs: Sequence[Mapping[str, Any]],
    workers: int | None,
    address: str | None,
    memory: float,
) -> Iterator[dict[str, Any]]:
    """As they end, in any order."""
    if not runs:
        return
    import ray  # only who sweeps in parallel needs it

    with _connected(ray, workers, address):

        @ray.remote(num_cpus=1, max_restarts=-1, max_task_retries=RETRIES)
        class Worker:
            """A process with a copy of the function; one run at a time, so that a death takes no other run with it."""

            def ready(self) -> None:
                """Do nothing: who answers is there."""

            def call(self, run: Mapping[str, Any]) -> dict[str, Any]:
                return _call(function, run)

            def close(self) -> None:
                _close(function)

        count = min(workers or len(runs), _places(ray.nodes(), 0.0 if workers else memory), len(runs))
        busy: dict[Any, tuple[Any, Mapping[str, Any] | None]] = {}
        for worker in [Worker.remote() for _ in range(count)]:
            busy[worker.ready.remote()] = worker, None
        left, there, open_runs = iter(runs), [], len(runs)
        while open_runs:
            (ended,), _ = ray.wait(list(busy), num_returns=1)
            worker, run = busy.pop(ended)
            following = next(left, None)
            if following is not None:
                busy[worker.call.remote(following)] = worker, following
            if run is None:
                there.append(worker)
                continue
            open_runs -= 1
            try:
                yield ray.get(ended)
            except ray.exceptions.RayError as error:
                yield {**run, SECONDS: 0.0, ERROR: str(error).strip().splitlines()[-1]}
        ray.wait([worker.close.remote() for worker in there], num_returns=len(there), timeout=CLOSE_LIMIT)


@contextmanager
def _connected(ray: Any, workers: int | None, address: str | None) -> Iterator[None]:
    """A Ray on this computer, that of an address, or that which is there; who has begun it ends it."""
    if ray.is_initialized():
        yield
        return
    if address is not None:
        ray.init(address=address, log_to_driver=False, configure_logging=False)
    else:
        # Programs of a worker that dies end by themselves, with theirs; killed by Ray, they would leave these behind.
        system = {"kill_child_processes_on_worker_exit": False}
        options = {"log_to_driver": False, "configure_logging": False, "_system_config": system}
        ray.init(num_cpus=workers, include_dashboard=False, **options)
    try:
        yield
    finally:
        ray.shutdown()


def _places(nodes: Iterable[Mapping[str, Any]], memory: float) -> int:
    """How many workers have a processor and their memory on the computers of a Ray cluster; 1 at least."""
    count = 0
    for node in nodes:
        there = node["Resources"] if node["Alive"] else {}
        fit = there.get("memory", 0.0) // (memory * MIB) if memory else float("inf")
        count += int(min(there.get("CPU", 0.0), fit))
    return max(1, count)


def _shown(rows: Iterable[dict[str, Any]], done: int, count: int, progress: bool) -> Iterator[dict[str, Any]]:
    if not progress:
        yield from rows
        return
    from tqdm import tqdm

    yield from tqdm(rows, initial=done, total=count, unit="run")


class _Writer:
    """Keeps rows, and appends them to a file when there is one; columns that come up later are in the last write."""

    def __init__(self, path: Path | None, names: Sequence[str], rows: Sequence[dict[str, Any]]) -> None:
        self.rows = list(rows)
        self._path = path
        self._names = names
        self._columns: list[str] = []
        self._file: TextIO | None = None

    def __enter__(self) -> _Writer:
        if self._path is not None and self.rows:
            self._begin(self._all_columns())
        return self

    def __exit__(self, *_: object) -> None:
        if self._file is not None:
            self._file.close()

    def add(self, row: dict[str, Any]) -> None:
        self.rows.append(row)
        if self._path is None:
            return
        if self._file is None or not set(row) <= set(self._columns):
            self._begin(self._all_columns())
            return
        csv.DictWriter(self._file, self._columns).writerow(row)
        self._file.flush()

    def _all_columns(self) -> list[str]:
        inputs = [SEED, *self._names]
        found = dict.fromkeys(name for row in self.rows for name in row)
        return [*inputs, *(name for name in found if name not in (*inputs, SECONDS, ERROR)), SECONDS, ERROR]

    def _begin(self, columns: list[str]) -> None:
        """Write everything anew; until that is whole, the old file stays."""
        if self._file is not None:
            self._file.close()
        self._columns = columns
        text = StringIO(newline="")
        writer = csv.DictWriter(text, columns)
        writer.writeheader()
        writer.writerows(self.rows)
        write_whole(self._path, text.getvalue().encode())
        self._file = self._path.open("a", newline="", encoding="utf-8")


def _read(path: Path, names: Sequence[str]) -> list[dict[str, Any]]:
    """What a file has; a last line that was cut off is left out, and run again."""
    with path.open(newline="", encoding="utf-8") as file:
        reader = csv.DictReader(file)
        columns = list(reader.fieldnames or ())
        if columns[: len(names) + 1] != [SEED, *names] or columns[-2:] != [SECONDS, ERROR]:
            raise BadValue("output", str(path), f"a file of a sweep over {', '.join([SEED, *names])}, or none yet")
        rows = [row for row in reader if None not in row.values() and row[ERROR] is not None]
    return [{name: read_value(text) if name != ERROR else text for name, text in row.items()} for row in rows]


def _key(run: Mapping[str, Any], names: Sequence[str]) -> tuple[str, ...]:
    return tuple(str(run[name]) for name in (SEED, *names))
