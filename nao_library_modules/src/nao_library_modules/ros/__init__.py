"""ROS nodes: action servers and clients, the driver's interface, time, frames, diagnostics, bags and whole stacks."""
