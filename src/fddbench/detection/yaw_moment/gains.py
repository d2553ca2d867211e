"""Numbers of the yaw-moment filter, how well its equation and the sensors are known, and of the monitors that stand on it."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

__all__ = ["WatchGains", "YawMomentGains"]

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NonNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
Three = Annotated[tuple[NonNegative, ...], Field(min_length=3, max_length=3)]


class YawMomentGains(BaseModel):
    """Standard deviations that the filter believes in.

    Attributes
    ----------
    sensor_noise_deg_s : float
        White noise of each yaw-rate sensor, a sample [deg/s].
    sensor_bias_deg_s : float
        What stays in the mean of the sensors however many samples are averaged [deg/s]; makes the filter slower.
    rate_walk_deg_s_sqrt_s : float
        Walk of r beside its equation [deg/s per root second].
    acceleration_prior_deg_s2, acceleration_walk_deg_s2_sqrt_s : float
        Yaw acceleration b that the equation does not have: at the first sample [deg/s^2], and its walk.
    share_prior_ratio, share_walk_ratio_sqrt_s : three numbers
        Errors of the moments of sideslip, roll rate and surfaces, as shares of them [-]: at the first sample, and their walks.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    sensor_noise_deg_s: Positive
    sensor_bias_deg_s: NonNegative = 0.0
    rate_walk_deg_s_sqrt_s: NonNegative
    acceleration_prior_deg_s2: NonNegative
    acceleration_walk_deg_s2_sqrt_s: NonNegative
    share_prior_ratio: Three
    share_walk_ratio_sqrt_s: Three


class WatchGains(BaseModel):
    """What monitors of the innovations have in common.

    Attributes
    ----------
    filter : YawMomentGains
        What the filter believes.
    differ_deg_s : float
        Root mean square difference of two sensors that is none [deg/s].
    mean_s : float
        Time constant of mean squares [s].
    confirm_s : float
        How long a sensor must be suspected [s].
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    filter: YawMomentGains
    differ_deg_s: Positive
    mean_s: Positive
    confirm_s: NonNegative
