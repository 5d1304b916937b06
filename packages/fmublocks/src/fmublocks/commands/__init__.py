"""The commands of `fmublocks`, see `toolground.parsers`."""
