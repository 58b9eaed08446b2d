"""What the robot recognises in its pictures: detectors on arrays, and the process in which they run."""
