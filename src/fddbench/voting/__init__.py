"""One signal of several redundant sensors."""
