"""The commands of `driveline`, see `harness.cli`."""
