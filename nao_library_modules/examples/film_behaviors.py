#!/usr/bin/env python3
"""Films the behaviours that are bundled with the library, played one after another on a simulated NAO.

Starts a simulator and its action servers on a ROS master of its own. Leaves a film with sound, a sheet with six
pictures of each behaviour, a table and the log of the stack in the output folder, which has to be empty unless
--overwrite says that they may be replaced. The exit status tells whether every behaviour went as asked.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import List, Sequence

# In the devel space rosrun starts a relay from another folder.
sys.path.insert(0, str(Path(__file__).resolve().parent))
from example_parts.contact_sheet import Part, contact_sheet, save_small
from example_parts.demo_behaviors import TURNS, BehaviorPlayer, Turn
from example_parts.demo_support import Film, Stack, Table, announce, may_fill

FILM, SHEET = "behaviors.mp4", "behaviors.png"


def film_behaviors(output: Path, table: Table, turns: Sequence[Turn] = TURNS) -> List[Part]:
    """Play and film behaviours; returns where in the film each of them is."""
    import rospy

    with Stack(output, driver="false", cameras="false") as stack:
        stack.join("nao_library_film")
        player, film = BehaviorPlayer(stack, table), Film(stack, FILM)
        player.run(Turn("nod", ("times=1",)))  # after it the server has found the servers that it needs
        film.start()
        began, parts = rospy.get_time(), []
        for turn in turns:
            film.caption(turn.title)
            announce(f"playing the behaviour {turn.title}", turn.length)
            begin = rospy.get_time() - began
            player.play(turn)
            parts.append(Part(turn.title, begin, rospy.get_time() - began))
        film.stop(table)
    return parts


def main() -> int:
    """Play and film all behaviours; the exit status is 0 when every one went as asked."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--output", type=Path, default=Path("demo_output"), help="folder for the film and the table")
    options.add_argument("--overwrite", action="store_true", help="replace what an earlier film left there")
    chosen = options.parse_args()
    output = chosen.output.resolve()
    if not may_fill(output, chosen.overwrite):
        return 1
    table = Table()
    try:
        parts = film_behaviors(output, table)
    except Exception as error:
        print(f"  FAIL  {error}\n        see {output / 'stack.log'}", flush=True)
        return 1
    save_small(contact_sheet(output / FILM, parts), output / SHEET)
    table.write(output / "behaviors.md")
    print(f"{table.summary}; {FILM}, {SHEET} (six pictures of each) and behaviors.md are in {output}")
    return 1 if table.failures else 0


if __name__ == "__main__":
    sys.exit(main())
