"""Completion in bash, zsh and fish: commands and options, campaigns, designs and folders of results."""

import argparse
from collections.abc import Callable
from pathlib import Path
from typing import Any

from fddbench import gallery

__all__ = ["SHELLS", "answer", "attach", "completion"]

SHELLS = ("bash", "zsh", "fish")


def completion(args: argparse.Namespace) -> int:
    """Print what a shell runs to complete fddbench.

    bash: eval "$(fddbench completion bash)" in ~/.bashrc; zsh: the same with zsh in ~/.zshrc, after compinit; fish: fddbench
    completion fish > ~/.config/fish/completions/fddbench.fish.
    """
    from argcomplete.shell_integration import shellcode

    print(shellcode(["fddbench"], shell=args.shell))
    return 0


def answer(parser: argparse.ArgumentParser) -> None:
    """Tell the shell that asks what may come next, and end."""
    import argcomplete

    argcomplete.autocomplete(parser, always_complete_options="long")


def attach(parser: argparse.ArgumentParser) -> None:
    """Give every argument that names a campaign, a design or a folder of results what completes it."""
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for sub in action.choices.values():
                attach(sub)
        elif action.dest in _COMPLETERS:
            action.completer = _COMPLETERS[action.dest]  # type: ignore[attr-defined]


def _campaigns(prefix: str, **more: Any) -> list[str]:
    """Shipped campaigns, and campaign files."""
    del more
    return _shipped("campaigns", prefix) + _paths(prefix, "*.yaml")


def _designs(prefix: str, **more: Any) -> list[str]:
    """Designs beside one and shipped."""
    del more
    own = [path.stem for path in Path("detectors").glob("*.yaml") if path.stem.startswith(prefix)]
    return sorted({*own, *_shipped("detectors", prefix)}) + _paths(prefix, "*.yaml")


def _results(prefix: str, **more: Any) -> list[str]:
    """Folders of results below results/, and any folder."""
    del more
    known = [str(path.parent) for path in Path("results").glob("*/provenance.json")]
    return [name for name in known if name.startswith(prefix)] + _paths(prefix, "")


def _subjects(prefix: str, **more: Any) -> list[str]:
    """What `fddbench list` lists."""
    del more
    from fddbench import kinds

    subjects = ("benchmarks", "faults", "voters", "detectors", "schedulings", "recipes", "campaigns", "designs")
    return [name for name in (*kinds.known("benchmark"), *subjects) if name.startswith(prefix)]


def _shipped(folder: str, prefix: str) -> list[str]:
    return sorted(path.stem for path in gallery.folder(folder).glob("*.yaml") if path.stem.startswith(prefix))


def _paths(prefix: str, pattern: str) -> list[str]:
    """Files of a pattern, or no files, and folders with a slash, that begin so."""
    folder = Path(prefix).parent if not prefix.endswith("/") else Path(prefix)
    inside = [path for path in folder.glob("*") if path.is_dir() or (pattern and path.match(pattern))]
    named = [f"{path}/" if path.is_dir() else str(path) for path in inside if not path.name.startswith(".")]
    return sorted(name for name in named if name.startswith(prefix))


_COMPLETERS: dict[str, Callable[..., list[str]]] = {
    "campaign": _campaigns,
    "campaigns": _campaigns,
    "design": _designs,
    "detector": _designs,
    "folder": _results,
    "folders": _results,
    "other": _results,
    "source": _results,
    "subject": _subjects,
}
