"""The simulation core: PyBullet and NumPy only, no ROS and no libqi."""
