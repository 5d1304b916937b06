"""What an FMU says of itself: variables, units, dependencies, description, page, picture."""
