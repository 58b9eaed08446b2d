"""A whole robot and the world it is in, tick by tick; what moves all of it: postures, sequences, diagnosis."""
