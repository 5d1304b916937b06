"""What no controller can beat: optimal torques on the design model with full knowledge."""
