"""The metrics of a run and of a recorded drive, in SI units; NaN where one makes no sense, `absent` says why."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated

from .declaration import Column, Metric
from .notebook_table import NotebookTable

GearTorqueRms = Annotated[
    float,
    Metric(
        "N.m",
        "rms of the gear torque in the band of the drive train (5 to 50 Hz if it swings at 8), which wears the gear",
        Column("torque\nrms", "N.m", 1.0, 1),
    ),
]
JerkRms = Annotated[
    float,
    Metric(
        "m/s3",
        "rms of the jerk of the body in that band, which the passengers feel",
        Column("jerk\nrms", "m/s3", 1.0, 1),
    ),
]


@dataclass(frozen=True)
class Metrics(NotebookTable):
    """What a run is worth, in SI units; NaN where a metric makes no sense for it, and `absent` says why.

    Torques are those of the motor side. A swing is half of the peak to peak within 0.2 s. What the control adds is
    T_ref - T_driver, the demand delayed by the one sample that every controller needs. Rms and peak values are those
    from 0.2 s before a step to 4 s after it, in every other manoeuvre those of the whole record.
    """

    settling_time: Annotated[
        float,
        Metric("s", "time until the gear torque swings by less than 5 % of the step", Column("settling", "ms", 1e3, 0)),
    ]
    overshoot: Annotated[
        float,
        Metric(
            "1",
            "of the gear torque over the straight line of its final value, as share of its way",
            Column("over-\nshoot", "%", 1e2, 0),
        ),
    ]
    damping_ratio: Annotated[
        float,
        Metric(
            "1",
            "from the logarithmic decrement of the gear torque about that line; a rough figure",
            Column("damping\nratio", "1", 1.0, 2),
        ),
    ]
    gear_torque_rms: GearTorqueRms
    jerk_rms: JerkRms
    impact_speed: Annotated[
        float,
        Metric(
            "rad/s",
            "largest with which the teeth meet after the backlash, motor side",
            Column("impact\nspeed", "rad/s", 1.0, 1),
        ),
    ]
    impact_speed_90: Annotated[
        float,
        Metric(
            "rad/s",
            "which nine of ten impacts do not exceed: how the gear clatters over a drive",
            Column("nine of\nten", "rad/s", 1.0, 1),
        ),
    ]
    crossing_time: Annotated[
        float,
        Metric(
            "s",
            "longest from where the teeth part to where they meet for good, bounces included",
            Column("crossing", "ms", 1e3, 0),
        ),
    ]
    response_delay: Annotated[
        float,
        Metric(
            "s", "time until the gear torque has first made 90 % of its way", Column("delay\nto 90 %", "ms", 1e3, 0)
        ),
    ]
    withheld_time: Annotated[
        float,
        Metric(
            "s",
            "impulse kept from the driver in the 2 s after a step, over its height: a lag",
            Column("torque\nwithheld", "ms", 1e3, 1),
        ),
    ]
    stationary_torque_change: Annotated[
        float,
        Metric(
            "N.m",
            "mean torque that the control adds in the last 0.6 s, after 0.9 s of the same demand",
            Column("stat.\nchange", "N.m", 1.0, 2),
        ),
    ]
    jerk_rms_to_50_Hz: Annotated[float, Metric("m/s3", "rms of the jerk of the body up to 50 Hz")]
    added_torque_rms: Annotated[float, Metric("N.m", "rms of the torque that the control adds")]
    added_torque_peak: Annotated[float, Metric("N.m", "largest magnitude of the torque that the control adds")]
    gear_torque_peak: Annotated[float, Metric("N.m", "largest magnitude of the gear torque")]
    end_swing: Annotated[float, Metric("N.m", "largest swing of the gear torque in the last second")]
    plateau_swing: Annotated[
        float, Metric("N.m", "mean swing of the gear torque about a straight line at the ends of the demand's plateaus")
    ]
    absent: Mapping[str, str] = field(default_factory=dict)
    """Why metrics have no value, by their names."""


@dataclass(frozen=True)
class RideMetrics(NotebookTable):
    """The metrics of a recorded drive that was simulated."""

    gear_torque_rms: GearTorqueRms
    gear_damage: Annotated[
        float,
        Metric(
            "N5.m5",
            "fatigue by rainflow counting of the gear torque; only the ratio means something",
            Column("gear\ndamage", "(N.m)^5", 1.0, 0),
        ),
    ]
    jerk_rms: JerkRms
    speed_error_rms: Annotated[
        float, Metric("m/s", "rms of simulated less recorded speed", Column("speed\nerror", "km/h", 3.6, 2))
    ]
    absent: Mapping[str, str] = field(default_factory=dict)
    """Why metrics have no value, by their names."""
