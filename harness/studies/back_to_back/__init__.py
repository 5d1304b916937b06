"""The functions and both builds of every block, compared."""
