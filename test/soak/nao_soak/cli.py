"""Command line of the soak."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from nao_library_modules.core.server_types import ACTIONS

from .machines import machines

DEFAULT_FOLDER = Path("soak_output")


def parser() -> argparse.ArgumentParser:
    """The options."""
    options = argparse.ArgumentParser(
        prog="soak",
        description="Random and strange goals to all action servers, on one machine, of a simulated robot on another "
        "one, which is killed now and then, over a network that drops; beside them clients of the robot that are "
        "stopped, killed, or load files for ever. Where network namespaces cannot be made it is one machine, and the "
        "robot stops instead. Exit status 0: no server died, no goal hung, memory stayed flat, and everything worked "
        "afterwards; 1: something did not, and is named.",
        formatter_class=argparse.ArgumentDefaultsHelpFormatter,
    )
    options.add_argument("--minutes", type=float, default=30.0, help="how long goals are sent, simulated minutes")
    options.add_argument("--speed", type=float, default=3.0, help="simulated seconds a second")
    options.add_argument("--kills", type=int, default=10, help="how often the simulator is killed and started again")
    options.add_argument("--drops", type=int, default=2, help="how often the network drops for 5 s")
    options.add_argument(
        "--ill", type=float, default=60.0, help="s after which a client of the robot is killed; 0: none"
    )
    options.add_argument("--strange", type=float, default=0.1, help="share of fields with strange values, 0 to 1")
    options.add_argument("--seed", type=int, default=1, help="equal seeds send equal goals")
    options.add_argument("--servers", nargs="+", default=list(ACTIONS), choices=list(ACTIONS), help="which are tried")
    options.add_argument("--no-memory", action="store_true", help="let memory grow: for soaks of a few minutes")
    options.add_argument("--output", type=Path, default=DEFAULT_FOLDER, help="folder for logs and report")
    return options


def main() -> int:
    """Run it; returns the exit status."""
    arguments = parser().parse_args()
    where = machines()
    from .processes import NotReady
    from .soak import Plan, soak  # only after the help: it imports half of ROS

    folder = arguments.output.resolve()
    plan = Plan(
        seconds=arguments.minutes * 60.0 / arguments.speed,
        speed=arguments.speed,
        kills=arguments.kills,
        drops=arguments.drops,
        strange=arguments.strange,
        seed=arguments.seed,
        servers=tuple(arguments.servers),
        folder=folder,
        ill=arguments.ill,
        flat=not arguments.no_memory,
    )
    try:
        findings = soak(plan, where)
    except NotReady as error:
        print(f"FAULT: {error}", file=sys.stderr)
        return 1
    findings.write(folder / "report.json")
    for server, ends in findings.ends.items():
        counts = ", ".join(f"{count} {end}" for end, count in sorted(ends.items()))
        print(f"{server:14} {counts}; slowest end of a cancelled goal {findings.slowest_end_s[server]:.1f} s")
    for name, (before, after) in findings.levels.items():
        print(f"{name:48} {before:9.1f} -> {after:9.1f}")
    print(f"{findings.ill_killed} clients of the robot killed")
    for fault in findings.faults:
        print(f"FAULT: {fault}")
    print(f"{len(findings.faults)} faults; report and logs in {folder}")
    return 1 if findings.faults else 0
