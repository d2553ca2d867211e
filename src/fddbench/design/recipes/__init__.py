"""Recipes: what the designs of each kind are made from, one page a kind."""
