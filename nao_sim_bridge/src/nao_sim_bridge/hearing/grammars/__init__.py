"""What the recogniser listens for: vocabularies, grammars in BNF, and numbers in words."""
