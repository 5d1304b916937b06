"""The loop as a linear system, derived from the functions of its blocks: margins, poles, describing functions."""
