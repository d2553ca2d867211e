"""Pages that are made of what is registered, when the site is built: they cannot fall behind."""

import inspect
import re
from pathlib import Path

import mkdocs_gen_files
import nbformat

import fddbench
from fddbench import gallery, kinds
from fddbench.api.asking import ask


def write(name, text):
    """A page of the site."""
    with mkdocs_gen_files.open(f"families/{name}.md", "w") as file:
        file.write(text)


def said(member):
    """Docstring of a member as Markdown: reStructuredText's literals, and the rest as it is."""
    text = inspect.getdoc(member) or getattr(member, "about", "") or ""
    return re.sub(r"``(.+?)``", r"`\1`", text)


def family(name, title, opening):
    """Page of a family: each registered member with what it says of itself and where it lies."""
    parts = [f"# {title}\n\n{opening}\n"]
    for each, point in kinds.registered(name).items():
        member = kinds.load(name, each)
        about = getattr(member, "about", "")
        place = point.value.split(":")[0].replace(".", "/")
        parts.append(f"\n## {each}\n\n{about}\n\n```text\n{said(member)}\n```\n\nSource: `src/{place}.py`\n")
    return "".join(parts)


def benchmarks():
    """Page of the benchmarks: what `fddbench list NAME` says."""
    parts = ["# Benchmarks\n\nWhat `fddbench list NAME` prints; each is a folder in `src/fddbench/benchmarks/`.\n"]
    parts += [f"\n## {name}\n\n```text\n{ask(name)}\n```\n" for name in kinds.known("benchmark")]
    return "".join(parts)


def choices():
    """Page of what a campaign chooses on each benchmark."""
    parts = [
        "# Voters, sensors, winds and other choices\n\nA key of the campaign chooses one; a file of your own goes as well.\n"
    ]
    for name in kinds.known("benchmark"):
        for key, choice in kinds.load("benchmark", name).choices.items():
            parts.append(f"\n## {name}: {key}\n\n")
            for each in choice.options:
                member = choice.options[each]
                lines = (choice.says.get(each) or said(member)).splitlines()
                parts.append(f"- `{each}`: {getattr(member, 'about', '') or ''.join(lines[:1])}\n")
    return "".join(parts)


def columns():
    """Page of the columns of every table."""
    parts = ["# Columns\n\nNull means none. `fddbench.columns(TABLE)` says the same.\n"]
    for table in ("rows", "events", "summary", "alarms", "detectable", "bounds", "operating"):
        lines = "\n".join(
            f"| `{name}` | {about.replace('|', '/')} |" for name, about in fddbench.columns(table).items()
        )
        parts.append(f"\n## {table}\n\n| column | meaning |\n|---|---|\n{lines}\n")
    return "".join(parts)


def campaigns():
    """Gallery: every shipped campaign with its question and, where it has one, its finding."""
    opening = (
        "Each opens with the question it answers. Findings are written from the rows; a test ties each to its campaign."
    )
    parts = [f"# Gallery of campaigns\n\n{opening}\n"]
    for path in sorted(gallery.folder("campaigns").glob("*.yaml")):
        question = path.read_text(encoding="utf-8").splitlines()[0].removeprefix("# ")
        parts.append(f"\n## {path.stem}\n\n{question}\n\n`fddbench run {path.stem}`\n")
        picture = Path(f"docs/pictures/{path.stem}.png")
        if picture.is_file():
            parts.append(f"\n![{path.stem}](../pictures/{picture.name})\n")
        finding = gallery.folder("reports") / path.stem / "finding.md"
        if finding.is_file():
            body = re.sub(r"^#", "###", finding.read_text(encoding="utf-8"), flags=re.MULTILINE)
            parts.append(f"\n{body}\n")
    return "".join(parts)


def study():
    """Page of the executed notebook."""
    parts = []
    for cell in nbformat.read(Path("docs/study.ipynb"), 4).cells:
        if cell.cell_type == "markdown":
            parts.append(f"{cell.source}\n\n")
            continue
        parts.append(f"```python\n{cell.source}\n```\n\n")
        for output in cell.outputs:
            text = output.get("data", {}).get("text/plain", "")
            parts.append(f"```text\n{text}\n```\n\n" if text else "")
    return "".join(parts)


def python():
    """Page of everything that `import fddbench` gives."""
    parts = ["# Python\n\nWhat commands do, functions do; `import fddbench` gives these.\n"]
    for name in sorted(fddbench.__all__):
        thing = getattr(fddbench, name)
        if callable(thing):
            shown = thing if hasattr(thing, "__qualname__") else type(thing)  # `report` is called and has pictures
            parts.append(f"\n::: {shown.__module__}.{shown.__qualname__}\n")
    return "".join(parts)


write("benchmarks", benchmarks())
write("choices", choices())
write("columns", columns())
write("gallery", campaigns())
write("study", study())
write("python", python())
write(
    "faults",
    family("fault", "Faults", "Kinds of faults. `fddbench list faults` names them; sizes carry the unit of the site."),
)
write(
    "detectors", family("detector", "Detectors", "Kinds of detectors; a design in `detectors/` gives one its numbers.")
)
write("recipes", family("recipe", "Recipes of designs", "What `fddbench design FILE` makes of a file with a recipe."))
write(
    "scheduling", family("scheduling", "Scheduling", "What makes the parameters of an LPV filter of measured signals.")
)
