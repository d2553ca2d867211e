"""Where results come from: program, libraries, machine, campaign."""

import hashlib
import platform
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version

from fddbench.results.schema import SCHEMA_VERSION

__all__ = ["collect"]

_LIBRARIES = ("numpy", "scipy", "pandas", "pyarrow", "joblib", "llvmlite")


def collect(
    *,
    campaign: str,
    campaign_sha256: str,
    designs_sha256: Mapping[str, str],
    scenarios: Sequence[str],
    seed: int,
    files: Mapping[str, bytes],
) -> dict[str, object]:
    """Provenance of a run that begins now; plain data for a JSON file."""
    return {
        "campaign": campaign,
        "campaign_sha256": campaign_sha256,
        "designs_sha256": dict(designs_sha256),
        "scenarios": list(scenarios),
        "seed": seed,
        "files": {name: hashlib.sha256(content).hexdigest() for name, content in sorted(files.items())},
        "schema_version": SCHEMA_VERSION,
        "fddbench": version("fddbench"),
        "python": platform.python_version(),
        "libraries": {name: _version(name) for name in _LIBRARIES},
        "system": f"{platform.system()} {platform.machine()}",
        "begun": datetime.now(UTC).isoformat(timespec="seconds"),
    }


def _version(name: str) -> str:
    """Version of a library, "none" where it is not installed."""
    try:
        return version(name)
    except PackageNotFoundError:
        return "none"
