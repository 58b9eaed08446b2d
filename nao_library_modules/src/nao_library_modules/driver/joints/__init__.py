"""Joints, their states and odometry, and what moves them."""
