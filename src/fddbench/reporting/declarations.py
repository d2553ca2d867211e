"""Changes of what detectors declare in a recorded flight."""

from itertools import groupby

import numpy as np

from fddbench.interfaces import Recording

__all__ = ["declarations"]


def declarations(recording: Recording, position: int = 0) -> list[tuple[str, float, str, bool]]:
    """Every change of what is declared: detector, time [s], sites joined by ``+`` ("" for none any more), alarm."""
    found = []
    for name, sites in recording.declared.items():
        alarm = recording.detectors[name]["alarm"][:, position]
        said = [
            ("+".join(site for site, rows in sites.items() if rows[k, position] > 0.0), bool(alarm[k] > 0.0))
            for k in range(len(alarm))
            if not np.isnan(alarm[k])
        ]
        k = 0
        for what, same in groupby(said):
            if k > 0 or what != ("", False):
                found.append((name, float(recording.time_s[k]), *what))
            k += len(list(same))
    return found
