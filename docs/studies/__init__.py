"""Makes figures and pages of the documentation that no command of `driveline` makes."""
