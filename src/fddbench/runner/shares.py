"""A campaign in shards that fly by themselves, each into a folder of its own: for batch systems."""

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from fddbench.campaign.meaning import Campaign
from fddbench.campaign.plan import Plan
from fddbench.campaign.plan import plan as planned
from fddbench.errors import FddbenchError, ResultsError
from fddbench.results.folder import claim
from fddbench.results.shards import write_bytes
from fddbench.runner.chunks import COMPILED_CHUNK, cut
from fddbench.runner.fingerprint import fingerprint_of, frozen, other_program, provenance_for

__all__ = ["Shares", "campaign_of", "is_planned", "plan_shares", "share_folders", "shares_in"]

_PLAN, _CAMPAIGN = "plan.json", "campaign"


@dataclass(frozen=True)
class Shares:
    """A campaign that is flown in so many shards, numbered from 1.

    Attributes
    ----------
    folder : Path
        Holds the frozen campaign and the folders of results of the shards.
    count : int
        Number of shards.
    """

    folder: Path
    count: int

    def folder_of(self, number: int) -> Path:
        """Folder of results of a shard."""
        return self.folder / f"shard-{number:04d}"

    def cases(self, plan: Plan, number: int) -> npt.NDArray[np.int64]:
        """Flights of a shard: those that share a healthy twin together, every shard about as long as the others."""
        return np.concatenate([np.empty(0, np.int64), *_chunks(plan, self.count)[number - 1 :: self.count]])

    def require(self, number: int) -> None:
        """Refuse a shard that there is not.

        Raises
        ------
        FddbenchError
            It is none of 1 ... count.
        """
        if not 1 <= number <= self.count:
            raise FddbenchError(f"{self.folder} is planned in shards 1 to {self.count}, there is no shard {number}")


def plan_shares(campaign: Campaign, count: int, folder: Path) -> Shares:
    """Freeze a campaign into a folder that is to be flown in shards; done once more it changes nothing.

    Raises
    ------
    FddbenchError
        There are too few flights for so many shards, or the folder is planned otherwise or holds something else.
    """
    plan, own = planned(campaign), Shares(folder, count)
    most = len(_chunks(plan, count))
    if most < count:
        raise FddbenchError(
            f"campaign {campaign.name!r} has {plan.n_cases} flights, too few for {count} shards: ask for at most {most}"
        )
    if is_planned(folder):
        before = shares_in(folder).count
        if before != count:
            raise ResultsError(f"{folder} is planned in {before} shards, not {count}; name another folder with --out")
    elif folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise ResultsError(f"{folder} holds something else than a plan; name another folder with --out")
    place = folder / _CAMPAIGN
    place.mkdir(parents=True, exist_ok=True)
    claim(place, files=campaign.files(), provenance=provenance_for(plan, fingerprint_of(campaign)), fresh=False)
    write_bytes(folder / _PLAN, json.dumps({"shards": count}).encode())  # last: with it the plan is whole
    return own


def is_planned(folder: Path) -> bool:
    """Whether a folder is planned in shards."""
    return (folder / _PLAN).is_file()


def shares_in(folder: Path) -> Shares:
    """Shards of a folder.

    Raises
    ------
    ResultsError
        It is not planned.
    """
    try:
        count = json.loads((folder / _PLAN).read_bytes())["shards"]
    except OSError as error:
        raise ResultsError(
            f"{folder} is not planned in shards ({_PLAN}: {error.strerror}); fddbench plan CAMPAIGN --shards N --out {folder}"
        ) from error
    except (ValueError, KeyError, TypeError) as error:
        raise ResultsError(f"{folder / _PLAN} is not as it was written; plan into another folder") from error
    if type(count) is not int or count < 1:
        raise ResultsError(f"{folder / _PLAN} is not as it was written; plan into another folder")
    return Shares(folder, count)


def campaign_of(shares: Shares) -> Campaign:
    """Frozen campaign of a plan, for who flies a shard of it.

    Raises
    ------
    ResultsError
        It was changed, or planned by another program than this one, whose shards would not belong together.
    """
    place = shares.folder / _CAMPAIGN
    campaign = frozen(place)
    other = other_program(place, campaign)
    if other:
        raise ResultsError(f"{shares.folder} was planned by another program: {other}. Plan it anew into another folder")
    return campaign


def share_folders(folder: Path) -> list[Path]:
    """Folders of results of the shards that were begun."""
    shares = shares_in(folder)
    paths = [shares.folder_of(number) for number in range(1, shares.count + 1)]
    return [path for path in paths if (path / "manifest.jsonl").is_file() and (path / "manifest.jsonl").stat().st_size]


def _chunks(plan: Plan, count: int) -> list[npt.NDArray[np.int64]]:
    return cut(plan, np.arange(plan.n_cases), size=COMPILED_CHUNK, jobs=count)
