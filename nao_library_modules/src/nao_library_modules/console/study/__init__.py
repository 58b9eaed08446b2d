"""Studies with participants: protocols, trials, their logs and tables. Only `studies` needs ROS."""
