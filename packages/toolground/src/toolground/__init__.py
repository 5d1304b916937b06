"""The ground that tools stand on: errors that a user can mend, complete files, units, progress, command lines.

    from pathlib import Path
    from toolground import UserError, complete, factor

    with complete(Path("gains.txt")) as unfinished:  # there with all of its content, or not at all
        unfinished.write_text(f"{factor('km/h', 'm/s'):.6f}")
    try:
        factor("km/h", "N.m")
    except ValueError as error:
        print(error)

Nothing is imported before it is used. What stands in `__init__.pyi` is public.
"""

from .public_names import public_names

__getattr__, __dir__ = public_names(__name__, __file__)
