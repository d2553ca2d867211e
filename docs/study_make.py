"""Writes docs/study.ipynb anew and executes it: python docs/study_make.py."""

import os
import tempfile
from pathlib import Path

import nbformat
from nbclient import NotebookClient

CELLS = [
    (
        "md",
        "# A study in pandas, DuckDB and Polars\n\nOne folder of results, three ways to ask. Every cell was executed.",
    ),
    (
        "py",
        'import fddbench\n\nreport = fddbench.run("smoke", "results/smoke", jobs=1)\nreport.total, report.failed_rows',
    ),
    ("md", "## pandas\n\n`load` gives one row per flight and detector, Arrow-backed: null stays null."),
    ("py", 'rows = fddbench.load("results/smoke")\nrows[["case", "detector", "outcome", "detection_time_s"]].head(4)'),
    ("py", 'rows.groupby(["detector", "outcome"]).size().unstack(fill_value=0)'),
    ("md", "Rates with exact intervals are `summary`'s: a share without its count and interval says nothing."),
    (
        "py",
        'fddbench.summary("results/smoke")[["scenario", "detector", "flown", "right", "right_low_percent"]].tail(4)',
    ),
    ("md", "## DuckDB\n\nViews over the shards, checked first; nothing is loaded that the question does not need."),
    (
        "py",
        'base = fddbench.duckdb("results/smoke")\nbase.sql("""\n    SELECT detector, count(*) AS flights, '
        "count(*) FILTER (outcome = 'right') AS found, round(median(detection_time_s), 2) AS median_s\n"
        '    FROM rows WHERE n_faulty > 0 GROUP BY detector ORDER BY detector\n""").df()',
    ),
    ("md", "## Polars\n\nA table of Arrow goes over without a copy."),
    (
        "py",
        "import polars\nimport pyarrow\n\ntable = polars.from_arrow(pyarrow.Table.from_pandas(rows, preserve_index=False))\n"
        'table.filter(polars.col("outcome") == "wrong_site").group_by("scenario").len().sort("scenario").to_pandas()',
    ),
    ("md", "## One flight\n\nThe signals again, bit for bit, as a table of pandas."),
    (
        "py",
        'flight = fddbench.signals("results/smoke", "jam_b/0/0/3")\n'
        'fddbench.table_of(flight)[["time_s", "r_deg_s_1", "r_deg_s_2", "r_deg_s_3"]].iloc[398:403].round(3)',
    ),
]


def made():
    """The notebook, not executed."""
    book = nbformat.v4.new_notebook()
    kinds = {"md": nbformat.v4.new_markdown_cell, "py": nbformat.v4.new_code_cell}
    book.cells = [kinds[kind](text) for kind, text in CELLS]
    for number, cell in enumerate(book.cells):
        cell["id"] = f"cell-{number}"
    return book


def executed(book, folder):
    """The notebook, executed in a folder."""
    return NotebookClient(
        book, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(folder)}}
    ).execute()


if __name__ == "__main__":
    os.environ.setdefault("PYDEVD_DISABLE_FILE_VALIDATION", "1")
    with tempfile.TemporaryDirectory() as folder:
        book = executed(made(), folder)
    for cell in book.cells:
        cell.get("metadata", {}).pop("execution", None)
    nbformat.write(book, Path(__file__).with_name("study.ipynb"))
