"""The C of a controller on the emulated target, off-line and in the loop, compared with what it is made from."""
