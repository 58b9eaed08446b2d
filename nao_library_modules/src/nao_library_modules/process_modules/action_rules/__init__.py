"""Rules for a NAO: what actions and motions are in numbers. Users add their own with `rule`.

Three ways of describing the same are understood: CRAM's motions, `{type: opening, gripper: left}`; the actions of older
plans, `{type: trajectory, to: open, side: left}`; and a name, `{name: to open, side: left}`.
"""

from __future__ import annotations

