"""Commands by which folders of results grow and are kept small."""

import argparse
import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["compact", "extend", "merge"]


def extend(args: argparse.Namespace) -> int:
    """Fly what a larger campaign has more than a folder of results holds.

    More runs, more detectors, or a campaign file that says more: values appended to the grid, scenarios, detectors, runs. Old
    rows keep their bytes; the table is that of the larger campaign. What would change an old row is refused.
    """
    from fddbench.api.extending import extend as extended
    from fddbench.cli.commands import told
    from fddbench.cli.progress import shown

    kept: list[tuple[pd.DataFrame, pd.DataFrame]] = []
    with shown(args.folder.name, quiet=args.quiet) as progress:
        report = extended(
            args.folder,
            args.campaign,
            runs=args.runs,
            detectors=args.detector,
            scenarios=args.scenario,
            jobs=args.jobs,
            backend=args.backend,
            engine=args.engine,
            address=args.dask_address or args.ray_address,
            progress=progress,
            notice=lambda text: print(f"fddbench: {text}", file=sys.stderr),
            summarised=lambda *tables: kept.append(tables),
        )
    return told(report, kept, wide=False)


def merge(args: argparse.Namespace) -> int:
    """Write the results of several folders into a new one.

    They hold parts of one campaign, or campaigns that differ in their runs, grid values, scenarios and detectors alone. Rows
    that two of them hold must be the same, bit for bit.
    """
    from fddbench.api.merging import merge as merged

    found = merged(args.folders, args.output)
    print(f"{args.output} holds {found.sentence}")
    print(
        f"next: fddbench {'run ' + str(args.output / 'campaign.yaml') + ' --out' if found.partial else 'report'} {args.output}"
    )
    return 0


def compact(args: argparse.Namespace) -> int:
    """Join the small files of a folder of results to few large ones; rows keep their bits.

    A run does it by itself when it ends, from 100,000 rows on. A folder that an earlier fddbench flew, or that grew, has it
    done by this.
    """
    from fddbench.api.compacting import compact as compacted

    found = compacted(args.folder)
    print(f"{args.folder} holds {found.rows} rows in {found.after} shards, before in {found.before}")
    return 0
