"""What is measured of the project itself, rather than of a car: how far its controller is from what is possible, what
the coupling of the FMUs does to the loop, and whether all builds of a block are the same.

examples:
  driveline study bound --manoeuvre tipin15
  driveline study coupling
  driveline study back-to-back
  driveline study ACTION --help                          explains an action
"""

ACTIONS = {
    "bound": ("bound", "compute what no controller can beat, beside what ours reaches"),
    "coupling": ("coupling", "measure what co-simulation does to the loop: its errors, its dead time"),
    "back-to-back": ("back-to-back", "compare both builds of each block with its functions"),
}
"""Each with its module, and what it does."""
