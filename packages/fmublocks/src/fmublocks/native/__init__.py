"""Native FMUs: the functions of a block traced into C, and the C around them that is the same for all blocks."""
