"""Recorded drives, with every controller."""
