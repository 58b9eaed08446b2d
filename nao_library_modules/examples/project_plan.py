#!/usr/bin/env python3
"""Runs a plan in a simulator of its own, as fast as that goes, before it runs on the robot; and compares both runs.

    project_plan.py detour_plan.py 1.6 -0.1 --world wall

The plan is the program of an example, or of yours, that takes `--trace FILE`. When it fails in the simulator the robot
does not move. The robot is what answers on this ROS master, for example
`roslaunch nao_library nao.launch nao_ip:=192.168.1.12`, or a simulator at its own speed.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
from pathlib import Path

from nao_library_modules.core.errors import of_those
from nao_library_modules.process_modules.projection import ProjectionFailed, compare, project, run_program
from nao_library_modules.process_modules.trace import Trace

EXAMPLES = Path(__file__).resolve().parent


def succeeded(trace: Trace) -> bool:
    """Whether the plan of a trace succeeded."""
    return trace.records[0].state == "succeeded"


def main() -> int:
    """Project a plan, run it, and compare; the exit status tells whether both runs came out alike."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="program of the plan: a path, or the name of an example")
    parser.add_argument("--world", default="empty", help="world of the simulated robot (empty)")
    parser.add_argument("--only", action="store_true", help="only project it: the robot does not move")
    options, arguments = parser.parse_known_args()
    program = Path(options.program)
    program = program if program.exists() else EXAMPLES / program.name
    if not program.exists():
        plans = [path.name for path in EXAMPLES.glob("*_plan.py")]
        print(f"there is no program {options.program!r}{of_those(program.name, plans)}", file=sys.stderr)
        return 1
    try:
        print(f"{program.name} in the simulator ...", flush=True)
        projected = project(program, arguments, options.world)
        print(projected)
        if options.only or not succeeded(projected):
            return 0 if succeeded(projected) else 1
        print(f"\n{program.name} on the robot ...", flush=True)
        master = os.environ.get("ROS_MASTER_URI", "http://127.0.0.1:11311")
        with tempfile.TemporaryDirectory() as folder:
            done = run_program(program, arguments, master, Path(folder))
        print(done)
    except ProjectionFailed as failure:
        print(failure, file=sys.stderr)
        return 1
    comparison = compare(projected, done)
    print(f"\n{comparison.before:.1f} s in the simulator, {comparison.after:.1f} s on the robot")
    for difference in comparison.differences:
        print(difference)
    print(
        "both runs came out alike" if comparison.alike else f"{len(comparison.differences)} tasks came out differently"
    )
    return 0 if comparison.alike else 1


if __name__ == "__main__":
    sys.exit(main())
