"""Shorter equations in named, counted and checked steps; base parameters."""
