"""What roslaunch does, for a program that starts it: it reports what it starts and what ends, a JSON object a line.

    python -m nao_library_modules.ros.launch_program DESCRIPTOR PACKAGE FILE name:=value ...

Reports, on the descriptor: {"master": URI} when the ROS master answers, which is that of ROS_MASTER_URI, or one of its
own where there is none; {"ended": NODE, "status": its exit status} when the process of a node has ended; {"ending":
true} when all nodes are being ended; {"refused": TEXT} when the file cannot be launched. All output, of nodes as well,
goes where that of this process goes.
"""

from __future__ import annotations

import json
import logging
import os
import sys
import threading
from contextlib import redirect_stderr, redirect_stdout, suppress
from typing import TYPE_CHECKING, Any, Sequence, TextIO

if TYPE_CHECKING:
    from roslaunch.pmon import ProcessMonitor


LABEL = "[roslaunch] "
"""Before each line of roslaunch's own: nodes write into the same file."""


class _Labelled:
    """A text file whose lines begin with a label; threads may write at once, a line of each is whole."""

    def __init__(self, file: TextIO) -> None:
        self._file = file
        self._begun = threading.local()

    def write(self, text: str) -> int:
        *lines, self._begun.line = (getattr(self._begun, "line", "") + text).split("\n")
        self._file.write("".join(f"{LABEL}{line}\n" for line in lines))
        self._file.flush()
        return len(text)

    def flush(self) -> None:
        self._file.flush()

    def isatty(self) -> bool:
        return False


class _Reports:
    """Writes reports, as long as the program lives that reads them; roslaunch's listener for processes that end."""

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor

    def write(self, **report: Any) -> None:
        with suppress(BrokenPipeError):
            os.write(self._descriptor, (json.dumps(report) + "\n").encode())

    def process_died(self, name: str, status: int | None) -> None:
        self.write(ended=f"/{name.rpartition('-')[0]}", status=status)


def main(arguments: Sequence[str]) -> int:
    """Launch and wait for the end; the exit status."""
    descriptor, *launch = arguments
    reports = _Reports(int(descriptor))
    master = None
    if not os.environ.get("ROS_MASTER_URI"):
        from .own_stack import serve_master

        master, os.environ["ROS_MASTER_URI"] = serve_master()
    reports.write(master=os.environ["ROS_MASTER_URI"])
    try:
        with redirect_stdout(_Labelled(sys.stdout)), redirect_stderr(_Labelled(sys.stderr)):  # type: ignore[type-var]
            return _launch(launch, reports)
    except KeyboardInterrupt:  # before roslaunch has handlers of its own: there are no nodes yet
        return 1
    finally:
        if master is not None:
            master.stop()


def _launch(launch: Sequence[str], reports: _Reports) -> int:
    import roslaunch
    from roslaunch.core import RLException
    from roslaunch.parent import ROSLaunchParent
    from roslaunch.pmon import start_process_monitor
    from roslaunch.rlutil import get_or_generate_uuid, resolve_launch_arguments

    run = get_or_generate_uuid(None, False)
    roslaunch.configure_logging(run)
    try:
        files = resolve_launch_arguments(list(launch))[:1]
        values = [word for word in launch if ":=" in word]
        parent = ROSLaunchParent(run, [(file, values) for file in files], show_summary=False)
        parent.pm = _reporting(start_process_monitor(), reports)  # what ends during the start is reported as well
        parent.start()
        parent.spin()
    except (RLException, ValueError) as error:
        logging.getLogger("roslaunch").exception("not launched")
        print(f"{type(error).__name__}: {error}", file=sys.stderr)
        reports.write(refused=str(error).partition("\n")[0])
        return 1
    return 0


def _reporting(monitor: ProcessMonitor, reports: _Reports) -> ProcessMonitor:
    end = monitor.shutdown

    def report_and_end() -> None:
        reports.write(ending=True)
        end()

    monitor.add_process_listener(reports)
    monitor.shutdown = report_and_end
    return monitor


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
