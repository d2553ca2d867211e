"""Values that keys of campaign and design files take, and the strictness of all their blocks."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

__all__ = ["NAME_PATTERN", "Count", "Name", "Number", "Positive", "Seed", "Strict", "Values"]

NAME_PATTERN = "^[A-Za-z0-9][A-Za-z0-9._-]{0,63}$"

Name = Annotated[str, Field(pattern=NAME_PATTERN)]
Number = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
Count = Annotated[int, Field(ge=1)]
Seed = Annotated[int, Field(ge=0, le=2**64 - 1)]
Values = Annotated[tuple[Number, ...], Field(min_length=1)]


class Strict(BaseModel):
    """Refuses unknown keys, and words where numbers belong."""

    model_config = ConfigDict(extra="forbid", frozen=True)
