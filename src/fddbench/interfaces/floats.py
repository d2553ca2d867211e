"""The one kind of number that flies, and the sample that never comes."""

import numpy as np
import numpy.typing as npt

__all__ = ["NEVER", "Floats"]

Floats = npt.NDArray[np.float64]
"""Array of float64."""

NEVER = float(2**53)
"""A sample number that no flight reaches; an exact float64."""
