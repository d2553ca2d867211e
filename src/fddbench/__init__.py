"""Open Monte-Carlo benchmark campaigns for aerospace fault detection and diagnosis."""

__version__ = "0.1.0"
