"""Reports that people read: the diagnosis page and the derivation document."""

from ptp_symbolic.report import plotting as plotting  # before Matplotlib is imported
