"""Writing URDF elements: formatting only, nothing about the robot."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from nao_sim_bridge.model.shapes import Shape

ESCAPED = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "'": "&#x27;"})
"""Letters that stand for something else in XML; the module html takes long to load."""
NO_ROTATION = (0.0, 0.0, 0.0)
MESH_URL = "package://nao_sim_bridge/urdf/meshes"


def number(value: float) -> str:
    """Nine significant digits, without a negative zero."""
    text = f"{float(value):.9g}"
    return "0" if text == "-0" else text


def triple(values: Sequence[float]) -> str:
    return " ".join(number(value) for value in values)


def origin(xyz: Sequence[float], rpy: Sequence[float] = NO_ROTATION) -> str:
    return f'<origin xyz="{triple(xyz)}" rpy="{triple(rpy)}"/>'


def inertial(mass: float, com: Sequence[float], inertia: np.ndarray) -> list[str]:
    """Mass (kg), centre of mass (m) and (3, 3) inertia about it (kg m2)."""
    (ixx, ixy, ixz), (_, iyy, iyz), (_, _, izz) = inertia
    entries = zip(("ixx", "ixy", "ixz", "iyy", "iyz", "izz"), (ixx, ixy, ixz, iyy, iyz, izz))
    tensor = " ".join(f'{name}="{number(value)}"' for name, value in entries)
    return [
        "    <inertial>",
        f"      {origin(com)}",
        f'      <mass value="{number(mass)}"/>',
        f"      <inertia {tensor}/>",
        "    </inertial>",
    ]


MASSLESS = inertial(0.0, NO_ROTATION, np.zeros((3, 3)))
"""Of a link that only marks a place."""


def geometry(shape: Shape) -> str:
    """A geometry element.

    Capsules are PyBullet's own and no standard URDF. What URDF has no word for is a mesh: the unit mesh of
    its kind, scaled, or for an arc a mesh of its own.
    """
    if shape.kind in ("ellipsoid", "pillow", "arc"):
        scale = (1.0, 1.0, 1.0) if shape.kind == "arc" else shape.size
        path = f"{MESH_URL}/{mesh_name(shape)}"
        return f'<geometry><mesh filename="{path}" scale="{triple(scale)}"/></geometry>'
    if shape.kind == "box":
        inner = f'<box size="{triple(shape.size)}"/>'
    elif shape.kind == "sphere":
        inner = f'<sphere radius="{number(shape.size[0])}"/>'
    else:
        inner = f'<{shape.kind} radius="{number(shape.size[0])}" length="{number(shape.size[1])}"/>'
    return f"<geometry>{inner}</geometry>"


def mesh_name(shape: Shape) -> str:
    """File of the mesh that a shape refers to."""
    if shape.kind != "arc":
        return f"unit_{shape.kind}.stl"
    inner, outer, thickness, degrees = shape.size
    return f"arc_{inner * 1e4:.0f}_{outer * 1e4:.0f}_{thickness * 1e4:.0f}_{degrees:.0f}.stl"


def collision(shape: Shape) -> str:
    return f"    <collision>{origin(shape.xyz, shape.rpy)}{geometry(shape)}</collision>"


def visual(shape: Shape) -> str:
    """A visual element with the colour its shape names."""
    material = f"<material name={_quoted(shape.material)}/>" if shape.material else ""
    return f"    <visual>{origin(shape.xyz, shape.rpy)}{geometry(shape)}{material}</visual>"


def link(name: str, *parts: Iterable[str]) -> list[str]:
    body = [line for part in parts for line in part]
    if not body:
        return [f"  <link name={_quoted(name)}/>"]
    return [f"  <link name={_quoted(name)}>", *body, "  </link>"]


def fixed_joint(
    name: str, parent: str, child: str, xyz: Sequence[float], rpy: Sequence[float] = NO_ROTATION
) -> list[str]:
    return [
        f'  <joint name={_quoted(name)} type="fixed">',
        f"    <parent link={_quoted(parent)}/><child link={_quoted(child)}/>",
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
        xyz: Origin in the parent link, m.
        axis: Unit vector in the joint frame.
        limits: Lower, upper (rad), effort (N m), velocity (rad/s).
        rpy: Orientation of the joint frame, rad.
        mimic: Joint to follow, multiplier, offset.
    """
    lower, upper, effort, velocity = map(number, limits)
    lines = [
        f'  <joint name={_quoted(name)} type="revolute">',
        f"    <parent link={_quoted(parent)}/><child link={_quoted(child)}/>",
        f"    {origin(xyz, rpy)}",
        f'    <axis xyz="{triple(axis)}"/>',
        f'    <limit lower="{lower}" upper="{upper}" effort="{effort}" velocity="{velocity}"/>',
    ]
    if mimic is not None:
        joint, multiplier, offset = mimic
        factors = f'multiplier="{number(multiplier)}" offset="{number(offset)}"'
        lines.append(f"    <mimic joint={_quoted(joint)} {factors}/>")
    return [*lines, "  </joint>"]


def robot(name: str, comment: str, lines: Iterable[str]) -> str:
    head = [
        '<?xml version="1.0" encoding="utf-8"?>',
        f"<!-- {comment} -->",
        f"<robot name={_quoted(name)}>",
    ]
    return "\n".join([*head, *lines, "</robot>", ""])


def _quoted(text: str) -> str:
    return f'"{text.translate(ESCAPED)}"'
