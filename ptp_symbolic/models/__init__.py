"""Platforms made into models: emission and its cache, the committed ones, variants."""
