"""Walking: footsteps, pattern of the centre of mass, kinematics of the legs. Pure functions of numbers, no physics."""
