"""The one fault step: data rows decide kind, size and time, so one chunk mixes all scenarios and kinds.

A fault occupies a slot; the slots act one after the other on the sites. A slot without a fault, and a fault of size zero,
leave every bit of the healthy signal as it was.
"""

from collections.abc import Sequence
from types import SimpleNamespace

import numpy as np

from fddbench.blocks.functions import sin
from fddbench.blocks.layout import Layout, Rows
from fddbench.faults.specification import FaultSpecification, FaultWave
from fddbench.interfaces import FaultUnits

__all__ = ["NEVER", "FaultStep", "first_samples"]

NEVER = float(2**53)
"""A sample number that no flight reaches; an exact float64."""

_WAVE = tuple(FaultWave.__dataclass_fields__)


def first_samples(fault: FaultSpecification, sites: Sequence[str], sample_s: float) -> list[float]:
    """First faulty sample of every site of the benchmark, `NEVER` for those the fault leaves alone."""
    onset = {site: fault.onset_s + fault.delay_s * nth for nth, site in enumerate(fault.sites)}
    return [float(round(onset[site] / sample_s)) if site in onset else NEVER for site in sites]


class FaultStep:
    """Faults of up to `slots` slots on all sites of a benchmark.

    Parameters
    ----------
    sites : sequence of str
        Fault sites of the benchmark, in order.
    slots : int
        Most faults that a scenario of the campaign has.
    sample_s : float
        Sample time [s].
    """

    def __init__(self, sites: Sequence[str], slots: int, sample_s: float) -> None:
        n = len(sites)
        self.sites, self.slots, self.sample_s = tuple(sites), slots, sample_s
        slot = Layout(**dict.fromkeys(_WAVE, 0), bit_samples=0, independent=0, first=n, last=n, sign=n, phase=n)
        self.slot = slot
        self.constants = Layout(**{f"slot_{j}": slot.size for j in range(slots)})
        self.states = Layout(**{name: n for j in range(slots) for name in (f"held_{j}", f"bit_{j}")}, last_healthy=n)

    def rows(self, faults: Sequence[FaultSpecification], units: FaultUnits, phases: np.ndarray) -> np.ndarray:
        """Constant rows of one scenario, (n_rows, n_cases).

        Parameters
        ----------
        faults : sequence of FaultSpecification
            Faults of the scenario, at most `slots`.
        units : FaultUnits
            Ranges of the faulty signal.
        phases : (slots, n_sites, n_cases) array
            Uniform numbers in (0, 1) for faults that draw their phase per case.
        """
        n_cases = phases.shape[-1]
        columns = [self._column(fault, units) for fault in faults]
        columns += [self._empty()] * (self.slots - len(faults))
        rows = np.repeat(np.concatenate(columns)[:, np.newaxis], n_cases, axis=1) if columns else np.zeros((0, n_cases))
        for j, fault in enumerate(faults):
            if fault.wave(units).phase_uniform:
                site = slice(None) if fault.correlation == "independent" else 0
                start = self.slot.size * j + self.slot.index["phase"].start  # type: ignore[union-attr]
                rows[start : start + len(self.sites)] = 2.0 * np.pi * phases[j, site]
        return rows

    def _column(self, fault: FaultSpecification, units: FaultUnits) -> np.ndarray:
        """Constants of one fault, (n_slot_rows,)."""
        wave = fault.wave(units)
        signs = {
            site: -1.0 if fault.correlation == "opposite" and nth % 2 else 1.0 for nth, site in enumerate(fault.sites)
        }
        last = NEVER if fault.end_s is None else float(round(fault.end_s / self.sample_s)) - 1.0
        values = {name: np.array(getattr(wave, name)) for name in _WAVE}
        packed: np.ndarray = self.slot.pack(
            **values,
            bit_samples=np.array(max(1.0, float(round(wave.bit_s / self.sample_s)))),
            independent=np.array(float(fault.correlation == "independent")),
            first=np.array(first_samples(fault, self.sites, self.sample_s)),
            last=np.full(len(self.sites), last),
            sign=np.array([signs.get(site, 0.0) for site in self.sites]),
            phase=np.full(len(self.sites), wave.phase_rad),
        )
        return packed

    def _empty(self) -> np.ndarray:
        """Constants of a slot without a fault."""
        never = {"first": np.full(len(self.sites), NEVER), "last": np.zeros(len(self.sites))}
        values = {name: np.zeros(rows) if rows else np.array(0.0) for name, rows in self.slot.fields.items()}
        packed: np.ndarray = self.slot.pack(**{**values, **never})
        return packed

    def step(
        self, healthy: Rows, state: Rows, constants: Rows, normals: Sequence[Rows], sample: Rows
    ) -> tuple[Rows, Rows]:
        """Faulty signal, (n_sites, n_cases), and the state at the next sample.

        Parameters
        ----------
        healthy : (n_sites, n_cases) rows
            Signal without faults.
        normals : sequence of (4, n_cases) rows
            Four normals per slot from the scenario's stream; site i takes number i when independent, else number 0.
        sample : number
            Sample k.
        """
        x, named = self.states.unpack(state), self.constants.unpack(constants)
        signal, after = healthy, {"last_healthy": healthy}
        for j in range(self.slots):
            held, bit = getattr(x, f"held_{j}"), getattr(x, f"bit_{j}")
            signal, after[f"held_{j}"], after[f"bit_{j}"] = self._slot(
                signal, x.last_healthy, held, bit, self.slot.unpack(getattr(named, f"slot_{j}")), normals[j], sample
            )
        return signal, self.states.pack(**after)

    def _slot(
        self, y: Rows, before: Rows, held: Rows, bit: Rows, c: SimpleNamespace, normals: Rows, sample: Rows
    ) -> tuple[Rows, Rows, Rows]:
        """One fault on all sites: signal, held value and random bit."""
        since = sample - c.first
        active = (since >= 0.0) & (sample <= c.last)
        held = np.where(since == 0.0, before, held)
        random = np.where(c.independent > 0.0, normals[: len(self.sites)], normals[:1])
        new_bit = since - c.bit_samples * np.floor(since / np.maximum(c.bit_samples, 1.0)) == 0.0
        bit = np.where(new_bit, np.where(random >= 0.0, 1.0, -1.0), bit)
        time_s = np.where(active, since, 0.0) * self.sample_s
        ramp = np.minimum(np.maximum(c.rate * time_s, -c.ramp_limit), c.ramp_limit)
        sine = c.amplitude * sin(c.frequency_rad_s * time_s + c.phase)
        wave = c.offset + ramp + sine + c.sigma * random + c.bit * bit
        sum_ = c.keep * y + c.hold * held + c.hold_value + c.sign * wave
        clipped = np.minimum(np.maximum(sum_, -c.clip), c.clip)
        return np.where(active, clipped, y), held, bit
