"""Meshes as something that PyBullet shows."""

from __future__ import annotations

import io
from collections.abc import Sequence

import pybullet

from nao_sim_bridge.base.whole_file import memory_file
from nao_sim_bridge.model.meshes import Mesh
from nao_sim_bridge.world.pictures import WorldPicture, paint


def visual_shape(mesh: Mesh, color: Sequence[float], client: int) -> int:
    """A visual shape of PyBullet; its own spheres and cylinders are a few dozen flat triangles.

    Args:
        color: (r, g, b) in 0..1.

    Returns:
        Id of the shape, for `createMultiBody`.
    """
    return pybullet.createVisualShape(
        pybullet.GEOM_MESH,
        vertices=mesh.vertices.tolist(),
        normals=mesh.normals.tolist(),
        uvs=[(0.0, 0.0)] * len(mesh.vertices) if mesh.uvs is None else mesh.uvs.tolist(),
        indices=mesh.faces.ravel().tolist(),
        rgbaColor=(*color, 1.0),
        physicsClientId=client,
    )


def texture(picture: WorldPicture, client: int) -> int:
    """A texture of PyBullet, which takes them from files only.

    Returns:
        Id of the texture, for `changeVisualShape`.
    """
    from PIL import Image  # most worlds have no pictures

    content = io.BytesIO()
    Image.fromarray(paint(picture)).save(content, "PNG")
    with memory_file(content.getvalue()) as path:
        return pybullet.loadTexture(path, physicsClientId=client)
