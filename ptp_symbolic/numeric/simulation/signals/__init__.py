"""Inputs: profiles, columns of logs, delays."""
