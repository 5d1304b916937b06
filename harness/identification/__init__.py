"""Identification: from a recording of a test drive to the parameters of the design model (paper, Section IV)."""
