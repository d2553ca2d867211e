"""A detector as the composition flies it: a full block whose verdict speaks of every site of the benchmark."""

from dataclasses import replace
from functools import cached_property
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np

from fddbench.blocks.block import NO_DRAWS, NOTHING
from fddbench.blocks.drawn import Draws
from fddbench.blocks.layout import Layout, Nothing, Row, Rows
from fddbench.blocks.linear import total
from fddbench.designs.hold import Hold
from fddbench.designs.tracing import Obstacle, obstacle
from fddbench.errors import DesignError
from fddbench.interfaces import Bus, Verdict

if TYPE_CHECKING:
    from fddbench.designs.design import Design

__all__ = ["Adapted"]


class Adapted:
    """Block whose step is fed with the bus and gives a verdict with a row for every site, and an alarm.

    Parameters
    ----------
    detector : Detector
        With what `fddbench.interfaces.Detector` asks for; what it leaves out is filled in here, nothing is repaired.
    bus : Bus
        What it is fed with.
    every : int
        It steps at every so manieth sample of it, and its decision holds between.
    design : Design, optional
        What it was built from, so that it can be built once more in a process of its own.
    """

    constants: Layout[Any] = NOTHING

    def __init__(self, detector: Any, bus: Bus, every: int = 1, design: "Design | None" = None) -> None:
        self.detector, self.bus, self.every, self.design = detector, bus, every, design
        states = getattr(detector, "states", None)
        self.has_states = isinstance(states, Layout)
        self.own_states: Layout[Any] = states if isinstance(states, Layout) else NOTHING
        self.full = getattr(detector, "draws", None) is not None
        self.draws: Draws[Any] = getattr(detector, "draws", NO_DRAWS)
        self.recorded: tuple[str, ...] = getattr(detector, "recorded", ())
        self.watches: tuple[str, ...] = tuple(getattr(detector, "watches", bus.names))
        self.isolates: bool = bool(getattr(detector, "isolates", True))
        self.sees: str = str(getattr(detector, "sees", "sensors"))
        self.estimates: str | None = getattr(detector, "estimates", None)
        self.batched: bool = bool(getattr(detector, "batched", False))

    @cached_property
    def hold(self) -> Hold | None:
        """What holds its decisions between steps; None where it steps at every sample."""
        if self.every == 1:
            return None
        return Hold(
            self.every, self.own_states, self.bus.names, self.watches, isolates=self.isolates,
            estimates=self.estimates is not None, sizes=self.estimates == "sites", recorded=self.recorded,
        )  # fmt: skip

    @property
    def states(self) -> Layout[Any]:
        """Layout of what is kept from sample to sample: its own, and what is held."""
        return self.hold.states if self.hold else self.own_states

    @property
    def at_every_sample(self) -> "Adapted":
        """The detector alone, as it steps on its own clock."""
        return self if self.every == 1 else Adapted(self.detector, self.bus)

    @cached_property
    def obstacle(self) -> Obstacle:
        """What is in the way of tracing its step."""
        return obstacle(self, self.bus)

    @property
    def opaque(self) -> str:
        """Why its step cannot be traced, in one line; "" when it can."""
        return self.obstacle.reason

    @property
    def one_by_one(self) -> bool:
        """Whether it sees one flight at a time: ordinary Python that does not ask for many."""
        return bool(self.opaque) and not self.batched

    def start(self, c: Nothing) -> Any:
        """State before the first sample."""
        own = self.detector.start(c) if self.full else self.detector.start()
        return self.hold.start(own) if self.hold else own

    def step(self, x: Any, c: Nothing, n: Any, measured: SimpleNamespace) -> tuple[Any, Verdict]:
        """State after this sample, and the verdict on it."""
        if self.hold:
            return self.hold.step(x, lambda own: self._own_step(own, c, n, measured))
        return self._own_step(x, c, n, measured)

    def _own_step(self, x: Any, c: Nothing, n: Any, measured: SimpleNamespace) -> tuple[Any, Verdict]:
        """One step of the detector, its verdict on all sites."""
        own = SimpleNamespace(**vars(measured))
        given = self.detector.step(x, c, n, own) if self.full else self.detector.step(x, own)
        if not isinstance(given, tuple) or len(given) != 2:
            raise DesignError(f"a step gives (state, Verdict), got {type(given).__name__}")
        after, verdict = given
        return after, self.spoken(verdict)

    def spoken(self, verdict: Verdict) -> Verdict:
        """A verdict on the sites it watches as one on all sites, with an alarm.

        Raises
        ------
        DesignError
            It is none.
        """
        self._check(verdict)
        declared = self._spread(verdict)
        alarm = verdict.alarm
        if alarm is None:
            alarm = np.where(total(declared * 1.0) > 0.0, 1.0, 0.0)
        return replace(verdict, declared=declared, alarm=alarm, estimate=self._sizes(verdict))

    def _check(self, verdict: Any) -> None:
        """Refuse what is no verdict of this detector.

        Raises
        ------
        DesignError
            A wrong shape, no alarm and no declaration, or other signals than announced.
        """
        if not isinstance(verdict, Verdict):
            raise DesignError(f"a step gives (state, Verdict), got {type(verdict).__name__} as verdict")
        n_cases = np.shape(verdict.residual)[-1:]
        if not n_cases:
            raise DesignError("a verdict needs residual of shape (n_cases,), got (): a row of numbers, not one")
        shapes: dict[str, tuple[Any, tuple[int, ...]]] = {"residual": (verdict.residual, n_cases)}
        if self.isolates:
            shapes["declared"] = (verdict.declared, (len(self.watches), *n_cases))
        elif verdict.alarm is None or verdict.declared is not None:
            raise DesignError("a detector with isolates = False gives an alarm and declares no sites (declared=None)")
        if verdict.alarm is not None:
            shapes["alarm"] = (verdict.alarm, n_cases)
        self.require_announced(verdict.estimate)
        if self.estimates is not None:
            of_sites = (len(self.watches),) if self.estimates == "sites" else ()
            shapes["estimate"] = (verdict.estimate, (*of_sites, *n_cases))
        shapes |= {name: (value, n_cases) for name, value in verdict.signals.items() if np.shape(value) != ()}
        wrong = [
            f"{name} of shape {need}, got {np.shape(value)}"
            for name, (value, need) in shapes.items()
            if np.shape(value) != need
        ]
        if wrong:
            raise DesignError(f"a verdict needs {'; '.join(wrong)}")
        numbers = {name: value for name, (value, _) in shapes.items()} | dict(verdict.signals)
        odd = [f"{name} is {kind}" for name, value in numbers.items() if (kind := _odd_kind(value))]
        if odd:
            raise DesignError(f"a verdict needs real numbers; {', '.join(odd)}")
        if set(verdict.signals) != set(self.recorded):
            raise DesignError(
                f"recorded announces {sorted(self.recorded)}, the verdict shows {sorted(verdict.signals)}; make them equal"
            )

    def require_announced(self, estimate: Any) -> None:
        """Refuse an estimate that nobody announced, and none where one was.

        Raises
        ------
        DesignError
            It is one of both.
        """
        if (estimate is None) != (self.estimates is None):
            raise DesignError(
                "a detector that gives an estimate says of what, and one that says so gives it: estimates = 'sites', the name "
                f"of a voted signal, or None; it says {self.estimates!r}"
            )

    def _spread(self, verdict: Verdict) -> Rows:
        """Declared sites of the whole benchmark: nothing where the detector does not watch."""
        if verdict.declared is None:
            return np.stack([np.zeros_like(verdict.residual)] * len(self.bus.sites))
        return self._everywhere(verdict.declared, verdict.residual)

    def _sizes(self, verdict: Verdict) -> Rows:
        """Estimate of every site of the benchmark, or of the voted signal; None without one."""
        return self._everywhere(verdict.estimate, verdict.residual) if self.estimates == "sites" else verdict.estimate

    def _everywhere(self, watched: Rows, like: Row) -> Rows:
        """Rows of every site of the benchmark, 0 where the detector does not watch."""
        if self.watches == self.bus.names:
            return watched
        rows = dict(zip(self.watches, watched, strict=True))
        return np.stack([rows[name] * 1.0 if name in rows else np.zeros_like(like) for name in self.bus.names])


def _odd_kind(value: Any) -> str:
    """Name of a dtype that holds no real numbers; "" for one that does."""
    dtype = value.dtype if hasattr(value, "dtype") else np.asarray(value).dtype
    return "" if dtype.kind in "bfiu" else str(dtype)
