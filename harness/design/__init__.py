"""From a vehicle to the gains of the controller."""
