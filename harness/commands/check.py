"""Checks any FMU of FMI 2.0 or 3.0: its archive, its model description (with fmpy, and what fmpy does not look at:
aliases, units, dependencies, documentation), its binary and its behaviour in co-simulation and model exchange (default
experiment, odd step sizes, reset, several instances, saved states), the latter in a process of its own.

A finding is an error (the standard demands it), a warning (it recommends it) or a note (people miss something).
Exit code 0: no errors; 1: errors, with --strict also warnings; 2: no such file. docs/fmus.md says more.

examples:
  driveline check build/native/TwoMassDriveline.fmu
  driveline check --strict build/native/*.fmu
  driveline check --quick --ignore archive-pages --ignore origin their_car.fmu
  driveline check --format junit build/native/*.fmu > findings.xml
"""

from fmucheck.command import Arguments as Arguments
from fmucheck.command import run as run
