"""Whom the robot knows and is with: ALUserSession and ALUserInfo."""
