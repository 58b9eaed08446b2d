"""The two URDF texts of the robot, generated from the same tables."""

from __future__ import annotations

from nao_sim_bridge.model.urdf.full import full_urdf, mesh_files
from nao_sim_bridge.model.urdf.physics import physics_urdf

__all__ = ["full_urdf", "mesh_files", "physics_urdf"]
