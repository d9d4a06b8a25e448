"""Emitted modules at run time: load them, verify them, hand out their functions."""
