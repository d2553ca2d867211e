"""Commands that look at single flights of a folder of results."""

import argparse
import sys

from fddbench.cli.outputs import require_writable
from fddbench.errors import FddbenchError

__all__ = ["replay", "verify", "worst"]


def replay(args: argparse.Namespace) -> int:
    """Fly one flight again, bit for bit, and show what happened in it.

    Prints onset and declarations; --plot draws the signals, what each detector shows, and both; --to writes all signals at
    every sample, with their units in their names.
    """
    from fddbench.api.replaying import replay as fly
    from fddbench.api.replaying import shown_in, write_table
    from fddbench.reporting.declarations import declarations
    from fddbench.reporting.flight_picture import write_picture

    _require_outputs(args)
    if "/" not in args.case:
        raise FddbenchError(f"a flight is named as in the column case, jam_a/3/0/17, got {args.case!r}")
    recording = fly(args.source, args.case, args.detector)
    onset = "healthy" if recording.onset_s is None else f"onset {float(recording.onset_s[0]):g} s"
    if args.plot:
        write_picture(recording, args.plot, args.signal or shown_in(args.source))
    if args.to:
        write_table(recording, args.to)
    print(f"flight {recording.cases[0]}: {onset}, {len(recording.time_s)} samples")
    for detector, time_s, sites, alarm in declarations(recording):
        print(f"  {time_s:9.2f} s  {detector} declares {sites or ('alarm' if alarm else 'nothing any more')}")
    ended = {name: reasons[0] for name, reasons in recording.errors.items() if reasons[0]}
    for detector, reason in ended.items():
        print(f"  {detector} did not come to its end: {reason}")
    silent = set(recording.detectors) - {name for name, *_ in declarations(recording)} - set(ended)
    if silent:
        print(f"  {', '.join(name for name in recording.detectors if name in silent)}: nothing")
    for path in filter(None, (args.plot, args.to)):
        print(path)
    return 0


def _require_outputs(args: argparse.Namespace) -> None:
    """Refuse files that could not be written, before anything flies."""
    from fddbench.api.replaying import require_format
    from fddbench.reporting.flight_picture import require_picture

    if args.signal and not args.plot:
        raise FddbenchError("--signal names what --plot FILE draws; give both")
    for path, option, require in ((args.plot, "--plot", require_picture), (args.to, "--to", require_format)):
        if path:
            require(path)
            require_writable(path, option)
            if not path.parent.exists():
                raise FddbenchError(
                    f"cannot write {path}: there is no folder {path.parent}; make it, or name another file with {option}"
                )


def worst(args: argparse.Namespace) -> int:
    """List the flights to look at: in every scenario and for every detector those that went worst, with what went wrong.

    First flights without a score, then healthy sites declared, missed and late faults, false alarms; then the slowest
    detection and the largest healthy margin.
    """
    from fddbench.api.worst import worst as found

    table = found(args.folder, args.detector, most=args.most)
    if table.empty:
        print("nothing to look at: no flight was flown")
        return 0
    widths = {
        name: max(len(name), *(len(str(value)) for value in table[name])) for name in ("case", "detector", "what")
    }
    print("  ".join(name.ljust(width) for name, width in widths.items()))
    for line in table.to_dict("records"):
        print("  ".join(str(line[name]).ljust(width) for name, width in widths.items()).rstrip())
    print(f"\nnext: fddbench replay {args.folder} {table['case'].iloc[0]} --plot flight.html")
    return 0


def verify(args: argparse.Namespace) -> int:
    """Check a folder of results, your own or somebody else's: every file, every line, every checksum.

    With --refly some of its flights are flown again, drawn at random, and compared bit for bit; that runs the plug-ins that lie
    in it. Ends with 1 when something is wrong. Nothing is written.
    """
    from fddbench.api.verifying import verify as verified

    if args.seed is not None and not args.refly:
        raise FddbenchError("--seed is of the draw of the flights that --refly N flies again; give both")
    found = verified(
        args.folder, refly=args.refly, seed=args.seed, notice=lambda text: print(f"fddbench: {text}", file=sys.stderr)
    )
    for text in (*found.wrong, *found.different):
        print(text)
    if found.wrong and args.refly:
        print("nothing was flown again: mend the folder first")
    if found.flights:
        who = f"; flown by another program: {found.other_program}" if found.other_program else ""
        print(f"{found.flights} flights flown again, {found.rows} rows, {len(found.different)} otherwise{who}")
    if found.sound:
        print(f"{args.folder} is sound and whole")
    return 0 if found.sound else 1
