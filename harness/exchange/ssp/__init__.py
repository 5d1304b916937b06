"""The closed loop as a System Structure Package (SSP 1.0), which other tools open."""
