"""Physics and control of the drive train: one file a block, standard library only."""
