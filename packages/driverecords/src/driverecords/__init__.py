"""Recordings of drives that others have made: what is read, how it is checked, and what becomes of it."""
