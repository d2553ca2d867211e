"""What a flight did with the aircraft, kept inside the flight: extremes, last values and sums of true signals.

Numbers are kept from k0, the first faulty sample, to the last that is scored, in a healthy flight from its start; so a flight
that departs is taken up to the sample before. The same numbers of a healthy twin come from its recorded signals, see
`fddbench.runner.twins`; both add left to right from sample 0, so equal flights have equal numbers.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from fddbench.blocks.layout import ROW, Layout, Row, Rows, record
from fddbench.errors import FddbenchError
from fddbench.interfaces import NEVER, Consequence

__all__ = ["ConsequenceState", "Consequences", "Sum", "begin_of"]


@record
class Sum:
    """Sum of a signal since the start, and that up to the sample before k0."""

    total: Row
    before: Row


@record
class ConsequenceState:
    """Largest absolute values, last values and sums, in the order in which a loop announces them."""

    peaks: tuple[Row, ...]
    ends: tuple[Row, ...]
    sums: tuple[Sum, ...]


def begin_of(k0: Rows) -> Rows:
    """First sample that counts: k0, or the start of a healthy flight."""
    return np.where(k0 < NEVER, k0, 0.0)


class Consequences:
    """What a loop announces, as a block that is fed with its true signals.

    Parameters
    ----------
    announced : sequence of Consequence
        By the loop.
    truth : sequence of str
        Names of its true signals.

    Raises
    ------
    FddbenchError
        One is of a signal that the loop does not show, or two have one name.
    """

    def __init__(self, announced: Sequence[Consequence], truth: Sequence[str]) -> None:
        unknown = [each.signal for each in announced if each.signal not in truth]
        names = [each.name for each in announced]
        if unknown or len(set(names)) < len(names):
            raise FddbenchError(
                f"the consequences {names} of a loop need names of their own and signals out of {list(truth)}, got {unknown}"
            )
        self.announced = tuple(announced)
        self.peaks, self.errors, self.rises = (
            tuple(each for each in announced if each.how == how) for how in ("peak", "error", "rise")
        )
        self.states = Layout(
            ConsequenceState(
                peaks=(ROW,) * len(self.peaks),
                ends=(ROW,) * len(self.errors),
                sums=(Sum(total=ROW, before=ROW),) * len(self.rises),
            )
        )

    @property
    def signals(self) -> tuple[str, ...]:
        """True signals that they are of, each once."""
        return tuple(dict.fromkeys(each.signal for each in self.announced))

    def start(self) -> ConsequenceState:
        """Nothing flown yet."""
        return ConsequenceState(
            peaks=(0.0,) * len(self.peaks),
            ends=(0.0,) * len(self.errors),
            sums=(Sum(total=0.0, before=0.0),) * len(self.rises),
        )

    def step(
        self, x: ConsequenceState, truth: Mapping[str, Rows], *, k0: Row, last: Row, sample: Row, alive: Row
    ) -> ConsequenceState:
        """Numbers after one more sample; flights that have departed or ended keep theirs."""
        active = alive & (sample <= last)
        counts = active & (sample >= begin_of(k0))
        not_yet = active & (sample < begin_of(k0))
        totals = [
            np.where(active, own.total + truth[each.signal], own.total)
            for own, each in zip(x.sums, self.rises, strict=True)
        ]
        return ConsequenceState(
            peaks=tuple(
                np.where(counts, np.maximum(peak, np.abs(truth[each.signal])), peak)
                for peak, each in zip(x.peaks, self.peaks, strict=True)
            ),
            ends=tuple(
                np.where(active, truth[each.signal], end) for end, each in zip(x.ends, self.errors, strict=True)
            ),
            sums=tuple(
                Sum(total=total, before=np.where(not_yet, total, own.before))
                for total, own in zip(totals, x.sums, strict=True)
            ),
        )
