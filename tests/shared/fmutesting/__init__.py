"""What tests of the packages and of driveline share."""
