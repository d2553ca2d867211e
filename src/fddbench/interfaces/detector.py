"""What a detector and a voter must offer."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any, Protocol, runtime_checkable

from fddbench.blocks.layout import Row, Rows

__all__ = ["Detector", "Tunable", "Verdict", "Voter"]


@dataclass(frozen=True)
class Verdict:
    """What a detector decides at one sample; one that sees one flight at a time gives numbers instead of rows.

    Attributes
    ----------
    declared : (n_watched, n_cases) rows or None
        1 where a watched site is declared faulty, else 0, in the order of `Detector.watches`; None for a detector that only
        detects.
    residual : (n_cases,) row
        Largest residual over its threshold [-]; above 1 the detector suspects a fault.
    signals : mapping of str to (n_cases,) rows
        What the detector shows of its inside, by name with unit, as announced in `Detector.recorded`.
    alarm : (n_cases,) row or None
        1 where something is wrong, else 0; None: where any site is declared. It holds wherever a site is declared.
    estimate : (n_watched, n_cases) rows, (n_cases,) row or None
        Size of the fault in the unit of its site: of every watched site, or of the voted signal that `estimates` names.
    """

    declared: Rows
    residual: Row
    signals: Mapping[str, Row] = field(default_factory=dict)
    alarm: Row = None
    estimate: Rows = None


class Detector(Protocol):
    """A tuned detector: immutable numbers, its state passed in and out.

    A class registered under ``fddbench.detectors`` has besides: ``Gains``, the pydantic model of its numbers, and
    ``from_design(gains, bus)``, which makes the detector for a bus or raises `DesignError`. Where gains name members of other
    families, ``Gains.MEMBERS`` says which keys do (``{"scheduling": "scheduling"}``), and the members that are named come as
    further arguments, ``from_design(gains, bus, scheduling=...)``. What ``fddbench tune`` may change is said by
    ``Gains.THRESHOLDS``, the gains that are thresholds (numbers, or lists of them) and the direction in which each quiets the
    detector: ``{"limit_deg_s": "up", "false_alarm_share": "down"}``; nothing is tuned that it does not name.

    It may have more, and has these otherwise: ``recorded``, the names of what its verdicts show (()); ``watches``, the names
    of the sites it declares (all sites of the bus); ``isolates`` (True; False for one that only detects); ``estimates``, what
    `Verdict.estimate` is of (None: it gives none): "sites", or the name of a voted signal; ``sees`` ("sensors"; "voted" for one
    that looks at the voted signal and not at the sensors it is made of, and is not ranked with those that do); ``constants``
    and ``draws`` (none): a detector that has them is a full block, with ``start(c)`` and ``step(x, c, n, measured)``.

    **Rows.** With ``states``, a `Layout`, a step is a function on rows that is compiled, see `fddbench.interfaces`.

    **Ordinary Python.** Without ``states``, or where the step cannot be compiled, a detector sees one flight at a time: a
    signal of the bus is a float, one of several rows a read-only 1-D array. ``start()`` gives the state of one flight, an
    object of any kind, new at every call; it comes back to ``step(state, measured)``, which gives ``(state, Verdict)`` and may
    change the state in place. In the verdict ``declared`` is a list or array of numbers or booleans, one a watched site,
    ``residual``, ``alarm`` and each signal is a number, ``estimate`` a number or a list. Whatever a step raises becomes the
    reason of the row. Nothing may be kept but in the state: before all others some flights are flown twice, by the detector
    that flew before and by a new one, and a detector that decides otherwise is refused.

    **batched = True**, beside ``states``: a step on rows that cannot be compiled sees many flights side by side all the same.
    It may not mix them, which is tried as well.

    Examples
    --------
    >>> class Range:  # declares a sensor, for good, that has been far from the voted signal for five samples
    ...     def start(self):
    ...         return {"count": [0, 0, 0], "declared": [False] * 3}
    ...
    ...     def step(self, state, measured):
    ...         distances = [abs(r - measured.r_voted_deg_s) for r in measured.r_deg_s]
    ...         for i, distance in enumerate(distances):
    ...             state["count"][i] = state["count"][i] + 1 if distance > 0.5 else 0
    ...             if state["count"][i] == 5:
    ...                 state["declared"][i] = True
    ...         return state, Verdict(state["declared"], max(distances) / 0.5)
    >>> now = SimpleNamespace(r_deg_s=[0.1, 0.0, 2.1], r_voted_deg_s=0.1)
    >>> detector = Range()
    >>> state = detector.start()
    >>> for _ in range(5):
    ...     state, verdict = detector.step(state, now)
    >>> verdict.declared, verdict.residual
    ([False, False, True], 4.0)
    """

    def start(self) -> Any:
        """State before the first sample: of every flight, plain numbers in a record of `states`; or of one flight, anything."""
        ...

    def step(self, x: Any, measured: SimpleNamespace) -> tuple[Any, Verdict]:
        """State after this sample, and the verdict on it; `measured` has the signals of the bus as attributes."""
        ...


@runtime_checkable
class Tunable(Protocol):
    """A detector whose ``Gains`` have ``thresholds``, one per signal, of which ``fddbench tune`` can choose each by itself.

    It alarms when one of the `evaluated` signals has stayed above its threshold for `confirm_samples` samples.
    """

    evaluated: tuple[str, ...]
    confirm_samples: float


class Voter(Protocol):
    """Makes one signal of redundant sensors; a class without arguments registered under ``fddbench.voters``.

    One whose numbers depend on what it votes has a class method ``for_signal(signal, n_sensors, sample_s)`` that makes it.
    Where a campaign says ``reconfigure``, the mean of the sensors left is voted instead once some are declared; one that keeps
    something and says ``reconfigures = True`` votes then too, with the declared ones as a third argument of its step.
    """

    def vote(self, sensors: Rows) -> Row:
        """Voted signal, (n_cases,), of the sensors, (n_sensors, n_cases); same unit."""
        ...
