"""Friction maps: laws of steady friction fitted to points of rate and torque, and compared."""
