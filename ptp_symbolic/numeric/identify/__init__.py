"""Fit parameters to several runs at once, with intervals that allow for correlated residuals."""
