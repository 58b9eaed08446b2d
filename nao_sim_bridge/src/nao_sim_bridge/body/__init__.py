"""The robot's body in the physics: motors, LEDs, hands, battery, heat, and what it measures."""
