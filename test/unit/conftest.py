"""What all unit tests share."""

from __future__ import annotations

import signal

# Whoever starts the tests in the background of a shell has them ignore Ctrl-C, and so would the programs that they
# start and interrupt.
signal.signal(signal.SIGINT, signal.default_int_handler)
