"""Oscillatory failure: a sine on the sensor."""

from collections.abc import Iterator
from typing import ClassVar, Literal, Self

import numpy as np
from pydantic import model_validator

from fddbench.blocks.functions import sin
from fddbench.blocks.layout import Rows, record
from fddbench.faults.key_rules import KeyRule, at_most_one, exactly_one, positive
from fddbench.faults.specification import Finite, WithAmplitude, one_of
from fddbench.faults.varied import bounds, in_words
from fddbench.interfaces import Floats, Site

__all__ = ["Oscillatory"]


@record
class Sine:
    """Amplitude in the unit of the site, frequency [rad/s], and phase at the onset [rad]."""

    amplitude: Rows
    frequency_rad_s: Rows
    phase_rad: Rows

    def at(self, time_s: Rows) -> Rows:
        """The sine."""
        return self.amplitude * sin(self.frequency_rad_s * time_s + self.phase_rad)


class Oscillatory(WithAmplitude):
    """A sine added to the sensor (liquid), or put in its place (solid).

    Attributes
    ----------
    amplitude_percent, amplitude : float
        Half of the peak-to-peak excursion, of the admissible range [%] or in the unit of the sites; give one.
    frequency_hz, frequency_rad_s : float
        Frequency, above 0 and below half the sampling rate; give one.
    phase_rad : float
        Phase at the onset [rad].
    phase : "uniform"
        Draws the phase per case instead.
    """

    about: ClassVar[str] = "a sine on the sensor"
    profile = Sine

    kind: Literal["oscillatory"]
    frequency_hz: Finite | None = None
    frequency_rad_s: Finite | None = None
    phase_rad: Finite | None = None
    phase: Literal["uniform"] | None = None

    @classmethod
    def key_rules(cls) -> Iterator[KeyRule]:
        """Exactly one frequency, above zero, and at most one phase."""
        yield from super().key_rules()
        yield exactly_one("frequency_hz", "frequency_rad_s")
        yield at_most_one("phase_rad", "phase")
        yield positive("frequency_hz", "frequency_rad_s")

    @model_validator(mode="after")
    def _one_phase(self) -> Self:
        if self.phase is not None and self.phase_rad is not None:
            raise ValueError("give phase_rad or phase: uniform, not both")
        return self

    def numbers(self, site: Site, uniform: Floats) -> Sine:
        """Sine of the given size."""
        turns = None if self.frequency_hz is None else 2.0 * np.pi * self.frequency_hz
        return Sine(
            amplitude=self.size("amplitude", site),
            frequency_rad_s=one_of(frequency_hz=turns, frequency_rad_s=self.frequency_rad_s),
            phase_rad=2.0 * np.pi * uniform if self.phase else 0.0 if self.phase_rad is None else self.phase_rad,
        )

    def unfit(self, sample_s: float) -> Iterator[tuple[str, str]]:
        """What the clock cannot show: times between samples, and sines that would look like slower ones or like none."""
        yield from super().unfit(sample_s)
        for key, limit, unit in (("frequency_hz", 0.5, "Hz"), ("frequency_rad_s", np.pi, "rad/s")):
            value, most = getattr(self, key), limit / sample_s
            if value is not None and not (bounds(value)[0] > 0.0 and bounds(value)[1] < most):
                yield (
                    key,
                    (
                        f"{key} must lie above 0 and below {most:.6g} {unit}, half the sampling rate at {sample_s:g} s, got "
                        f"{in_words(value)}: a faster sine looks like a slower one; lower it or shorten sample_s"
                    ),
                )
