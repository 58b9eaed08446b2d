"""Keys of the robot's memory as topics."""
