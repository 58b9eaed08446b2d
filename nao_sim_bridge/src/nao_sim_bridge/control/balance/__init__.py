"""Where the feet stand and whether the robot falls: balance, reflexes, pushes, odometry."""
