"""What the site has besides the pages in docs: pages made when it is built, links and equations that fit there."""

from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
"""Of the checkout."""
