"""A controller as plain C for a processor, and the emulated target that it is tried on."""
