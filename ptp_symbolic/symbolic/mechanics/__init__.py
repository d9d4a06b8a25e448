"""Frames, their rates, and rigid bodies."""
