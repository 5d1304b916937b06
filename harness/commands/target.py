"""The controller on the processor that it is meant for, in C (docs/target.md).

examples:
  driveline target export --vehicle car.toml --parameters gains.toml   its C, in single precision
  driveline target build                                               its FMU, whose step runs on the target
  driveline target image                                               the image, and its A2L description
  driveline target record                                              that C on an emulated Cortex-M4F
  driveline target ACTION --help                                       explains an action
"""

ACTIONS = {
    "export": ("target-export", "write the C of a controller"),
    "build": ("target-build", "build the FMU of a controller that runs on an emulated Cortex-M4F"),
    "image": ("target-image", "compile its image for that target, and describe it for calibration tools (A2L)"),
    "record": ("target-record", "run it on an emulated Cortex-M4F, off-line, and compare"),
}
"""Each with its module, and what it does."""
