"""Modes of friction and contact: when they end, where, and what follows."""
