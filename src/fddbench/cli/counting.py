"""Commands that count: tables for papers, and comparisons."""

import argparse
import sys

from fddbench.errors import FddbenchError

__all__ = ["FORMATS", "compare", "table"]

FORMATS = ("csv", "parquet", "latex", "markdown", "html")


def compare(args: argparse.Namespace) -> int:
    """Compare two folders of results, or two detectors of one, flight by flight.

    Shares by McNemar's exact test, detection times by a sign test, both by run and adjusted after Holm. With --require it ends
    with 1 when that measure got worse in a scenario.
    """
    from fddbench.api.comparing import compare as compared
    from fddbench.api.comparing import got_worse
    from fddbench.reporting.comparison import comparison_text

    found = compared(args.folder, args.other, args.detector)
    worse = got_worse(found, args.require)
    print(comparison_text(found))
    if worse.empty:
        return 0
    for line in worse.to_dict("records"):
        what = f"{line['measure']} of {line['detector_b']} in {line['scenario']}"
        print(f"fddbench: got worse: {what}, {line['a']:.4g} to {line['b']:.4g}", file=sys.stderr)
    return 1


def table(args: argparse.Namespace) -> int:
    """Print the summary of a folder of results as a table for a paper or another program.

    One line per scenario and detector, and per value of the columns named with --by (numbers of many values in five parts). csv
    and parquet hold every column; latex, markdown and html those that a paper prints.
    """
    from fddbench.api.summaries import written

    if args.format == "parquet" and args.output is None:
        raise FddbenchError("parquet is no text: name a file with --output")
    content = written(args.folder, args.format, by=args.by)
    if args.output is None:
        sys.stdout.write(content.decode())
        return 0
    try:
        args.output.write_bytes(content)
    except OSError as error:
        raise FddbenchError(f"cannot write {args.output}: {error.strerror}; name another file with --output") from error
    print(args.output)
    return 0
