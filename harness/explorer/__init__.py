"""The page of `driveline explore`: knobs, the runs that they ask for, and the server."""
