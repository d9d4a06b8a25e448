"""From a declared platform to its equations of motion."""
