"""The subcommands of `driveline`: each module has NAME, HELP, DESCRIPTION, EXAMPLES,
add_arguments(parser) and run(args) -> int."""
