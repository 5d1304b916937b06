"""The request of a tab, as data, and the parameters that a loop gets for it."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field

from ...fmus.building.one_car import differences, updated
from ..cosimulation.parameter_changes import parted

SPORT: Mapping[str, float] = {"k_d": 0.88, "omega_w": 1.4, "T_gap": 1.7, "t_return": 0.5}
COMFORT: Mapping[str, float] = {"k_d": 1.2, "omega_w": 0.75, "T_gap": 0.6, "t_return": 2.0}
"""Factors on gains at both ends of the character; docs/explorer.md says what they do."""


@dataclass(frozen=True)
class Request:
    """What a tab shows.

    Attributes:
    plant, manoeuvre: by name.
    control: whether the run with our controller is shown.
    others: controllers that are shown beside it, by name.
    car: entries of a vehicle file that were changed.
    gains: entries of a file of parameters that were changed.
    character: from 0, sport, to 1, comfort; the gains as they are at 0.5.
    informed: whether the controllers know the car as it is, and not as it was at the start.
    typed: `instance.name`, or `instance.name@t` from t s on, -> value, which stands above all.
    """

    plant: str
    manoeuvre: str
    control: bool = True
    others: tuple[str, ...] = ()
    car: Mapping[str, float] = field(default_factory=dict)
    gains: Mapping[str, float] = field(default_factory=dict)
    character: float = 0.5
    informed: bool = True
    typed: Mapping[str, float] = field(default_factory=dict)


def characterised(gains: Mapping[str, float], character: float) -> dict[str, float]:
    """Gains for a character: unchanged at 0.5, times the factors of SPORT at 0 and of COMFORT at 1."""
    end, share = (COMFORT, 2.0 * character - 1.0) if character > 0.5 else (SPORT, 1.0 - 2.0 * character)
    return {name: value * end.get(name, 1.0) ** share for name, value in gains.items()}


def parameters(
    request: Request,
    names: Mapping[str, Collection[str]],
    given: Mapping[str, float],
    gains: Mapping[str, float],
    of_car: Mapping[str, float] | None = None,
) -> dict[str, float]:
    """`instance.name` -> value for a loop.

    Args:
        names: of the parameters of each instance.
        given: what files and options say.
        of_car: entries of the vehicle file that is in it.
        gains: of the controller; none for one that the gains are not of.

    Raises:
        ParameterFileError: there is no such car.
    """
    known = of_car or {}
    turned = differences(known, updated(known, request.car), set().union(*names.values()))
    car = {
        f"{instance}.{name}": value
        for instance, has in names.items()
        for name, value in turned.items()
        if name in has and (request.informed or instance != "controller")
    }
    own = {f"controller.{name}": value for name, value in gains.items() if name in names["controller"]}
    typed = {key: value for key, value in request.typed.items() if _has(names, key)}
    return {**given, **car, **own, **typed}


def _has(names: Mapping[str, Collection[str]], key: str) -> bool:
    """Whether a loop has a parameter; one that only another plant or controller has is of no account for it."""
    instance, _, name = parted(key)[0].partition(".")
    return name in names.get(instance, ())
