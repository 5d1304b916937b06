"""The subcommands of `driveline`: each module has NAME, HELP, add_arguments(parser), run(args) -> int."""
