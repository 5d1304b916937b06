"""Parts of a controller in which some parameters are no longer to be set, but have a value for good."""

from collections.abc import Callable, Mapping
from types import SimpleNamespace
from typing import Any, TypeVar, cast

from fmublocks.block.declaration import with_defaults, without

from ..controller.interfaces import Estimator, Law, Part

NOT_LEARNED = {"phi_B_0": 0.0, "L_phi_B": 0.0, "gap_bias": 0.0, "gap_torque": 1.0, "t_cross": 1.0}
"""The gap stays the declared one."""

SomePart = TypeVar("SomePart", bound=Part)


def fixed(part: SomePart, defaults: Mapping[str, float] | None = None, /, **values: float) -> SomePart:
    """The estimator or law with these values in the place of the parameters.

    Args:
        defaults: other start values of the parameters that remain.
    """
    functions = {name: getattr(part, name) for name in (*dir(Estimator), *dir(Law)) if _is_function(part, name)}
    namespace = SimpleNamespace(
        Parameters=with_defaults(without(part.Parameters, values), defaults or {}),
        **{name: _with(values, function) for name, function in functions.items()},
    )
    return cast(SomePart, namespace)


def _is_function(part: object, name: str) -> bool:
    return not name.startswith("_") and name != "Parameters" and hasattr(part, name)


def _with(values: Mapping[str, float], function: Callable[..., Any]) -> Callable[..., Any]:
    """The function, whose last argument are the parameters, with these values among them."""
    return lambda *arguments: function(*arguments[:-1], SimpleNamespace(**{**arguments[-1]._asdict(), **values}))
