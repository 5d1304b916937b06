"""Fuzz targets: odd input by the thousand, each answered as promised or told as a fault.

A target says what one try is. It draws everything from a random generator, so that a seed tells the whole run.
"""
