"""NaoBasic, and what the action servers share."""
