"""`python -m driveline.fmus.target` says what is missing to run the controller on the emulated target, if anything."""

import sys

from ..native.compiler import CompilerError
from .deviations import CHECKER
from .image import require_packages

try:
    require_packages(CHECKER)
except CompilerError as reason:
    sys.exit(str(reason))
