"""Drives in closed form: a linkage, a lead screw."""
