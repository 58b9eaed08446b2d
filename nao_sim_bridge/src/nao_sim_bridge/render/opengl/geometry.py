"""Triangles of many meshes in one buffer of the graphics card, and what is needed to draw some of them in one call."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Sequence

import numpy as np

from nao_sim_bridge.model.meshes import Mesh

VERTEX = np.dtype([("position", "f4", 3), ("normal", "f4", 3), ("color", "u1", 4), ("uv", "f4", 2)])
VERTEX_FORMAT = "3f 3f 4f1 2f"
VERTEX_NAMES = ("position", "normal", "color", "uv")
POSITION_FORMAT = "3f 24x"
COMMAND = np.dtype([("count", "u4"), ("instances", "u4"), ("first", "u4"), ("base", "i4"), ("row", "u4")])
"""As OpenGL defines it for one of many indirect draws."""


@dataclass(frozen=True)
class Piece:
    """Where a mesh is in the buffers: count and first of its vertex indices, number of its first vertex.

    Centre and radius, m, are those of a sphere around it in its own frame.
    """

    count: int
    first: int
    base: int
    center: np.ndarray
    radius: float


class Geometry:
    """Collects meshes, then gives their buffers."""

    def __init__(self) -> None:
        self._vertices: list[np.ndarray] = []
        self._indices: list[np.ndarray] = []
        self._vertex_count = 0
        self._index_count = 0

    def add(self, mesh: Mesh, colors: np.ndarray | Sequence[float], gloss: float | np.ndarray = 0.0) -> Piece:
        """Take a mesh.

        Args:
            colors: (n, 3) of each vertex, or (3,) of all, in 0..1.
            gloss: How much of the lamp they reflect, 0..1; of all, or of each vertex.
        """
        vertices = np.zeros(len(mesh.vertices), VERTEX)
        vertices["position"], vertices["normal"] = mesh.vertices, mesh.normals
        vertices["color"][:, :3] = np.round(np.clip(colors, 0.0, 1.0) * 255.0)
        vertices["color"][:, 3] = np.round(np.asarray(gloss) * 255.0)
        if mesh.uvs is not None:
            vertices["uv"] = mesh.uvs
        indices = mesh.faces.astype("i4").ravel()
        center = (mesh.vertices.min(axis=0) + mesh.vertices.max(axis=0)) / 2.0
        radius = float(np.linalg.norm(mesh.vertices - center, axis=1).max())
        piece = Piece(len(indices), self._index_count, self._vertex_count, center, radius)
        self._vertices.append(vertices)
        self._indices.append(indices)
        self._vertex_count += len(vertices)
        self._index_count += len(indices)
        return piece

    def buffers(self, context: Any) -> tuple[Any, Any]:
        return (
            context.buffer(np.concatenate(self._vertices).tobytes()),
            context.buffer(np.concatenate(self._indices).tobytes()),
        )
