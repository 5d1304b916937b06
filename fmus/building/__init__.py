"""Building FMUs: those of the project, those of a user, with the parameters of files."""
