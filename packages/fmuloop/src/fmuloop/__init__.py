"""FMUs as parts of a loop: wiring, instances, and the master that steps them."""
