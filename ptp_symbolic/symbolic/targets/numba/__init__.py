"""Programs as self-contained numba modules."""
