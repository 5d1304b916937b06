"""Many cases in one test, which is collected and set up once; all that fail are told together."""

import inspect
from collections.abc import Callable, Iterable
from functools import wraps
from typing import Any

import pytest


def together(names: str, cases: Iterable[Any]) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Like `pytest.mark.parametrize`, but the cases run one after the other in one test. Fixtures are made once for
    all of them, so what `monkeypatch` sets stays for the next; each case has a `tmp_path` of its own.

    Args:
        names: of the arguments that a case gives, with commas between them.
        cases: a value each, or a tuple of as many as there are names.
    """
    argument_names, cases = [name.strip() for name in names.split(",")], list(cases)

    def decorate(test: Callable[..., None]) -> Callable[..., None]:
        parameters = inspect.signature(test).parameters.values()

        @wraps(test)
        def all_cases(**fixtures: Any) -> None:
            failures: list[str] = []
            first: BaseException | None = None
            for k, case in enumerate(cases):
                values = dict(zip(argument_names, case if len(argument_names) > 1 else (case,), strict=True))
                if "tmp_path" in fixtures:
                    values["tmp_path"] = fixtures["tmp_path"] / str(k)
                    values["tmp_path"].mkdir()
                try:
                    test(**fixtures | values)
                except (Exception, pytest.fail.Exception) as error:
                    failures.append(f"{case!r:.200}: {type(error).__name__}: {error}")
                    first = first or error
            if failures:
                raise AssertionError(f"{len(failures)} of {len(cases)} cases:\n" + "\n".join(failures)) from first

        all_cases.__signature__ = inspect.Signature([p for p in parameters if p.name not in argument_names])  # type: ignore[attr-defined]
        return all_cases

    return decorate
