"""Where results come from: what belongs together, how many flights there are to be, the machine."""

import platform
from collections.abc import Mapping
from datetime import UTC, datetime
from hashlib import sha256
from importlib.metadata import PackageNotFoundError, version

from fddbench.results.fingerprint import Fingerprint

__all__ = ["collect", "version_of"]

_TOOLS = ("scipy", "pandas", "pyarrow", "joblib")
"""Libraries that decide no bit of a row, named for those who look for a fault."""


def collect(
    fingerprint: Fingerprint,
    *,
    campaign: str,
    designs_sha256: Mapping[str, str],
    seed: int,
    flights: Mapping[str, int],
    text: bytes,
) -> dict[str, object]:
    """Provenance of a run that begins now; plain data for a JSON file.

    Parameters
    ----------
    fingerprint : Fingerprint
        Of the campaign and of the program that flies it.
    campaign, designs_sha256, seed
        Name of the campaign, its designs in their order, and its seed.
    flights : mapping of str to int
        How many flights each scenario is to have, in the order of the case table.
    text : bytes
        The campaign as it is frozen; its meaning is in the fingerprint.
    """
    return {
        "campaign": campaign,
        "seed": seed,
        "flights": dict(flights),
        "designs_sha256": dict(designs_sha256),
        "campaign_yaml_sha256": sha256(text).hexdigest(),
        **fingerprint.parts(),
        "fingerprints": [fingerprint.sha256],
        "tools": {name: version_of(name) for name in _TOOLS},
        "python": platform.python_version(),
        "system": f"{platform.system()} {platform.machine()}",
        "begun": datetime.now(UTC).isoformat(timespec="seconds"),
    }


def version_of(name: str) -> str:
    """Version of a library, "none" where it is not installed."""
    try:
        return version(name)
    except PackageNotFoundError:
        return "none"
