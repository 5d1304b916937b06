"""What the coupling of the FMUs costs, against the loop solved as one system."""
