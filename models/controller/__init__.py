"""The parts of the damping controller: torque estimator, damping law, signal monitor, gains."""
