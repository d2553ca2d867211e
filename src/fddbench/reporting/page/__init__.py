"""The page of a campaign: one HTML file of aggregates, a section a file."""
