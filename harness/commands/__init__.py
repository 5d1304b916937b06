"""The commands of `driveline`, see `harness.commands.cli`."""
