"""Plants of the longitudinal benchmark."""
