"""Programs written in the languages that others run."""
