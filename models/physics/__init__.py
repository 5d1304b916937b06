"""What several blocks have in common: the vehicle, the interface of the plants, backlash, brake, tooth wheel."""
