"""Compliance of FMUs, with a reason for each finding: archive, description, binary, behaviour; FMI 2.0 and 3.0.

    from pathlib import Path
    from fmucheck import check

    for verdict in check(Path("PiController.fmu"), quick=True):
        for problem in verdict.problems:
            print(f"{verdict.severity} [{verdict.rule}]: {problem} ({verdict.clause})")

An FMU is run in a process of its own, with limits of time and size. What stands in `__init__.pyi` is public.
"""

from toolground.public_names import public_names

__getattr__, __dir__ = public_names(__name__, __file__)
