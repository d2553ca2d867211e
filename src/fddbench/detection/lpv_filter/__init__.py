"""Gain-scheduled detection filters, one for each fault: signals in, fault estimates out, and the decision on them."""

from fddbench.detection.lpv_filter.detector import LpvFilter

__all__ = ["LpvFilter"]
