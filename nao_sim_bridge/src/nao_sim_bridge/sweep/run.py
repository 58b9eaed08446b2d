"""Runs a function over all seeds and parameters, and writes down what came of each as soon as it is there."""

from __future__ import annotations

import csv
import itertools
from io import StringIO
from pathlib import Path
from typing import Any, Callable, Mapping, Sequence, TextIO

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.whole_file import write_whole
from nao_sim_bridge.sweep.job import Job
from nao_sim_bridge.sweep.progress import Progress
from nao_sim_bridge.sweep.ray_workers import run_on_ray
from nao_sim_bridge.sweep.table import ERROR, SECONDS, SEED, Table, Value, read_value


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

    A run that raises is a row with its error. A run whose worker or computer is lost goes to another worker; after 4
    lost workers it is a row with the reason. Computers that join the cluster later are used. A file that exists is
    continued: what it has is not run again, but for runs that failed.

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
        progress: Show a bar in a terminal, a line every 30 s elsewhere. Lost workers and runs that wait for a place are
            reported on stderr in any case.
        memory: MiB that a worker needs.
        parameters: A sequence of values for each, of numbers, truth values or texts.

    Raises:
        BadValue: There are no seeds or values, a parameter has the name of a column, or the file is of another sweep.
        ImportError: There is no Ray.
        NoWorkers: No worker starts.
    """
    numbers = range(seeds) if isinstance(seeds, int) else list(seeds)
    if not len(numbers):
        raise BadValue("seeds", seeds, "1 or more")
    for name, values in parameters.items():
        if name in (SEED, SECONDS, ERROR):
            raise BadValue(name, values, "a parameter of another name: the table has a column of this one")
        if isinstance(values, str) or not len(values):
            raise BadValue(name, values, "a sequence of values")
    names = list(parameters)
    wanted = [
        {SEED: seed, **dict(zip(names, values))}
        for values in itertools.product(*parameters.values())
        for seed in numbers
    ]
    path = None if output is None else Path(output)
    rows = _read(path, names) if path is not None and path.exists() else []
    done = [row for row in rows if not row[ERROR]]  # what was mended since then is to be seen
    finished = {_key(row, names) for row in done}
    left = [run for run in wanted if _key(run, names) not in finished]
    job = Job(function)
    with _Writer(path, names, done) as writer, Progress(len(wanted) - len(left), len(wanted), progress) as shown:
        runs = job.run_all(left) if workers == 0 else run_on_ray(job, left, workers, address, memory, shown)
        for row in runs:
            writer.add(row)
            shown.add(row)
    made = {_key(row, names): row for row in writer.rows}
    return Table(names, [made[_key(run, names)] for run in wanted])


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
