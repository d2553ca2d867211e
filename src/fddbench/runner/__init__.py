"""Flies campaigns: chunks of cases on a pool of workers."""
