"""What the commands do with a platform and its logs: check, fit, diagnose."""
