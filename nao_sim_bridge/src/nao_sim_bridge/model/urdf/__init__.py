"""The model as URDF: the full one for ROS, a lean one for the physics."""
