"""The robots of a ROS master as the console sees them: what they do, what is sent to them, what happens."""
