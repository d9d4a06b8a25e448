"""Fit parameters to several runs at once, with intervals that allow for correlated residuals."""

from ptp_symbolic.numeric.runtime import compiled as compiled
