"""The rules of `driveline check`."""
