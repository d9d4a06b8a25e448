"""Emitted equations of motion, one module per model; `ptp-symbolic regenerate` writes them."""
