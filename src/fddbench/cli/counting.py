"""Commands that count: tables for papers, and comparisons."""

import argparse
import sys

from fddbench.errors import FddbenchError

__all__ = ["FORMATS", "compare", "pod", "table"]

FORMATS = ("csv", "parquet", "latex", "markdown", "html")


def compare(args: argparse.Namespace) -> int:
    """Compare two folders of results, or two detectors of one, flight by flight.

    Shares by McNemar's exact test, detection times by a sign test, both by run and adjusted after Holm. With --require it ends
    with 1 when that measure got worse in a scenario, or, stated, what the campaign of A requires.
    """
    from fddbench.api.comparing import compare as compared
    from fddbench.api.comparing import got_worse
    from fddbench.api.requiring import stated
    from fddbench.reporting.comparison import comparison_text

    found = compared(args.folder, args.other, args.detector)
    own = stated(args.folder) if "stated" in args.require else []
    worse = got_worse(found, [name for name in args.require if name != "stated"], own)
    print(comparison_text(found))
    if worse.empty:
        return 0
    for line in worse.to_dict("records"):
        what = f"{line['measure']} of {line['detector_b']} in {line['scenario']}"
        print(f"fddbench: got worse: {what}, {line['a']:.4g} to {line['b']:.4g}", file=sys.stderr)
    return 1


def pod(args: argparse.Namespace) -> int:
    """Print the probability of detection against the size of a fault: the sizes found in 50 and in 90 % of flights.

    A curve for every scenario and detector whose fault has a size that is drawn or swept, with a floor and a ceiling where the
    flights want them, and the upper end of the size at 90 % at 95 % confidence, by run.
    """
    from fddbench.api.detection_curves import pod as curves

    lines = curves(args.folder, args.size).to_dict("records")
    cells = [("scenario", "detector", "size", "flights", "found", "")]
    cells += [
        (line["scenario"], line["detector"], line["size"], str(line["flights"]), str(line["right"]), line["about"])
        for line in lines
    ]
    widths = [max(len(str(row[i])) for row in cells) for i in range(len(cells[0]))]
    for row in cells:
        print("  ".join(str(value).ljust(width) for value, width in zip(row, widths, strict=True)).rstrip())
    return 0


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
