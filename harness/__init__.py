"""Runs FMUs in closed loop and evaluates what they do."""
