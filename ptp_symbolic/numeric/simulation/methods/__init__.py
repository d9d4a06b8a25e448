"""One file per method of integration, its coefficients beside it."""
