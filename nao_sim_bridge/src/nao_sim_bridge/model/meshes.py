"""Triangles for the shapes of pictures, with normals, in the frame of the shape."""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass

import numpy as np

from nao_sim_bridge.model.kinematics import rpy_matrix
from nao_sim_bridge.model.shapes import Shape

AROUND = 28
"""Steps of longitude of round shapes; of latitude they have half as many."""
PILLOW_EXPONENT = 0.35
"""1 would make the pillow an ellipsoid, 0 a box."""


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles.

    Attributes:
        vertices: (n, 3), m.
        normals: (n, 3) unit vectors, outwards.
        faces: (m, 3) vertex indices, counter-clockwise seen from outside.
        uvs: (n, 2) place of each vertex in a picture, (0, 0) lower left and (1, 1) upper right; None without.
    """

    vertices: np.ndarray
    normals: np.ndarray
    faces: np.ndarray
    uvs: np.ndarray | None = None

    def placed(self, shape: Shape) -> Mesh:
        """The same triangles moved to where the shape is in its link."""
        rotation = rpy_matrix(shape.rpy)
        return Mesh(self.vertices @ rotation.T + shape.xyz, self.normals @ rotation.T, self.faces, self.uvs)


def merged(meshes: list[Mesh]) -> Mesh:
    """One mesh of several, without places in a picture."""
    starts = np.cumsum([0] + [len(mesh.vertices) for mesh in meshes[:-1]])
    return Mesh(
        np.vstack([mesh.vertices for mesh in meshes]),
        np.vstack([mesh.normals for mesh in meshes]),
        np.vstack([mesh.faces + start for mesh, start in zip(meshes, starts)]),
    )


def tessellate(shape: Shape, around: int = AROUND) -> Mesh:
    """Triangles of a shape in its own frame, in `around` steps if it is round."""
    size = shape.size
    if shape.kind == "sphere":
        return superellipsoid((size[0],) * 3, 1.0, around)
    if shape.kind == "ellipsoid":
        return superellipsoid(size, 1.0, around)
    if shape.kind == "pillow":
        return superellipsoid(tuple(edge / 2.0 for edge in size), PILLOW_EXPONENT, around)
    if shape.kind == "box":
        return box(size)
    if shape.kind == "capsule":
        return capsule(*size, around)
    if shape.kind == "cylinder":
        return ring_sector(0.0, size[0], size[1], 360.0, around)
    return ring_sector(*size, around)


def front_and_rest(mesh: Mesh) -> tuple[Mesh, Mesh]:
    """What a picture covers of a shape, with its places in the picture, and the other triangles.

    Args:
        mesh: Of the shape in its own frame. The front is what looks along +X: of a box one face, of round shapes half.
            The picture is projected onto it along -X, upright with Z up; its edges are those of the front.
    """
    corners = mesh.vertices[mesh.faces]
    forward = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 0]
    # All of a side wall is edge-on but for rounding.
    in_front = forward > 1e-9
    used = np.unique(mesh.faces[in_front])
    number = np.zeros(len(mesh.vertices), dtype=int)
    number[used] = np.arange(len(used))
    seen = mesh.vertices[used][:, 1:]
    low, high = seen.min(axis=0), seen.max(axis=0)
    # Who looks along -X has Y on the right.
    uvs = (seen - low) / (high - low)
    front = Mesh(mesh.vertices[used], mesh.normals[used], number[mesh.faces[in_front]], uvs)
    return front, Mesh(mesh.vertices, mesh.normals, mesh.faces[~in_front])


def superellipsoid(half_axes: tuple[float, ...], exponent: float, around: int = AROUND) -> Mesh:
    """An ellipsoid (exponent 1) or, the smaller the exponent, the more of a box."""
    latitude = np.linspace(-math.pi / 2, math.pi / 2, around // 2 + 1)
    axes = np.array(half_axes)
    normals = _surface(latitude, around, 2.0 - exponent) / axes
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return Mesh(_surface(latitude, around, exponent) * axes, normals, _grid_faces(around // 2, around))


def capsule(radius: float, length: float, around: int = AROUND) -> Mesh:
    """A cylinder along Z with half spheres at its ends; `length` is that of the straight part."""
    quarter = np.linspace(0.0, math.pi / 2, around // 4 + 1)
    # The equator is there twice, pulled apart by the straight part.
    normals = _surface(np.concatenate([-quarter[::-1], quarter]), around, 1.0)
    half = np.repeat([-0.5, 0.5], (around // 4 + 1) * (around + 1)) * length
    vertices = radius * normals + np.outer(half, (0.0, 0.0, 1.0))
    return Mesh(vertices, normals, _grid_faces(2 * (around // 4) + 1, around))


def box(edges: tuple[float, ...]) -> Mesh:
    sides = []
    square = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    for axis in range(3):
        for sign in (1.0, -1.0):
            corners = np.empty((4, 3))
            corners[:, axis] = sign
            corners[:, [(axis + 1) % 3, (axis + 2) % 3]] = square[:: int(sign)]
            normals = np.zeros((4, 3))
            normals[:, axis] = sign
            sides.append(Mesh(corners * np.array(edges) / 2.0, normals, np.array([[0, 1, 2], [0, 2, 3]])))
    return merged(sides)


def ring_sector(inner: float, outer: float, thickness: float, degrees: float, around: int = AROUND) -> Mesh:
    """A flat ring about Z, or a piece of it centred on X.

    Args:
        inner: Inner radius, m; 0 for a disc or cylinder.
        outer: Outer radius, m.
        thickness: Along Z, m.
        degrees: How much of the ring, 360 for all of it.
        around: Corners of a whole ring.
    """
    steps = max(2, round(around * degrees / 360.0))
    angles = np.radians(np.linspace(-degrees / 2.0, degrees / 2.0, steps + 1))
    radial = np.stack([np.cos(angles), np.sin(angles), np.zeros_like(angles)], axis=1)
    up = np.array([0.0, 0.0, thickness / 2.0])
    z = np.array([0.0, 0.0, 1.0])
    strips = [
        _strip(radial * inner + up, radial * outer + up, z),
        _strip(radial * outer - up, radial * inner - up, -z),
        _strip(radial * outer + up, radial * outer - up, radial),
    ]
    if inner > 0.0:
        strips.append(_strip(radial * inner - up, radial * inner + up, -radial))
    if degrees < 360.0:
        for index, sign in ((0, 1.0), (-1, -1.0)):
            edge = np.array([radial[index] * inner, radial[index] * outer])[:: -int(sign)]
            strips.append(_strip(edge - up, edge + up, np.cross(radial[index], z) * sign))
    return merged(strips)


def _strip(first: np.ndarray, second: np.ndarray, normals: np.ndarray) -> Mesh:
    """Quads between two lines of points."""
    count = len(first)
    normals = np.broadcast_to(normals, (count, 3))
    a = np.arange(count - 1)
    faces = np.concatenate(
        [np.stack([a, a + count, a + 1], axis=1), np.stack([a + 1, a + count, a + count + 1], axis=1)]
    )
    return Mesh(np.vstack([first, second]), np.vstack([normals, normals]), faces)


def _grid_faces(rows: int, columns: int) -> np.ndarray:
    """Two triangles for each cell of a grid of (rows + 1) x (columns + 1) vertices."""
    row, column = np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij")
    corner = (row * (columns + 1) + column).ravel()
    above = corner + columns + 1
    return np.vstack(
        [
            np.stack([corner, corner + 1, above + 1], axis=1),
            np.stack([corner, above + 1, above], axis=1),
        ]
    )


def _surface(latitude: np.ndarray, around: int, exponent: float) -> np.ndarray:
    """(n, 3) points of a unit superellipsoid, row by row of (rows,) latitudes, in `around` steps of longitude."""
    longitude = np.linspace(-math.pi, math.pi, around + 1)
    cl, sl, co, so = (
        np.sign(values) * np.abs(values) ** exponent
        for values in (np.cos(latitude), np.sin(latitude), np.cos(longitude), np.sin(longitude))
    )
    return np.stack([np.outer(cl, co), np.outer(cl, so), np.outer(sl, np.ones_like(co))], axis=-1).reshape(-1, 3)


def stl_bytes(mesh: Mesh) -> bytes:
    """Binary STL of a mesh, the only mesh format for which RViz keeps the colours of the URDF."""
    corners = mesh.vertices[mesh.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.linalg.norm(normals, axis=1)
    solid = area > 1e-15
    normals[solid] /= area[solid, None]
    records = np.zeros(int(solid.sum()), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("pad", "<u2")])
    records["normal"], records["corners"] = normals[solid], corners[solid]
    return b"\0" * 80 + struct.pack("<I", len(records)) + records.tobytes()
