"""Scores: from verdicts at samples to detection times, rates and exact intervals."""
