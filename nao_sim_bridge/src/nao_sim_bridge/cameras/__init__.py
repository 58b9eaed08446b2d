"""The cameras in the robot's head: when a picture is due, from where, and what the sensor makes of the light."""
