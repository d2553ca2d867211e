"""What the documentation says to type is typed, page by page, in a folder of its own; the site builds and is whole."""

import os
import re
import runpy
import subprocess
import sys
from pathlib import Path

import pytest
from tests.reporting.page.test_shipped import SHIPPED
from tests.runner.test_in_c import SHORT

import fddbench
from fddbench import gallery, kinds
from fddbench.cli.main import parser

ROOT = Path(__file__).parents[2]
PAGES = sorted(path.relative_to(ROOT).as_posix() for path in (ROOT / "docs").rglob("*.md"))
BLOCK = re.compile(r'^```(sh|python|yaml)(?: title="([^"]+)")?\n(.*?)^```', flags=re.MULTILINE | re.DOTALL)
NOT_HERE = {"make demo": "run by .ci/run", "make test": "is this run"}
"""Commands that no page test types, and why."""


def _blocks(page):
    return [(m[1], m[2], m[3]) for m in BLOCK.finditer((ROOT / page).read_text(encoding="utf-8"))]


def _commands(text):
    return [line for line in text.splitlines() if line.strip() and line.split("  #")[0].strip() not in NOT_HERE]


def _environment(folder):
    """The commands of this installation first, and nobody's cache of trust."""
    bin_ = folder / ".bin"
    bin_.mkdir()
    for name, code in (("fddbench", "from fddbench.cli import entry; entry()"), ("python", None)):
        run = f'exec "{sys.executable}" "$@"' if code is None else f'exec "{sys.executable}" -c "{code}" "$@"'
        (bin_ / name).write_text(f"#!/bin/sh\n{run}\n")
        (bin_ / name).chmod(0o755)
    return os.environ | {"PATH": f"{bin_}{os.pathsep}{os.environ['PATH']}", "NO_COLOR": "1"}


def _typed(page, folder):
    """Type a page: shell blocks one after the other in one shell's folder, Python blocks in one program each."""
    environment, here = _environment(folder), folder
    for language, title, text in _blocks(page):
        if language == "yaml":
            if title:
                (here / title).parent.mkdir(parents=True, exist_ok=True)
                (here / title).write_text(text, encoding="utf-8")
            continue
        if language == "sh":
            script = "set -e\n" + "\n".join(_commands(text)) + "\npwd > .where\n" + f'cp .where "{folder}/.last"\n'
            command = ["bash", "-c", script]
        else:
            command = [sys.executable, "-W", "error::DeprecationWarning:__main__", "-c", text]
        done = subprocess.run(command, cwd=here, env=environment, capture_output=True, text=True, timeout=600)
        assert done.returncode == 0, f"{page}:\n{text}\n{done.stdout[-2000:]}\n{done.stderr[-3000:]}"
        assert "Traceback" not in done.stderr
        if language == "sh":
            here = Path((folder / ".last").read_text().strip())


@pytest.mark.slow
@pytest.mark.parametrize("page", [*PAGES, "README.md", "CONTRIBUTING.md"])
def test_what_a_page_says_to_type_works(page, tmp_path):
    if page == "README.md":  # its Python looks at the results of a larger campaign
        fddbench.run("b747_monte_carlo", tmp_path / "results" / "b747_monte_carlo")
    _typed(page, tmp_path)


def test_every_command_is_typed_somewhere():
    typed = {line.split()[1] for _, _, block in _blocks("docs/commands.md") for line in block.splitlines() if line}
    (action,) = parser()._subparsers._group_actions
    assert set(action.choices) - typed == set()


def _of_readme():
    """Rows of the README's table: the commands of a row as they are written, and the whole row."""
    table = (ROOT / "README.md").read_text(encoding="utf-8").split("\n## Commands\n")[1].split("\nExit codes")[0]
    rows = [line for line in table.splitlines() if line.startswith("| `")]
    return [(re.findall(r"`fddbench (\w+[^`]*)`", row.replace(r"\|", "|")), row) for row in rows]


@pytest.mark.parametrize(("written", "row"), _of_readme(), ids=lambda one: one[0].split()[0] if one else None)
def test_the_options_in_the_table_of_the_readme_exist(written, row):
    """The options that stand anywhere in a row are options of its command, their words are among those that it takes."""
    (action,) = parser()._subparsers._group_actions
    assert written
    options = {}
    for text in written:
        options |= action.choices[text.split()[0]]._option_string_actions
        shown = set(re.findall(r"\[?(--[a-z-]+)", text))
        needed = {
            o.option_strings[-1] for o in action.choices[text.split()[0]]._actions if o.option_strings and o.required
        }
        assert needed <= shown, f"{text}: needs {needed - shown}"
        for option, value in re.findall(r"(--[a-z-]+) ([a-z]\w*)", text):
            assert value in (options[option].choices or [value])
    named = set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", row))
    assert named <= options.keys(), f"no such option: {named - options.keys()}"


def test_the_table_of_the_readme_has_every_command():
    (action,) = parser()._subparsers._group_actions
    assert {text.split()[0] for written, _ in _of_readme() for text in written} == set(action.choices)


def test_the_first_hour_has_at_most_fifteen_commands():
    lines = [
        line for language, _, text in _blocks("docs/first_hour.md") if language == "sh" for line in text.splitlines()
    ]
    assert len([line for line in lines if line.strip()]) <= 15


def test_contributing_says_which_campaigns_are_flown_whole_and_which_in_part():
    said = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8").split("Tests fly shipped campaigns in part.")[1]
    pages, in_c, _ = re.split(r"As exported C:|What they must show:", said.split("\n\n")[0])
    assert sorted(re.findall(r"`(\w+)`", pages)) == sorted(SHIPPED)
    assert re.findall(r"`(\w+)`", in_c) == ["smoke", *SHORT]


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
def test_the_notebook_says_what_it_said(tmp_path):
    """Executed anew, every output is the one that is kept: the numbers of a folder are the same on every machine."""
    import nbformat

    study = runpy.run_path(str(ROOT / "docs" / "study_make.py"))
    again = study["executed"](study["made"](), tmp_path)
    kept = nbformat.read(ROOT / "docs" / "study.ipynb", 4)
    assert [cell.source for cell in kept.cells] == [cell.source for cell in again.cells]
    for one, other in zip(kept.cells, again.cells, strict=True):
        here, there = ([o.get("data", {}).get("text/plain") for o in cell.get("outputs", [])] for cell in (one, other))
        assert here == there


@pytest.mark.slow
def test_the_site_builds_without_a_network_and_shows_every_member(tmp_path):
    quiet = {"NO_MKDOCS_2_WARNING": "1", "DISABLE_MKDOCS_2_WARNING": "true"}
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(tmp_path / "site")]
    done = subprocess.run(command, cwd=ROOT, env=os.environ | quiet, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr[-3000:]
    pages = {path.stem: path.read_text(encoding="utf-8") for path in (tmp_path / "site" / "families").glob("*.html")}
    for family, page in (
        ("benchmark", "benchmarks"),
        ("fault", "faults"),
        ("detector", "detectors"),
        ("recipe", "recipes"),
    ):
        for name in kinds.known(family):
            assert f'id="{name}"' in pages[page], f"{family} {name} stands on no page"
    for path in gallery.folder("campaigns").glob("*.yaml"):
        assert f'id="{path.stem}"' in pages["gallery"]
    for name in fddbench.__all__:
        assert name == "__version__" or name in pages["python"]
    fetched = re.findall(
        r'(?:src|href)="(https?://[^"]+)"[^>]*(?:rel="stylesheet"|></script>)', "".join(pages.values())
    )
    assert fetched == []
