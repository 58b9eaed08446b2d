"""Studies with participants: protocols, trials, their logs and tables. The command line and the console use them."""
