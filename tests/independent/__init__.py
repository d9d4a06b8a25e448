"""Independent truth for the tests: nothing here imports the package under test, or SymPy."""
