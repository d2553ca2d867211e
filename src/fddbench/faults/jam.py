"""Jam: the sensor stands off by a constant, or stands still."""

from collections.abc import Iterator
from typing import ClassVar, Literal

from fddbench.faults.bias import Offset
from fddbench.faults.key_rules import KeyRule, exactly_one, where
from fddbench.faults.specification import WithAmplitude
from fddbench.interfaces import Floats, Site

__all__ = ["Jam"]


class Jam(WithAmplitude):
    """A constant added to the sensor (the published case), or the sensor standing at a value.

    Attributes
    ----------
    amplitude_percent, amplitude : float
        Offset with ``mode: add``, of the admissible range [%] or in the unit of the sites; give one. With
        ``mode: replace`` give
        ``freeze: true`` or a ``hold_value_*`` instead.
    """

    about: ClassVar[str] = "a constant offset (add) or a stuck sensor (replace)"
    profile = Offset

    kind: Literal["jam"]

    @classmethod
    def key_rules(cls) -> Iterator[KeyRule]:
        """An amplitude that is added, or one thing at which the sensor stands."""
        yield from super(WithAmplitude, cls).key_rules()
        sizes = ("amplitude_percent", cls.key("amplitude"))
        held = [{"required": [key]} for key in (cls.key("hold_value"), "hold_value_percent")]
        stands = {"anyOf": [{"properties": {"freeze": {"const": True}}, "required": ["freeze"]}, *held]}
        yield where(
            "mode", "replace", {**stands, "properties": {key: {"type": "null"} for key in sizes}}, exactly_one(*sizes)
        )

    def numbers(self, site: Site, uniform: Floats) -> Offset:
        """Offset, or none beside the held value."""
        del uniform
        if self.mode == "add":
            return Offset(offset=self.size("amplitude", site))
        if self.amplitude_percent is not None or self.amplitude is not None:
            raise ValueError("a jam with mode: replace stands at hold_value_* or freezes; remove the amplitude")
        if not self.freeze and self.hold_value is None and self.hold_value_percent is None:
            held = f"{self.key('hold_value')} | hold_value_percent"
            raise ValueError(f"a jam with mode: replace needs freeze: true | {held}")
        return Offset(offset=0.0)
