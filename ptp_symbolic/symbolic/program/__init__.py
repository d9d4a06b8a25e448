"""From equations to programs: kernels of named assignments, before any language."""
