"""The fingerprint of a campaign and of the program that flies it here, and the campaign that is frozen in a folder."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import nullcontext
from hashlib import sha256
from pathlib import Path
from typing import Any

from fddbench import sources
from fddbench.blocks import llvm
from fddbench.campaign.load import read_campaign
from fddbench.campaign.meaning import Campaign
from fddbench.campaign.plan import Plan
from fddbench.errors import FddbenchError, OtherProgramWarning, ResultsError, UntrustedError, warn
from fddbench.plugin_files import none_run
from fddbench.results import trust
from fddbench.results.fingerprint import Fingerprint, differences
from fddbench.results.folder import changed_files, provenance_of
from fddbench.results.kept import Kept
from fddbench.results.provenance import collect, version_of
from fddbench.results.schema import SCHEMA_VERSION
from fddbench.results.shards import file_sha256
from fddbench.results.stages import stages_in

__all__ = [
    "fingerprint_of",
    "frozen",
    "frozen_before",
    "frozen_to_fly",
    "kept_by",
    "other_program",
    "provenance_for",
    "trusted",
]

_REMEDY = "Run the campaign again on this folder: it puts the files back."


def fingerprint_of(campaign: Campaign) -> Fingerprint:
    """What decides the rows of a campaign that is flown by this process."""
    files = campaign.files()
    behind = sources.foreign(_members(campaign), files)
    # the compiler at hand, used or not: which of the two back ends flies is no part of any result
    bits = {"numpy": version_of("numpy"), "llvmlite": version_of("llvmlite") if llvm.available() else "none"}
    drawn = campaign.dispersions.monte_carlo
    if drawn is not None and not drawn.plain:
        bits["scipy"] = version_of("scipy")  # its low-discrepancy points and its bell curve
    return Fingerprint(
        campaign_sha256=campaign.sha256,
        files={name: sha256(text).hexdigest() for name, text in sorted(files.items()) if name != "campaign.yaml"},
        schema_version=SCHEMA_VERSION,
        fddbench=version_of("fddbench"),
        libraries=behind.versions | bits,
        source={**sources.own(), **behind.source},
    )


def _members(campaign: Campaign) -> Iterator[Any]:
    """Everything in a campaign whose class may be somebody else's."""
    yield from (campaign.bench, campaign.plant, *campaign.chosen.values())
    yield from (fault for scenario in campaign.scenarios for fault in scenario.faults)
    yield from (design.kind.member for design in campaign.designs)
    yield from (kind.member for design in campaign.designs for kind in design.members.values())


def provenance_for(plan: Plan, fingerprint: Fingerprint) -> dict[str, object]:
    """Provenance of a run of this case table that begins now."""
    campaign = plan.campaign
    notes: Any = getattr(plan.plant, "notes", None)
    logs = {} if notes is None else {"logs": notes(campaign.sample_s)}
    kept = kept_by(campaign) if plan.n_kept < plan.n_rows else None
    return (
        logs
        | (kept.plain() if kept else {})
        | collect(
            fingerprint,
            campaign=campaign.name,
            designs_sha256={design.name: design.sha256 for design in campaign.designs},
            seed=campaign.seed,
            flights={planned.name: planned.n_cases for planned in plan.scenarios},
            text=campaign.text.encode(),
        )
    )


def kept_by(campaign: Campaign) -> Kept | None:
    """Which rows a campaign keeps of any number of runs; None: all."""
    return None if campaign.keep == "all" else Kept(runs=campaign.kept_runs, failures=campaign.keep == "failures")


def frozen(folder: Path) -> Campaign:
    """Campaign of a folder of results, to be looked at or flown again for a picture.

    Warns
    -----
    OtherProgramWarning
        This is not the program that flew the results; their flights may differ from what is seen now.

    Raises
    ------
    ResultsError
        The frozen campaign, a design or a plug-in was changed or is gone, or cannot be read by this program.
    UntrustedError
        It stands on code that lies in the folder and was never flown from here.
    """
    campaign = _read(folder)
    other = other_program(folder, campaign)
    if other:
        warn(f"{folder} was flown by another program ({other}); flights may differ from its rows", OtherProgramWarning)
    return campaign


def frozen_before(folder: Path) -> Campaign:
    """Campaign of a folder that is to grow: of one whose growth was cut off before its campaign was frozen, the one before.

    Warns and raises as `frozen`.
    """
    provenance = provenance_of(folder)
    stages = stages_in(provenance)
    before = stages[-2].campaign_yaml_sha256 if len(stages) > 1 else None
    cut_off = changed_files(folder) == ["campaign.yaml"] and file_sha256(folder / "campaign.yaml") == before
    return _parsed(folder, provenance) if cut_off else frozen(folder)


def other_program(folder: Path, campaign: Campaign) -> str:
    """What differs between this program and the one that flew a folder of results, in words; "" for nothing."""
    here, there = fingerprint_of(campaign), Fingerprint.of(provenance_of(folder))
    if here.sha256 == there.sha256:
        return ""
    return "; ".join(differences(there, here))


def frozen_to_fly(folder: Path, fingerprint: str) -> Campaign:
    """Campaign of a folder of results, for a worker that writes rows of this fingerprint.

    Raises
    ------
    ResultsError
        The worker is another program than the one that gives out the work, or the folder was changed meanwhile.
    """
    campaign = _read(folder, flown=True)
    if fingerprint_of(campaign).sha256 != fingerprint:
        other = other_program(folder, campaign) or "the folder was claimed anew meanwhile"
        raise ResultsError(
            f"a worker of the run in {folder} is another program than its parent ({other}); run it again"
        )
    return campaign


def trusted(folder: Path) -> bool:
    """Whether the plug-ins of a folder of results, if it has any, may run here: they were flown from here."""
    files = provenance_of(folder)["files"]
    code = trust.code_digest(files)
    return not trust.unlisted(folder, files) and (not code or trust.is_known(code))


def _read(folder: Path, *, flown: bool = False) -> Campaign:
    """Campaign of the frozen files, once they are those that were written; only then is a plug-in among them run.

    A worker of a run (`flown`) runs what its parent was told to run.
    """
    provenance, changed = provenance_of(folder), changed_files(folder)
    if changed:
        raise ResultsError(f"{folder / changed[0]} is not the file of these results, or is gone. {_REMEDY}")
    return _parsed(folder, provenance, flown=flown)


def _parsed(folder: Path, provenance: Mapping[str, Any], *, flown: bool = False) -> Campaign:
    """Campaign of frozen files that are as they were written; a plug-in among them is run where it is trusted."""
    code = provenance["files"]
    runs = flown or (bool(trust.code_digest(code)) and trusted(folder))
    asked: list[str] = []
    try:
        with nullcontext(asked) if runs else none_run() as asked:
            return read_campaign(folder / "campaign.yaml")
    except FddbenchError as error:
        if asked:
            raise UntrustedError(_untrusted(folder, asked)) from None
        written, here = provenance["fddbench"], version_of("fddbench")
        cure = _REMEDY if written == here else f"Read it with fddbench {written}, this is {here}."
        raise ResultsError(f"the campaign frozen in {folder} cannot be read any more:\n{error}\n{cure}") from error


def _untrusted(folder: Path, asked: Sequence[str]) -> str:
    names = list(dict.fromkeys(asked))
    return (
        f"{folder} brings code that was never flown from here and is not run: {', '.join(names)}. Read it; if it may run "
        "with your rights, repeat the command with --trust (in Python: fddbench.trust(folder))"
    )
