"""What the parts of the driver share."""
