"""One way to write a campaign, and the fingerprint of what it means."""

import json
from hashlib import sha256
from typing import Any

import yaml

from fddbench.campaign.reading.scalars import resolve

__all__ = ["canonical_text", "fingerprint", "text_sha256"]

_WIDTH = 110


class _Dumper(yaml.SafeDumper):
    """Writes no aliases, and quotes every text that the strict reader would take for something else."""

    def ignore_aliases(self, _data: Any) -> bool:
        return True


def _quoted_where_needed(dumper: _Dumper, text: str) -> yaml.ScalarNode:
    style = "|" if "\n" in text else None
    try:
        style = style if isinstance(resolve(text), str) else '"'
    except ValueError:
        style = '"'
    return dumper.represent_scalar("tag:yaml.org,2002:str", text, style=style)


_Dumper.add_representer(str, _quoted_where_needed)


def canonical_text(data: Any) -> str:
    """YAML of plain data; reading it gives the same data, and writing that the same text."""
    text: str = yaml.dump(data, Dumper=_Dumper, sort_keys=False, allow_unicode=True, width=_WIDTH)
    return text


def text_sha256(text: str) -> str:
    """SHA-256 of a text in UTF-8, 64 hexadecimal digits."""
    return sha256(text.encode()).hexdigest()


def fingerprint(content: Any) -> str:
    """SHA-256 of plain data, whatever the order of its keys."""
    return text_sha256(json.dumps(content, sort_keys=True, separators=(",", ":"), allow_nan=False))
