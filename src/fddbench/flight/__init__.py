"""Shared physics: atmosphere, aircraft models, actuators, sensors, gusts."""
