"""A campaign in shards for batch systems: plan it, fly one shard, write the job of SLURM."""

from collections.abc import Callable
from pathlib import Path
from shlex import quote

import numpy as np

from fddbench.campaign.meaning import Campaign
from fddbench.campaign.plan import plan as planned
from fddbench.gallery import folder as gallery_folder
from fddbench.runner.engines import Engine
from fddbench.runner.run import Progress, RunReport, run_campaign
from fddbench.runner.shares import Shares, campaign_of, plan_shares, shares_in

__all__ = ["fly_shard", "plan_shards", "slurm_job"]


def plan_shards(campaign: Campaign, shards: int, folder: str | Path) -> Shares:
    """Freeze a campaign into a folder, to be flown in shards by as many jobs.

    Parameters
    ----------
    campaign : Campaign
        As `fddbench.read` gives it.
    shards : int
        How many.
    folder : str or Path
        New folder that all jobs see; each shard becomes a folder of results in it.

    Raises
    ------
    FddbenchError
        Too few flights, or the folder holds something else.
    """
    return plan_shares(campaign, shards, Path(folder))


def fly_shard(
    number: int,
    folder: str | Path,
    *,
    jobs: int = 2,
    engine: str = "auto",
    progress: Callable[[Progress], None] | None = None,
    notice: Callable[[str], None] | None = None,
) -> RunReport:
    """Fly one shard of a planned campaign, or what an earlier job left of it; ``fddbench.merge`` makes one folder of all.

    Parameters
    ----------
    number : int
        Of the shard, from 1.
    folder : str or Path
        As planned.
    jobs, engine, progress, notice
        As of ``fddbench.run``.

    Raises
    ------
    FddbenchError
        No such shard, or this is another program than the one that planned it.
    """
    shares = shares_in(Path(folder))
    shares.require(number)
    campaign = campaign_of(shares)
    plan = planned(campaign)
    wanted = np.zeros((len(campaign.designs), plan.n_cases), dtype=bool)
    wanted[:, shares.cases(plan, number)] = True
    own = Engine(name=engine, jobs=jobs)
    return run_campaign(campaign, shares.folder_of(number), engine=own, wanted=wanted, progress=progress, notice=notice)


_JOB = """\
#!/bin/bash
# {name}: {flights} flights in {shards} shards. Where it is submitted:
#   {plan}
#   sbatch THIS_FILE
# and when all have ended:
#   fddbench merge {folder} --output {whole}
#SBATCH --job-name={name}
#SBATCH --array=1-{shards}
#SBATCH --cpus-per-task={jobs}
#SBATCH --time={time}
#SBATCH --output={log}
#SBATCH --open-mode=append
#SBATCH --requeue
#SBATCH --signal=B:TERM@120

cd "${{SLURM_SUBMIT_DIR:-.}}" || exit 2
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1

# two minutes before its time is over, or when it has to make room, a shard saves what is finished and asks for another turn
ended=0
trap 'ended=1; kill -TERM "$flying" 2>/dev/null' TERM
fddbench shard "$SLURM_ARRAY_TASK_ID" {folder} --jobs "${{SLURM_CPUS_PER_TASK:-{jobs}}}" --quiet &
flying=$!
wait "$flying"
code=$?
if [ "$ended" -eq 1 ]; then # the signal ended the waiting, not yet the shard
  wait "$flying"
  code=$?
fi
if [ "$code" -eq 143 ]; then
  scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_${{SLURM_ARRAY_TASK_ID}}"
fi
exit "$code"
"""


def slurm_job(
    campaign: Campaign, shards: int, folder: str | Path, *, jobs: int = 2, time: str = "04:00:00", plan: str = ""
) -> str:
    """Job array of SLURM that flies a campaign in shards: a text for ``sbatch``.

    A job that is ended by its time or by another one saves what is finished, is requeued and goes on.

    Parameters
    ----------
    campaign, shards, folder
        As of `plan_shards`.
    jobs : int
        Processors of each job.
    time : str
        Most that one takes, ``HH:MM:SS``.
    plan : str
        The command that plans it, for the comment at the top.
    """
    where = str(folder)
    shipped = campaign.path.is_relative_to(gallery_folder("campaigns"))
    source = campaign.path.stem if shipped else str(campaign.path)
    command = plan or f"fddbench plan {quote(source)} --shards {shards} --out {quote(where)}"
    return _JOB.format(
        name=campaign.name,
        flights=planned(campaign).n_cases,
        shards=shards,
        plan=command,
        folder=quote(where),
        whole=quote(f"{where}-whole"),
        jobs=jobs,
        time=time,
        log=f'"{where}/slurm-%a.log"' if " " in where else f"{where}/slurm-%a.log",
    )
