"""Identification: from a recording of a test drive to the parameters of the design model (paper, Section IV)."""

from toolground.optional_packages import required

required("casadi", "identifying a model", "driveline-damping[identification]")
