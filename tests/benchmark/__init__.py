"""A benchmark of the diagnosis: machines with a hidden effect, their logs, and the score.

Catalogue, logs and truths import nothing of the package under test; `runner` alone calls it.
"""
