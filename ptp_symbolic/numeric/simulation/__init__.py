"""Simulation with located events: sticking, sliding, contact across a gap."""

from ptp_symbolic.numeric.runtime import compiled as compiled
