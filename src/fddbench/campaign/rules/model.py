"""The keys of a campaign file and what values they take."""

from functools import cache
from typing import Annotated, Any, Literal, get_type_hints

from pydantic import BaseModel, Field, create_model

from fddbench.campaign.rules.dispersions import Dispersions
from fddbench.campaign.rules.keys import NAME_PATTERN, Count, Name, Number, Positive, Seed, Strict
from fddbench.campaign.rules.swept import DetectorEntry, names_of
from fddbench.errors import FddbenchError

__all__ = [
    "NAME_PATTERN",
    "CampaignFile",
    "Name",
    "Purpose",
    "ReportEntry",
    "RequirementEntry",
    "ScenarioEntry",
    "Seed",
    "Strict",
    "campaign_file",
]

LONGEST_FLIGHT_S = 86_400.0
MOST_FAULTS = 8

Duration = Annotated[float, Field(gt=0.0, le=LONGEST_FLIGHT_S)]
Purpose = Literal["tuning", "evaluation"]
Keep = Literal["all", "failures", "sample"]


class ScenarioEntry(Strict):
    """A manoeuvre and the faults injected in it.

    Attributes
    ----------
    name : str
        Its name in the table of results.
    manoeuvre : str
        What is flown, by the names of the benchmark.
    faults : list of mappings
        What breaks, each with its kind; none: a healthy flight.
    runs : int
        Instead of ``dispersions.monte_carlo.runs``.
    duration_s, detection_time_limit_s : float
        Instead of what the benchmark says [s].
    """

    name: Name
    manoeuvre: str
    faults: Annotated[tuple[dict[str, Any], ...], Field(max_length=MOST_FAULTS)] = ()
    runs: Count | None = None
    duration_s: Duration | None = None
    detection_time_limit_s: Positive | None = None


class ReportEntry(Strict):
    """What the report shows beside what it always shows; decides no row.

    Attributes
    ----------
    bands : bool
        The signals of all flights as quantiles over time, scenario by scenario, and what the aircraft was asked for: every
        flight is flown again.
    published : tuple of str
        Printed tables to stand beside the results, instead of that of the benchmark.
    scenarios : tuple of str
        Pictures of signals over time of these only; of all where there are none.
    """

    bands: bool = False
    published: tuple[Name, ...] = ()
    scenarios: tuple[Name, ...] = ()


class RequirementEntry(Strict):
    """What a detector must do, judged by the flights: pass, fail or undecided; decides no row.

    Attributes
    ----------
    name : str
        How the verdict is called; made of the other keys where there is none.
    of : str
        What is counted: a share of the flights, a rate [1/h] of distinct flights, or a time over its limit.
    at_least : float
        Least share, 0 to 1; of right_share.
    at_most : float
        Largest share, rate per hour or time over its limit; of all others.
    share : float
        Share of the flights that must keep the time, 0 to 1; of normalized_detection_time.
    scenarios : tuple of str
        Names or patterns such as "jam_*" of the scenarios that count, pooled; all that fit the measure where there are none.
    detectors : tuple of str
        Names or patterns of the detectors that are judged, each by itself; all where there are none.
    per : str
        Judge one by one: each scenario, or each value of a parameter of grid or sequence.
    confidence : float
        One less the probability of a false pass, and of a false fail, however often one looks.
    """

    name: Name | None = None
    of: Literal[
        "right_share", "wrong_site_share", "normalized_detection_time", "false_alarm_share", "false_alarms_per_hour"
    ]
    at_least: Number | None = None
    at_most: Number | None = None
    share: Annotated[float, Field(gt=0.0, lt=1.0)] | None = None
    scenarios: tuple[str, ...] = ()
    detectors: tuple[str, ...] = ()
    per: str | None = None
    confidence: Annotated[float, Field(ge=0.5, lt=1.0)] = 0.95


class CampaignFile(Strict):
    """A campaign as it is written; `campaign_file` adds the choices of its benchmark.

    Attributes
    ----------
    name : str
        Its name; the folder of results is called so.
    about : str
        The question it answers; decides no row.
    benchmark : str
        What is flown on, by its name or as a file beside the campaign, ``mine.py:Mine``.
    purpose : {"evaluation", "tuning"}
        Tuning and evaluation never share a flight.
    seed : int
        Key of all random numbers, 0 to 2^64 - 1.
    sample_s : float
        Clock of sensors, detectors and scoring [s].
    substeps : int
        Integration steps in a sample.
    duration_s : float
        Length of every flight [s]; a scenario may say otherwise.
    scenarios : list of ScenarioEntry
        Manoeuvres, each with the faults injected in it.
    dispersions : Dispersions
        What differs from flight to flight.
    detectors : tuple of str or SweptDesign
        Names of designs, files in ``detectors/``; or a design and gains to sweep, ``{design: NAME, sweep: {KEY: [1, 2]}}``.
    reconfigure : str
        One of these detectors, if the aircraft is to act on what it declares: at every sample on its declarations of the
        sample before. Nobody else's declarations, and no other detector in the list, have a part in the flight.
    symbols : str or list of symbols
        Library of operations that every detector must keep to, see `fddbench.exported.symbols`; decides no row.
    report : mapping
        What else the report shows.
    requirements : list of RequirementEntry
        What detectors must do; ``fddbench run --require`` ends with 1 where it is not shown.
    keep : {"all", "failures", "sample"}
        Which rows are kept. All rows are counted; ``sample`` keeps those of the first runs and rows that ended in an error,
        ``failures`` besides those that are a false alarm, a wrong site, late or missed.
    kept_runs : int
        How many runs of every scenario are kept whole by ``failures`` and ``sample``: a campaign by themselves.
    """

    name: Name
    about: str = ""
    benchmark: str
    purpose: Purpose = "evaluation"
    seed: Seed
    sample_s: Annotated[float, Field(ge=1e-4, le=0.1)] = 0.01
    substeps: Annotated[int, Field(ge=1, le=1000)] = 1
    duration_s: Duration | None = None
    scenarios: Annotated[tuple[ScenarioEntry, ...], Field(min_length=1)]
    dispersions: Dispersions = Dispersions()
    detectors: Annotated[tuple[DetectorEntry, ...], Field(min_length=1)]
    reconfigure: Name | None = None
    symbols: str | list[str | dict[str, Annotated[int, Field(ge=1)]]] | None = None
    report: ReportEntry = ReportEntry()
    requirements: tuple[RequirementEntry, ...] = ()
    keep: Keep = "all"
    kept_runs: Count = 100

    @property
    def detector_names(self) -> tuple[str, ...]:
        """Names of all its detectors, in order."""
        return names_of(self.detectors)


@cache
def campaign_file(choices: tuple[str, ...]) -> type[CampaignFile]:
    """Keys of a campaign on a benchmark with these choices (``plant``, ``voter``, …), each a name.

    Raises
    ------
    FddbenchError
        A choice is called as a key that every campaign has.
    """
    taken = [key for key in choices if key in CampaignFile.model_fields or not key.isidentifier()]
    if taken:
        raise FddbenchError(
            f"a benchmark cannot offer the choices {taken}: campaigns have keys of that name; rename them"
        )
    fields: Any = dict.fromkeys(choices, (str | None, None))
    return create_model("CampaignFile", __base__=CampaignFile, __doc__=CampaignFile.__doc__, **fields)


def extra_hint(model: type[BaseModel]) -> Any:
    """Annotation of the values of keys that a model does not name, or None."""
    hint = get_type_hints(model).get("__pydantic_extra__")
    return getattr(hint, "__args__", (None, None))[1] if model.model_config.get("extra") == "allow" else None
