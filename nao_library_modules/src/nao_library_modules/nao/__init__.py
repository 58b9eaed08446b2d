"""Facts of the robot: its joints, lights, sensors, cameras and poses."""
