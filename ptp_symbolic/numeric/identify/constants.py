"""The named numbers of fits and search: value, unit, quantity, and where each comes from.

One line each, in this form: value  # unit; quantity; source. A source is a derivation (from
rounding, from a distribution, from the definition of the quantity), or "scaled", "stated", "usual",
"tested": nothing derives the number then. Of each of those, two sets of the build half (119, a dead
band; 224, a perfect geared drive) are diagnosed with it halved and doubled (`python -m
tests.benchmark constants`). Both are right as the table is and in all of the 68 rows: nothing in
them hangs on one of these numbers, within a factor of two.

Decisions and statistics come first, then robustness, effort, windows and rows, numerics. What a
library, the rounding of doubles, or a number of this table gives is computed where it is used.
"""

import numpy as np

# Decisions and statistics
FALSE_ALARM = 0.05  # 1; chance of naming anything where nothing is missing; stated level
TEST_ALARM = 0.01  # 1; false alarms of one residual test; usual 99 % band (Ljung, 1999, 16.6)
LAGS = 25  # samples; lags of the residual tests; usual (Ljung, 1999, 16.6)
MATERIAL = 0.1  # 1; share of a loss, or error, below which nothing earns a name or counts; stated
MOST = 0.5  # 1; share that is most of a whole; definition
PLAUSIBLE_FACTOR = 2.0  # 1; by which a declared value may be off, a start by its square; stated
ABOVE_NOISE = 1.0 + MATERIAL  # 1; rms over the noise floor that is more than noise; derived
UNALIKE = 1e-3  # 1; false alarms of the test for larger validation windows; stated level
FEWEST_BLOCKS = 12  # 1; blocks: Student's interval is then 12 % wider than a normal one; derived
MOST_BLOCKS = 200  # 1; blocks: the error of a standard deviation is then 5 %; derived
RESAMPLES = 2000  # 1; draws: the 2.5 % quantile is good to 0.35 %; derived
REPEATS = 8  # 1; replays: 4 degrees of freedom are good to 25 %; folds (usual: 5 to 10); derived
DEVIATIONS = 2.0  # 1; standard deviations that hold 95 %, Huber's loss 99 % efficient; derived
SEED = 20130801  # 1; of every draw, so that equal logs have equal answers; scaled

# Robustness
TUNING = 2.5  # 1; sizes of the usual block beyond which a block counts less; scaled
FAR = 4.0  # 1; standard deviations that noise seldom reaches (once in 16,000); derived
RESTING = 5.0  # 1; the same for every rate of a log (once in 1,700,000); derived
FORGOTTEN = 0.25  # s; five time constants of drives (0.05 s), after which 0.7 % is left; derived
NEARBY = 2.0 * FAR  # 1; standard deviations from which on all windows count alike; scaled
MISLEADING = 0.25  # 1; share of a difference: a derivative off by it, or below it, misleads; scaled

# Effort
ITERATIONS = 4  # 1; in which a fit, or an amount, shows whether it is worth more; scaled
CYCLES = 3  # 1; of two in turn: fits, weights and fits, states that are probed; scaled
TRIED = 3  # 1; alternatives that are followed; scaled
LARGEST = 3  # effects; that a set may have, or gain after the first choice; stated
SCREENED = 2  # sets, candidates; of those begun with few iterations that go on; scaled
SCANNED = 100  # frequencies; that can be resolved, at most, of a wave simulated at all; scaled
REFINEMENTS = 2  # 1; Gauss-Newton steps of a proposed set; scaled
REPLAYS = 100  # runs; replayed with noisy inputs: a standard deviation is good to 7 %; derived
ROUGH = 1e-2  # 1; error of simulations over the noise, while searching; scaled
LITTLE = 2.0 * ROUGH  # 1; change of a mean square that such errors can make; derived
CHATTER = 2.0 / ROUGH  # steps; a sample, on average: what is shorter adds less; derived
BOUNCES = 1e4  # steps; at once: impacts at 0.1 rad/s that keep 0.999 of it come to rest; derived

# Windows and rows
SHORT = 1.0  # s; window beside the time constants of drives (0.05 s); scaled
SEARCH_PERIOD = 5e-3  # s; between samples of a search, at most; scaled
START_SPAN = 0.1  # s; motion that determines a rate; scaled
ANYWHERE = 1e3  # rad/s, half gaps; beyond any start of a machine; definition
LEAST_START = 5  # samples; of a parabola with two degrees of freedom left; derived
ALLOWED_RISE = 2.0  # 1; of the drift by input noise in a window, over the shortest one's; scaled
ROWS_PER_WINDOW = 8  # 1; rows overlap: neighbours correlate by 0.86; derived
SAMPLES_PER_WINDOW = 32  # 1; torques in a window: a second derivative is off by 2e-4; derived
LEAST_SAMPLES = 7  # samples; in a window: the same is off by 6 % unless normalised; derived
LARGEST_GAP = 0.34  # half widths; without a sample: a mean curvature is off by up to 12 %; derived
CALM = 5e-3  # 1; noise of an averaged acceleration over what accelerates; scaled
CYCLES_APART = 0.2  # 1/range; step of a frequency scan: a line between is dimmed by 3 %; derived
LEAST_CYCLES = 3  # 1/range; slower waves are like any slow change, or a taper (2); scaled
BINS_PER_CYCLE = 4.0  # 1; of the highest frequency of a scan: a bin dims it by 10 %; derived
ATTENUATED = 2.0  # 1/window; of such a wave an average leaves 11 %; derived
DECLARED_AMOUNT = 0.05  # 1; share by which a declared value is changed to see its effect; scaled
BINS = 16  # 1; of a map of the residual, of half a gap; definition

# Noise of a signal
ORDER = 5  # 1; differences: a motion at a tenth of the sampling rate leaves 0.6 %; derived
SEGMENT = 64  # samples; of a periodogram: poles up to 0.95 are not white noise; tested

# Steps
STEP = 0.02  # search coordinates, starts; of differences, as far as intervals reach; scaled
WIDE_STEP = 0.1  # search coordinates; of differences while searching, over a staircase; scaled
LARGEST_STEP = 1.0  # search coordinates; of one iteration: a factor of e; scaled
REACH = 3.0  # 1; size of a response over the residual, beyond which it is not linear; scaled

# Numerics
ROUNDING = 1.0 / np.sqrt(12.0)  # counts; standard deviation of rounding; derived
SAME = 1e-3  # 1; relative difference of directions or values that count as one; scaled
NOTHING = 1e-10  # 1; share of a sum of 1e5 squares, above its rounding of 2e-11; derived
ROUNDS = 40  # 1; at most, until a loop has converged; halvings: to 1e-12; derived
WITH_TANGENTS = 3  # 1; cost of a sample with its sensitivities over one without; derived
KEY_BYTES = 16  # bytes; of a key: any two of 1e6 evaluations are alike once in 1e27; derived

# Sequences
LENGTHS = (8.0, 4.0, 2.0, 1.0, 0.5)  # s; lengths of windows that are tried, by halves; scaled
AMOUNTS = tuple(2.0**k for k in range(-3, 3))  # 1; times its start, of an effect, by twos; scaled
HALF_WIDTHS = (0.08, 0.11, 0.16, 0.22)  # s; windows of rows, by root two; scaled
