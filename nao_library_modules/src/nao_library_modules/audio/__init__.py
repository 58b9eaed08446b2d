"""What speech, sounds and hearing share."""
