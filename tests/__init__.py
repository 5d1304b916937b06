"""Sentences about the physics, the FMUs and the loop, in the rooms of what they are about."""

from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
"""Of the checkout."""
