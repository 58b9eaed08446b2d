"""Meshes as something that PyBullet shows."""

from __future__ import annotations

from collections.abc import Sequence

import pybullet

from nao_sim_bridge.sim.meshes import Mesh


def visual_shape(mesh: Mesh, color: Sequence[float], client: int) -> int:
    """A visual shape of PyBullet; its own spheres and cylinders are a few dozen flat triangles.

    Args:
        mesh: What it looks like.
        color: (r, g, b) in 0..1.
        client: PyBullet's physics client.

    Returns:
        Id of the shape, for `createMultiBody`.
    """
    return pybullet.createVisualShape(
        pybullet.GEOM_MESH,
        vertices=mesh.vertices.tolist(),
        normals=mesh.normals.tolist(),
        uvs=[(0.0, 0.0)] * len(mesh.vertices),
        indices=mesh.faces.ravel().tolist(),
        rgbaColor=(*color, 1.0),
        physicsClientId=client,
    )
