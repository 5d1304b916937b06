"""The blocks of `models` as FMI 2.0 co-simulation FMUs."""
