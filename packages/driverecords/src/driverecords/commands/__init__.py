"""The commands of `driverecords`, see `toolground.parsers`."""
