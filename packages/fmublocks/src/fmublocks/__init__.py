"""A block in Python becomes FMUs: co-simulation and model exchange, FMI 2.0 and 3.0, native ones that need no Python
where they run, or by PythonFMU; C for a processor; a WebAssembly module.

A block is declared with its quantities (unit, meaning, bounds) and pure functions over named tuples; the README has one
of thirty lines. With its file `pi_controller.py`, which declares `FMU = Fmu(BLOCK, stop_time=10.0)`:

    from pathlib import Path
    from fmublocks import build_fmus
    from pi_controller import FMU

    for path in build_fmus([FMU], Path("build"), "both"):
        print(path)  # build/PiController.fmu, build/native/PiController.fmu

What stands in `__init__.pyi` is public. A mistake of the user is a `BuildError` of one line.
"""

from toolground.public_names import public_names

__getattr__, __dir__ = public_names(__name__, __file__)
