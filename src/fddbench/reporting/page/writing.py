"""Writes the page: one HTML file that needs nothing beside it and no network."""

import base64
import hashlib
import json
from pathlib import Path
from typing import Any

from markupsafe import Markup

from fddbench.reporting.page.content import content
from fddbench.reporting.page.data import ReportData
from fddbench.reporting.svg.palette import css

__all__ = ["page_html", "write_page"]


def write_page(report: ReportData, output: Path) -> None:
    """Write the page of `report` to the file `output`; its folder is made."""
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_text(page_html(report), encoding="utf-8")


def page_html(report: ReportData) -> str:
    """Text of the page; the same bytes for the same report and the same versions of the libraries."""
    return rendered("page.html.j2", content(report))


def rendered(template: str, filled: dict[str, Any]) -> str:
    """Text of a page: style and script stand in it, and its policy names them by their hashes and allows nothing else."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=PackageLoader("fddbench.reporting"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["breakable"] = _breakable
    texts = {name: environment.loader.get_source(environment, name)[0] for name in ("style.css", "page.js")}  # type: ignore[union-attr]
    style, script = (_flush(text) for text in (css() + texts["style.css"], texts["page.js"]))
    return environment.get_template(template).render(
        style=style,
        script=script,
        style_hash=_hash(style),
        script_hash=_hash(script),
        data=_json(filled.pop("payload")),
        **filled,
    )


def _flush(text: str) -> str:
    """Text without the spaces that begin its lines."""
    return "\n".join(line.lstrip() for line in text.splitlines())


def _breakable(name: str) -> Markup:
    """Name that a line may break after an underscore; it stays text."""
    return Markup("_<wbr>").join(name.split("_"))


def _hash(text: str) -> str:
    """As a policy names what it allows."""
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()


def _json(data: Any) -> str:
    """Data inside a script element: nothing in it can end the element."""
    text = json.dumps(data, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")
