"""Languages that a plan can be written in."""
