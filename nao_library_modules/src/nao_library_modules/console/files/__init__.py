"""Files of the console: YAML read strictly, with lines in errors."""
