"""From the residual of the declared model to ranked candidates and a verdict.

In the order of a diagnosis:

- `preparation` settles candidates (`candidates`), windows and noise.
- `proposals` regresses the weak-form rows on the `signatures` of all candidates (`regression`), and
  proposes sets with initial values.
- `refits` fits them by simulation (`fitted_model`) over growing windows (`cut_runs`); `responses`
  predicts in the outputs what the rows do not show.
- `search` selects candidates by the moves of `stepwise`; `structures` compares models with other
  mechanisms.
- `verdict` decides: what is named must pass the tests of `confirm`; `groups` finds what these logs
  do not distinguish from it; `along_rows` looks beside a residual above the noise.
- Most decisions compare a predictive gain (`gain`) with the share that is required, or a residual
  with the `noise_floor`.
- `summary` makes data of it; `hints` and `remainder` are observations, from which nothing follows.
"""
