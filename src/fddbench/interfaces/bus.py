"""What a detector can see, and what it can ask about it."""

from collections.abc import Mapping
from dataclasses import dataclass

from fddbench.errors import DesignError, did_you_mean
from fddbench.interfaces.site import Site

__all__ = ["Bus"]


@dataclass(frozen=True, kw_only=True)
class Bus:
    """Measured signals of a benchmark, and its fault sites.

    Attributes
    ----------
    sample_s : float
        Time between two samples [s].
    sites : tuple of Site
        Fault sites in their order.
    signals : mapping of str to int
        Measured signals by name with unit; rows of each, 0 for a single signal seen as (n_cases,).
    """

    sample_s: float
    sites: tuple[Site, ...]
    signals: Mapping[str, int]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all fault sites."""
        return tuple(site.name for site in self.sites)

    def sites_of(self, kind: str) -> tuple[str, ...]:
        """Names of the sites of a kind: "sensor", "actuator" or "component"."""
        return tuple(site.name for site in self.sites if site.kind == kind)

    def sites_on(self, signal: str) -> tuple[str, ...]:
        """Names of the sites on a signal, in the order of its rows."""
        return tuple(site.name for site in sorted(self.sites, key=lambda s: s.row) if site.signal == signal)

    def redundant(self, signal: str, least: int = 2) -> tuple[str, ...]:
        """Names of the redundant sensors whose readings are the rows of a signal, in that order.

        Raises
        ------
        DesignError
            The bus has no such signal, or not a sensor site for each of at least `least` rows.
        """
        self.require(signal)
        rows = self.signals[signal]
        found = [site for site in self.sites if site.signal == signal and site.kind == "sensor"]
        names = {site.row: site.name for site in found}
        if rows < least or sorted(names) != list(range(rows)):
            raise DesignError(
                f"needs {least} or more redundant sensors on {signal}, a fault site each; this benchmark has {rows} rows and "
                f"the sites {', '.join(names.values()) or 'none'} there"
            )
        return tuple(names[row] for row in range(rows))

    def require(self, *signals: str) -> None:
        """Do nothing when the bus has these signals.

        Raises
        ------
        DesignError
            Some are missing; the message lists what there is.
        """
        missing = [name for name in signals if name not in self.signals]
        if missing:
            close = " ".join(filter(None, (did_you_mean(name, self.signals) for name in missing)))
            raise DesignError(
                f"needs the signals {missing}, this benchmark has {sorted(self.signals)}{'. ' + close if close else ''}"
            )
