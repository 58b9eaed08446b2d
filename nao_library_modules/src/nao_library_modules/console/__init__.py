"""A page in the browser for the person who runs the robot."""
