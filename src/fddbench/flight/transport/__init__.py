"""A transport aircraft with six degrees of freedom for the whole envelope: data, equations, trim, linearisation."""
