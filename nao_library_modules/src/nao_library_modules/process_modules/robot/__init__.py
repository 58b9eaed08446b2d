"""The robot as process modules reach it: its actions and topics."""
