"""The parts of the damping controller: torque estimator, damping law, signal monitor, gains."""

T_S = 2e-3
"""Sample time of every controller in s."""
