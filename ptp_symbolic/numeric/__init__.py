"""The numeric wing: from emitted equations and logs to simulations, fits and diagnoses."""
