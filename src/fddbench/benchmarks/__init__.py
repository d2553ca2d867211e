"""Aircraft and engines in closed loop, one folder each."""
