"""The simulator as a library: a NAO in a Python script, without ROS and without a network."""
