"""Everything the thesis computes, recomputed: one file per chapter, one item per printed result."""

from ptp_symbolic.report import plotting as plotting  # before Matplotlib is imported
