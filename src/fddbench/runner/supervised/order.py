"""What a stage is to build: a design by its file, and what it is fed with."""

import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fddbench.designs.adapted import Adapted
from fddbench.designs.design import Design, read_design
from fddbench.designs.sweeps import with_gains
from fddbench.errors import DesignError
from fddbench.interfaces import Bus

__all__ = ["Order"]


@dataclass(frozen=True, kw_only=True)
class Order:
    """A detector in plain data.

    Attributes
    ----------
    name, path, sha256 : str
        Of the design, its file, and what the file and those beside it held.
    written : mapping or None
        Gains, of a variant or a tuning other than the file says; None: as it says.
    bus : Bus
        What it is fed with.
    search : tuple of str
        Folders in which Python looks for modules.
    """

    name: str
    path: str
    sha256: str
    written: Mapping[str, Any] | None
    bus: Bus
    search: tuple[str, ...]

    @classmethod
    def of(cls, design: Design, bus: Bus) -> "Order":
        """Order for a design."""
        written = dict(design.written) or None  # those of a variant, or of a tuning
        return cls(
            name=design.name, path=str(design.path.absolute()), sha256=design.sha256, written=written, bus=bus,
            search=tuple(sys.path),
        )  # fmt: skip

    def built(self) -> Adapted:
        """The detector, in the process that asks.

        Raises
        ------
        BaseException
            Whatever its file raises; DesignError where it is another file by now.
        """
        sys.path[:] = self.search
        design = read_design(Path(self.path))
        if design.sha256 != self.sha256:
            raise DesignError(f"{self.path} or a file beside it has changed meanwhile; run again")
        if self.written is not None:
            design = with_gains(design, self.written, self.name)
        return Adapted(design.build(self.bus), self.bus, design.every, design)
