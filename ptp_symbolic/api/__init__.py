"""What Python programs see: machines, runs, fits, diagnoses, and the check of an effect."""
