"""Equations printed for people: statements, laws, comparisons, LaTeX."""
