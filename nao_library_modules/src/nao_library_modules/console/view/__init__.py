"""What the pages show of a robot, live. Pure where it can be."""
