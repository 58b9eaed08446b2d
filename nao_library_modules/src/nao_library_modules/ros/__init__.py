"""What actionlib and rospy leave to be done: servers and clients of actions, time, nodes, diagnostics."""
