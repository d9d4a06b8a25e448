"""Everything the thesis computes, recomputed: one file per chapter, one item per printed result."""

from ptp_symbolic.report import style as style
