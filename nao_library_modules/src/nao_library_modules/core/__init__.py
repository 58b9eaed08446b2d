"""What every action server uses and what needs no rospy: chains, fields, errors, files, the NAO's facts."""
