"""Thresholds from healthy flights: what is asked, what is promised on other flights, and two ways to find the smallest."""
