"""The tables of features in docs/features.md: what each row says, and what its command needs for itself."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

PAGE = Path(__file__).resolve().parents[2] / "docs" / "features.md"
BEGIN, END = "<!-- features -->", "<!-- end of features -->"
STAR = "★"
"""Behind a command that starts a stack of its own, opens a window or waits for keys: it is not run with the others."""
ROW = re.compile(r"\| (?P<feature>[^|]+) \| `(?P<command>(?:[^`|]|\\\|)+)`(?P<star> ★)? \|")
HEADS = ("| feature | command |", "| --- | --- |")
ALL = frozenset({"lights", "sound", "body", "eyes", "touch"})
"""What commands can be in each other's way about; a command that nothing is known of has all for itself."""
USES = (
    (r"nao (run|stop)|nao record behavior|nao sim (reset|pause|resume|advance|push)", ALL),
    (r"nao_sim/(place_object|set_battery)|nao_alife|setTemperature|onTouch", ALL),
    (r"(dialogue|turn_to_sound|get_up|\w+_plan|add_a_rule)\.py", ALL),
    (r"nao leds|call lights|fade_rgb|/blink/", {"lights"}),
    (r"nao say|call nao_audio|/speech|record sound|person_says", {"sound"}),
    (r"nao (pose|walk|wake|rest)|call motion|record motion", {"body"}),
    (r"/joint_|body_stiffness|/wakeup|/rest|cmd_vel|--animated|runBehavior", {"body"}),
    (r"(walk_\w+|footsteps|take_pose|teach_by_hand|joint_trajectory_client)\.py", {"body"}),
    (r"call vision|nao photo|record video", {"eyes"}),
    (r"sim touch|call tactile|nao_sim/touch", {"touch"}),
    # These ask, or do what disturbs nobody.
    (r"nao (status|list|help|behaviors|get|set|watch|files|completion|sim picture|sim film)", set()),
    (r"rostopic (echo|list)|rosservice list|nao_memory|get_installed_behaviors|/describe", set()),
    (r"robot_state\.py|getAngles|systemVersion|import almath", set()),
)
"""Pattern in a command -> what it needs for itself."""


class FeatureTableError(Exception):
    """A line between the marks is no row of a table."""


@dataclass(frozen=True)
class Feature:
    """One row.

    Attributes:
        name: What there is.
        command: What is typed to see it.
        starred: Whether the command stands for itself.
    """

    name: str
    command: str
    starred: bool

    @property
    def uses(self) -> frozenset[str]:
        """What no other command may use meanwhile."""
        found = [uses for pattern, uses in USES if re.search(pattern, self.command)]
        return frozenset().union(*found) if found else ALL


def features(text: str) -> list[Feature]:
    """The rows of all tables between the marks.

    Raises:
        FeatureTableError: Without marks, or if a line of a table cannot be read.
    """
    before, begin, rest = text.partition(BEGIN)
    between, end, after = rest.partition(END)
    if not begin or not end or BEGIN in after or END in before + after:
        raise FeatureTableError(f"there has to be one {BEGIN!r}, and one {END!r} behind it")
    found = []
    for line in between.splitlines():
        if not line.startswith("|") or line in HEADS:
            continue
        row = ROW.fullmatch(line)
        if row is None:
            raise FeatureTableError(f"not a row '| feature | `command` |', with {STAR} or without: {line}")
        found.append(Feature(row["feature"], row["command"].replace(r"\|", "|"), bool(row["star"])))
    return found
