"""Simulation with located events: sticking, sliding, contact across a gap."""
