"""Derivatives of simulations by parameters and initial states."""
