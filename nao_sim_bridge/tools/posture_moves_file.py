"""Changes single moves of `config/posture_moves.json` and leaves the others alone."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from nao_sim_bridge.base.config import config_file
from nao_sim_bridge.core.posture_moves import FILE, Move
from nao_sim_bridge.model.robot_model import RobotModel


def put(model: RobotModel, move: Move, runs: int, reached: int, path: Path | None = None) -> None:
    """Put a move into the file, in place of one that begins and ends alike.

    Args:
        model: The robot.
        move: What to write.
        runs: How often it was tried.
        reached: How often it got there.
        path: Of the file, None for the one of the package.
    """
    path = path or Path(config_file(FILE))
    content = json.loads(path.read_text(encoding="utf-8"))
    entry = {
        "from": move.start,
        "to": move.goal,
        "checked": {"runs": runs, "reached": reached},
        "frames": [
            {
                "time": round(frame.duration, 3),
                "angles": {model.joints[i].name: round(angle, 4) for i, angle in sorted(frame.angles.items())},
            }
            for frame in move.frames
        ],
    }
    ends = (move.start, move.goal)
    places = [i for i, other in enumerate(content["moves"]) if (other["from"], other["to"]) == ends]
    if places:
        content["moves"][places[0]] = entry
    else:
        content["moves"].append(entry)
    path.write_text(text_of(content), encoding="utf-8")


def text_of(content: dict[str, Any]) -> str:
    """The file as text: one key frame a line, so that a change shows what moved."""
    moves = []
    for move in content["moves"]:
        head = ", ".join(f"{json.dumps(key)}: {json.dumps(value)}" for key, value in move.items() if key != "frames")
        frames = ",\n".join(f"   {json.dumps(frame)}" for frame in move["frames"])
        moves.append(f'  {{{head}, "frames": [\n{frames}\n  ]}}')
    about = json.dumps(content["_meta"], indent=1).replace("\n", "\n ")
    return f'{{\n "_meta": {about},\n "moves": [\n' + ",\n".join(moves) + "\n ]\n}\n"
