"""Flies cases of a finished campaign again and keeps the signals: for pictures and for a close look."""

from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import numpy.typing as npt
import pandas as pd

from fddbench.blocks.linear import total
from fddbench.blocks.philox import philox4x32
from fddbench.campaign.load import read_campaign
from fddbench.campaign.plan import PlannedScenario
from fddbench.interfaces import Floats, Recording, Verdict
from fddbench.runner.assembly import Assembly, Batch, assemble
from fddbench.runner.flight import fly

__all__ = ["MOST_CASES", "replay", "sampled_cases"]

MOST_CASES = 50
"""Cases of a scenario that a picture shows, beside the worst ones."""

Cases = npt.NDArray[np.int64]


def sampled_cases(rows: pd.DataFrame, *, seed: int, most: int = MOST_CASES) -> dict[str, Cases]:
    """Cases to show by scenario: a seeded sample of those flown, and the worst of every detector.

    Worst is the slowest detection, or the largest margin of a healthy flight.
    """
    found: dict[str, Cases] = {}
    for scenario, group in rows[rows["status"] == "ok"].groupby("scenario", sort=False):
        cases = np.unique(group["case"].to_numpy(dtype=np.int64))
        order = np.argsort(philox4x32((cases & 0xFFFFFFFF, 0, 0, 0), seed)[0], kind="stable")
        worst = [_worst(of_one) for _, of_one in group.groupby("detector", sort=False)]
        found[str(scenario)] = np.unique(np.concatenate([cases[order[:most]], worst]).astype(np.int64))
    return found


def _worst(rows: pd.DataFrame) -> int:
    """Case of the slowest detection (none counts as slowest), or of the largest healthy margin."""
    by = "margin_healthy" if (rows["n_faulty"] == 0).all() else "detection_time_s"
    badness = rows[by].astype("float64[pyarrow]").fillna(np.inf if by == "detection_time_s" else -1.0)
    return int(rows["case"].iloc[int(np.argmax(badness.to_numpy(dtype=float)))])


def replay(
    folder: Path,
    cases: Mapping[str, Cases] | None = None,
    *,
    seconds: Mapping[str, float] | None = None,
    signals: Collection[str] | None = None,
) -> Iterator[Recording]:
    """Recordings of cases, scenario by scenario, from the frozen campaign of a folder of results.

    Parameters
    ----------
    folder : Path
        Folder of results.
    cases : mapping of str to array, optional
        Case numbers by scenario; all cases by default.
    seconds : mapping of str to float, optional
        By scenario, how long after the onset of its fault the recording stops [s]; to the end by default.
    signals : collection of str, optional
        Measured and true signals to keep; all by default. What the detectors show is always kept.
    """
    assembly = assemble(read_campaign(folder / "campaign.yaml"))
    for planned in assembly.plan.scenarios:
        chosen = (cases or {}).get(planned.name, np.arange(planned.first_case, planned.first_case + planned.n_runs))
        if len(chosen):
            yield _record(assembly, planned, chosen, (seconds or {}).get(planned.name), signals)


def _record(
    assembly: Assembly, planned: PlannedScenario, cases: Cases, seconds: float | None, signals: Collection[str] | None
) -> Recording:
    """Signals of cases of one scenario."""
    sample_s = assembly.loop.bus.sample_s
    batch = assembly.batch(cases)
    last = planned.n_samples - 1
    if planned.k0 is not None and seconds is not None:
        last = min(last, planned.k0 + round(seconds / sample_s))
    tape = _Tape(assembly, batch, last, signals)
    fly(assembly, tape.shortened(batch), tape)
    return Recording(
        scenario=planned.name,
        cases=tuple(int(case) for case in cases),
        time_s=np.round(np.arange(last + 1) * sample_s, 9),
        onset_s=None if planned.k0 is None else round(planned.k0 * sample_s, 9),
        signals=tape.signals,
        detectors=tape.detectors,
    )


class _Tape:
    """Keeps what a flight shows, (n_time, n_cases) a signal."""

    def __init__(self, assembly: Assembly, batch: Batch, last: int, signals: Collection[str] | None) -> None:
        self.assembly, self.last, self.kept = assembly, last, signals
        self.shape = (last + 1, len(batch.cases))
        self.signals: dict[str, Floats] = {}
        # all signals from the beginning: a detector that raises leaves a gap, not a missing signal
        self.detectors: dict[str, dict[str, Floats]] = {
            name: {signal: np.full(self.shape, np.nan) for signal in ("n_declared", "ratio", *detector.recorded)}
            for name, detector in assembly.detectors.items()
        }

    def shortened(self, batch: Batch) -> Batch:
        """The same batch, scored and flown only as far as the tape goes."""
        named = self.assembly.scoring.constants.unpack(rows := batch.score_constants.copy())
        named.last[...] = np.minimum(named.last, float(self.last))
        return replace(batch, score_constants=rows)

    def __call__(
        self, sample: int, measured: SimpleNamespace, truth: Mapping[str, Floats], verdicts: Mapping[str, Verdict]
    ) -> None:
        """Write one sample."""
        for name, rows in self.assembly.loop.bus.signals.items():
            if self.kept is not None and name not in self.kept:
                continue
            value = getattr(measured, name)
            for i, row in enumerate(value if rows else [value]):
                self._write(self.signals, f"{name}_{i + 1}" if rows else name, sample, row)
        for name, value in truth.items():
            if self.kept is None or name in self.kept:
                self._write(self.signals, name, sample, value)
        for detector, verdict in verdicts.items():
            tape = self.detectors[detector]
            self._write(tape, "n_declared", sample, total(verdict.declared))
            self._write(tape, "ratio", sample, verdict.ratio)
            for name, value in verdict.signals.items():
                self._write(tape, name, sample, value)

    def _write(self, tape: dict[str, Floats], name: str, sample: int, value: Floats) -> None:
        if name not in tape:
            tape[name] = np.full(self.shape, np.nan)
        tape[name][sample] = value
