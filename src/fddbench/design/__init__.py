"""Offline synthesis of detectors."""
