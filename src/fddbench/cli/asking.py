"""Commands that tell what there is, and that give something to start from."""

import argparse
import sys

from fddbench.cli.requiring import write_ci
from fddbench.errors import FddbenchError

__all__ = ["init", "list_", "schema"]


def list_(args: argparse.Namespace) -> int:
    """List what campaigns can name: benchmarks, faults, voters, detectors, shipped campaigns and designs.

    The name of a benchmark shows all its names: plants, parameters, manoeuvres, fault sites, sensors, winds, signals, and the
    designs that fit.
    """
    from fddbench.api.asking import ask

    print(ask(args.subject))
    return 0


def init(args: argparse.Namespace) -> int:
    """Write files to start from: of your own or copies of the shipped ones.

    A detector, one that is trained, a benchmark, a fault or a campaign. `--benchmark recorded` writes logs and what maps them.

    What is there already is left alone. --ci writes a workflow of GitHub that judges what the campaigns in DIR require.
    """
    from fddbench.api.starting import STARTERS, copy_shipped, start

    if args.ci:
        return write_ci(args.folder)
    for what in STARTERS:
        name = getattr(args, what)
        if name is not None:
            written = start(args.folder, what, name)
            print(*written, sep="\n")
            first = f"python {args.folder / 'detectors' / f'train_{name}.py'}, then " if what == "trained" else ""
            print(f"next: {first}fddbench run {written[-1]}")
            return 0
    for path in copy_shipped(args.folder):
        print(path)
    return 0


def schema(args: argparse.Namespace) -> int:
    """Print the JSON schema of a campaign, so that an editor completes, explains and checks its keys.

    That of a benchmark (or of mine.py:Mine, a file in this folder) knows all its names, ranges and units; without one the keys
    of all benchmarks; `designs` is that of design files. An editor finds it by a comment in the campaign.
    """
    from fddbench.api.schemas import HEADER, schema_text

    text = schema_text(args.subject)
    if args.output is None:
        print(text, end="")
        return 0
    try:
        args.output.parent.mkdir(parents=True, exist_ok=True)
        args.output.write_text(text, encoding="utf-8")
    except OSError as error:
        raise FddbenchError(f"cannot write {args.output}: {error.strerror}; name another file with --output") from error
    print(args.output)
    print(f"next: a comment in files beside it, {HEADER}{args.output.name}", file=sys.stderr)
    return 0
