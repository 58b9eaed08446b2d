"""Writing URDF elements: formatting only, nothing about the robot."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from xml.sax.saxutils import quoteattr

import numpy as np

from nao_sim_bridge.sim.shapes import Shape

NO_ROTATION = (0.0, 0.0, 0.0)


def number(value: float) -> str:
    """Nine significant digits, without a negative zero."""
    text = f"{float(value):.9g}"
    return "0" if text == "-0" else text


def triple(values: Sequence[float]) -> str:
    """Numbers with spaces between."""
    return " ".join(number(value) for value in values)


def origin(xyz: Sequence[float], rpy: Sequence[float] = NO_ROTATION) -> str:
    """An origin element."""
    return f'<origin xyz="{triple(xyz)}" rpy="{triple(rpy)}"/>'


def inertial(mass: float, com: Sequence[float], inertia: np.ndarray) -> list[str]:
    """Mass (kg), centre of mass (m) and (3, 3) inertia about it (kg m2)."""
    entries = zip(("ixx", "ixy", "ixz", "iyy", "iyz", "izz"), inertia[np.triu_indices(3)])
    tensor = " ".join(f'{name}="{number(value)}"' for name, value in entries)
    return [
        "    <inertial>",
        f"      {origin(com)}",
        f'      <mass value="{number(mass)}"/>',
        f"      <inertia {tensor}/>",
        "    </inertial>",
    ]


def geometry(shape: Shape) -> str:
    """A geometry element; capsules are PyBullet's own and no standard URDF."""
    if shape.kind == "box":
        inner = f'<box size="{triple(shape.size)}"/>'
    elif shape.kind == "sphere":
        inner = f'<sphere radius="{number(shape.size[0])}"/>'
    else:
        inner = f'<{shape.kind} radius="{number(shape.size[0])}" length="{number(shape.size[1])}"/>'
    return f"<geometry>{inner}</geometry>"


def collision(shape: Shape) -> list[str]:
    """A collision element."""
    return [f"    <collision>{origin(shape.xyz, shape.rpy)}{geometry(shape)}</collision>"]


def visual(shape: Shape) -> list[str]:
    """A visual element with the colour its shape names."""
    material = f"<material name={quoteattr(shape.material)}/>" if shape.material else ""
    return [f"    <visual>{origin(shape.xyz, shape.rpy)}{geometry(shape)}{material}</visual>"]


def link(name: str, *parts: Iterable[str]) -> list[str]:
    """A link around its inertial, visual and collision elements."""
    body = [line for part in parts for line in part]
    if not body:
        return [f"  <link name={quoteattr(name)}/>"]
    return [f"  <link name={quoteattr(name)}>", *body, "  </link>"]


def fixed_joint(
    name: str, parent: str, child: str, xyz: Sequence[float], rpy: Sequence[float] = NO_ROTATION
) -> list[str]:
    """A joint that does not move."""
    return [
        f'  <joint name={quoteattr(name)} type="fixed">',
        f"    <parent link={quoteattr(parent)}/><child link={quoteattr(child)}/>",
        f"    {origin(xyz, rpy)}",
        "  </joint>",
    ]


def revolute_joint(
    name: str,
    parent: str,
    child: str,
    xyz: Sequence[float],
    axis: Sequence[float],
    limits: tuple[float, float, float, float],
    rpy: Sequence[float] = NO_ROTATION,
    mimic: tuple[str, float, float] | None = None,
) -> list[str]:
    """A turning joint.

    Args:
        name: Name of the joint.
        parent: Parent link.
        child: Child link.
        xyz: Origin in the parent link, m.
        axis: Unit vector in the joint frame.
        limits: Lower, upper (rad), effort (N m), velocity (rad/s).
        rpy: Orientation of the joint frame, rad.
        mimic: Joint to follow, multiplier, offset.
    """
    lower, upper, effort, velocity = map(number, limits)
    lines = [
        f'  <joint name={quoteattr(name)} type="revolute">',
        f"    <parent link={quoteattr(parent)}/><child link={quoteattr(child)}/>",
        f"    {origin(xyz, rpy)}",
        f'    <axis xyz="{triple(axis)}"/>',
        f'    <limit lower="{lower}" upper="{upper}" effort="{effort}" velocity="{velocity}"/>',
    ]
    if mimic is not None:
        joint, multiplier, offset = mimic
        factors = f'multiplier="{number(multiplier)}" offset="{number(offset)}"'
        lines.append(f"    <mimic joint={quoteattr(joint)} {factors}/>")
    return [*lines, "  </joint>"]


def robot(name: str, comment: str, lines: Iterable[str]) -> str:
    """The whole document."""
    head = [
        '<?xml version="1.0" encoding="utf-8"?>',
        f"<!-- {comment} -->",
        f"<robot name={quoteattr(name)}>",
    ]
    return "\n".join([*head, *lines, "</robot>", ""])
