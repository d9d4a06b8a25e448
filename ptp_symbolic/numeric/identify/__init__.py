"""Fit parameters to several runs at once, with intervals that allow for correlated residuals.

- `run_preparation` makes a `run` of every log, or of its parts, with the `noise` of every signal.
- By the equations along the measured motion, without simulation: `weak_form`, `along_motion`,
  `equation_rows`, `equation_space`, and the fit to such rows, `equation_fit`.
- By simulation: `evaluate`, `coordinates`, `least_squares`, `fit`; `windows` for runs that nothing
  predicts to their end.
- Statistics of residuals correlated in time: `blocks`, `intervals`.
- `evidence` records what was evaluated; `constants` has all numbers that are not derived elsewhere.
"""

from ptp_symbolic.numeric.runtime import compiled as compiled
