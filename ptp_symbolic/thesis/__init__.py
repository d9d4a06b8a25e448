"""Everything the thesis computes, recomputed: one file per chapter, one item per printed result."""
