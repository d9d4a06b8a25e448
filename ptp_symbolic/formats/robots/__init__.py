"""Robots of other tools, URDF and MJCF, read and lumped into a platform of two axes."""
