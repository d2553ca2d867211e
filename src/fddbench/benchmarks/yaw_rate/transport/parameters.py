"""What differs from flight to flight with six degrees of freedom: deltas in all axes."""

from fddbench.benchmarks.yaw_rate.parameters import PARAMETERS as LATERAL
from fddbench.benchmarks.yaw_rate.parameters import gust_rotation
from fddbench.interfaces import Parameter

__all__ = ["PARAMETERS"]

PARAMETERS: tuple[Parameter, ...] = (
    *(gust_rotation(1.0) if parameter.name == "gust_rotation_ratio" else parameter for parameter in LATERAL),
    *(
        Parameter(name=name, about=f"steady wind {where} of the trimmed flight", default=0.0, low=-150.0, high=150.0)
        for name, where in (("tail_wind_kt", "from behind"), ("cross_wind_kt", "from the left"))
    ),
    Parameter(
        name="gust_gradient_m",
        about="distance from the beginning of the one-minus-cosine gust to its peak",
        default=107.0,
        low=9.0,
        high=107.0,
    ),
    *(
        Parameter(
            name=f"delta_c_{axis}_percent",
            about=f"change of the total {what} in body axes; detectors and law keep 0",
            default=0.0,
            low=-50.0,
            high=50.0,
        )
        for axis, what in (("x", "axial force C_X"), ("z", "normal force C_Z"), ("m", "pitching moment C_m"))
    ),
)
