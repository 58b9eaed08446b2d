"""Who may use the console, and who of them moves the robot. Knows nothing of ROS."""
