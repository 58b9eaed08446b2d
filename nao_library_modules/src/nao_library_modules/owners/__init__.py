"""What a process starts on the robot and what must not outlive it: noted while it lives, stopped if it dies.

Every process that calls the robot reports to the `OwnerWatch` of another process, by its `OwnerLine`, what it starts.
A line that breaks while something is noted has lost its owner, and the watch stops what was noted.
"""
