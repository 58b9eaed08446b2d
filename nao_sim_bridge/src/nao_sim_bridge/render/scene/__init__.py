"""What is drawn, whatever draws it: the pinhole, the robot and the world as bodies that are only there to be seen."""
