"""From equations to numba modules and formulas for documents."""
