"""The bus of the car: its database, and the frames of a run as a logger records them."""
