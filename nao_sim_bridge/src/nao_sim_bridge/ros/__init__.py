"""The simulator's topics and services for ROS. This room and `testing` alone know ROS."""
