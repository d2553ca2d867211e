"""The one kind of number that flies."""

import numpy as np
import numpy.typing as npt

__all__ = ["Floats"]

Floats = npt.NDArray[np.float64]
"""Array of float64."""
