"""What the robot is, from tables: joints, links, masses, shapes, LEDs, postures, and its kinematics."""
