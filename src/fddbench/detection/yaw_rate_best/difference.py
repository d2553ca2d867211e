"""Whether the sensors differ by more than healthy ones do."""

import numpy as np

from fddbench.blocks.layout import ROW, Layout, Row, Rows, record
from fddbench.blocks.linear import largest
from fddbench.detection.yaw_rate_best.gains import YawRateBestGains

__all__ = ["Difference", "DifferenceState", "smallest"]

_OUT = 1e6
"""Takes a declared sensor out of the comparison [deg/s]."""


@record
class DifferenceState:
    """Learned offset of every sensor and its smoothed distance beyond it [deg/s], (3, n_cases); samples since they differed."""

    offset: Rows
    apart: Rows
    agreed_samples: Row


class Difference:
    """Distances between sensors less their offsets, which are learned slowly while the sensors agree."""

    def __init__(self, gains: YawRateBestGains, smooth: float, learn: float, rest_samples: float) -> None:
        self.gains, self.smooth, self.learn, self.rest_samples = gains, smooth, learn, rest_samples

    @property
    def states(self) -> Layout[DifferenceState]:
        """Layout of what it keeps."""
        return Layout(DifferenceState(offset=3, apart=3, agreed_samples=ROW))

    def start(self) -> DifferenceState:
        """The sensors agree."""
        return DifferenceState(offset=0.0, apart=0.0, agreed_samples=self.rest_samples)

    def step(
        self, x: DifferenceState, begun: Row, r_deg_s: Rows, p_deg_s: Row, declared: Rows
    ) -> tuple[DifferenceState, Row, Row, Row]:
        """State at the next sample; the distance over its limit [-]; whether it is beyond, and whether it lately was."""
        g = self.gains
        off = r_deg_s - (r_deg_s[0] + r_deg_s[1] + r_deg_s[2]) / 3.0
        # the first sample shows offsets as well as any
        offset = np.where(begun > 0.0, x.offset, _limited(off, g.offset_deg_s))
        beyond = off - offset
        apart = x.apart + self.smooth * (beyond - x.apart)
        limit = g.differ_deg_s + g.differ_per_roll * np.abs(p_deg_s)
        # those that are declared are no longer compared
        ratio = (largest(apart - _OUT * declared) - smallest(apart + _OUT * declared)) / limit
        differ = ratio > 1.0
        agreed = np.where(differ, 0.0, x.agreed_samples + 1.0)
        gathering = agreed < self.rest_samples
        learned = _limited(offset + self.learn * beyond, g.offset_deg_s)
        after = DifferenceState(offset=np.where(gathering, offset, learned), apart=apart, agreed_samples=agreed)
        return after, ratio, differ, gathering


def smallest(rows: Rows) -> Row:
    """Smallest of the rows, (n_cases,)."""
    return -largest(-rows)


def _limited(rows: Rows, most: float) -> Rows:
    return np.minimum(np.maximum(rows, -most), most)
