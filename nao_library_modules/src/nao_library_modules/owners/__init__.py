"""What a process has set going that must not go on without it: noted while it lives, stopped when it dies.

Every process that calls the robot tells its `OwnerLine` what it sets going. At the other end of the line is the
`OwnerWatch` of another process: a line that breaks while something is noted has lost its owner, and the watch stops
what was noted.
"""
