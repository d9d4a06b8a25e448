"""Which sets of candidates explain the weak-form rows: all subsets, cross-validated.

Everything is linear here: the declared parameters and the signatures of all candidates are columns
of one regression with Huber's weights, so that a subset costs the solution of a small system per
fold, and aliased effects compete at once (all subsets: Furnival and Wilson, 1974).
"""

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.gain import Gain, compared
from ptp_symbolic.numeric.diagnose.signatures import Signature
from ptp_symbolic.numeric.identify.blocks import block_labels, block_length
from ptp_symbolic.numeric.identify.constants import (
    CYCLES,
    DEVIATIONS,
    FAR,
    LARGEST,
    LITTLE,
    NOTHING,
    REPEATS,
    SEED,
    TRIED,
)
from ptp_symbolic.numeric.identify.coordinates import FreeParameter
from ptp_symbolic.numeric.identify.equation_fit import (
    blocks_in_time,
    huber_weight,
    robust_scale,
)

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def block_numbers(run: IntArray, time: FloatArray) -> IntArray:
    """The number [n] of the block of every row, as `blocks_in_time` tells them apart."""
    _, number = np.unique(blocks_in_time(run, time), axis=0, return_inverse=True)
    return np.asarray(number.reshape(-1), dtype=np.int64)


@dataclass(frozen=True, eq=False)
class Regression:
    """Rows [n] to be regressed on `base` [n, nb], the columns of the `declared` parameters, and on
    the columns of the signatures.

    `scale` [n] is the standard deviation of every row, `weight` [n] its weight in the fit,
    `equation` [n] its equation, `block` [n, 2] the block of time that it belongs to (see
    `blocks_in_time`).
    """

    rows: FloatArray
    declared: tuple[FreeParameter, ...]
    base: FloatArray
    signatures: tuple[Signature, ...]
    equation: IntArray
    block: IntArray
    weight: FloatArray
    scale: FloatArray


def regression(
    rows: FloatArray,
    declared: Sequence[FreeParameter],
    base: FloatArray,
    found: Sequence[Signature],
    equation: IntArray,
    block: IntArray,
    weight: FloatArray,
) -> Regression:
    """The regression with weights [n] from the residual of the declared model, begun at `weight`;
    the other arguments are those of `Regression`.
    """
    start = Regression(
        rows,
        tuple(declared),
        base,
        tuple(found),
        equation,
        block,
        weight,
        np.ones(len(rows)),
    )
    return reweighted(start, ())


def reweighted(found: Regression, candidates: Sequence[Candidate]) -> Regression:
    """`found` with Huber's weights and scales from the residual of a set of `candidates`: twice as
    many rounds as fits take, which cost more, settle the weights to a percent.
    """
    own = [s.columns for s in found.signatures if s.candidate in candidates]
    columns = np.column_stack([found.base, *own])
    weight, scale = found.weight, found.scale
    for _ in range(2 * CYCLES):
        left = found.rows - columns @ _amounts(columns, found.rows, weight)
        scale = robust_scale(left, found.equation)
        weight = huber_weight(left, scale)
    return replace(found, weight=weight, scale=scale)


def weakly_identified(found: Regression) -> list[FreeParameter]:
    """Declared parameters on which all rows, with all others known, hold less information than the
    prior, which is as wide as their scale. Rows overlap: those of a block in one equation count as
    one.
    """
    counted = np.column_stack([found.equation, found.block])
    overlap = len(counted) / len(np.unique(counted, axis=0))
    told = np.linalg.norm(found.base * np.sqrt(found.weight / overlap)[:, None], axis=0)
    return [f for f, size in zip(found.declared, told, strict=True) if size * f.scale < 1.0]


def remainder(found: Regression, beside: Sequence[Signature] = ()) -> FloatArray:
    """Residual rows [n] of the regression on the declared parameters and the signatures `beside`
    them.
    """
    columns = np.column_stack([found.base, *(s.columns for s in beside)])
    return found.rows - columns @ _amounts(columns, found.rows, found.weight)


def _amounts(columns: FloatArray, rows: FloatArray, weight: FloatArray) -> FloatArray:
    root = np.sqrt(weight)
    size = np.maximum(np.linalg.norm(columns * root[:, None], axis=0), 1e-300)
    scaled = columns * root[:, None] / size
    return np.linalg.lstsq(scaled, rows * root, rcond=1e-6)[0] / size


def lines(found: Regression, scan: Callable[[FloatArray], Sequence[Signature]]) -> list[Signature]:
    """Signatures of the candidates with a frequency, all forms of one at the same; `scan` gives
    them at the strongest lines of a residual [n].

    A larger effect hides a line, or looks like one of another frequency; so the residual of the
    best set without lines is scanned too. Powers are those of a line by itself, where slow motion
    and gaps smear it: of all frequencies of a candidate the one counts that reduces the sum of
    squares most beside that set, in its simplest form, for several harmonics of a false line reduce
    it much as well.
    """
    best = ranked_subsets(found, LARGEST)[0].candidates
    beside = [s for s in found.signatures if s.candidate in best]
    every = [*scan(remainder(found)), *(scan(remainder(found, beside)) if beside else ())]

    def left(line: Signature) -> float:
        return float(found.weight @ remainder(found, [*beside, line]) ** 2)

    simplest = [s for s in every if s.candidate.member == 0]
    strongest: dict[str, float] = {}
    for line in sorted(simplest, key=left):
        strongest.setdefault(line.candidate.key, _frequency(line))
    placed = [s for s in every if _frequency(s) == strongest.get(s.candidate.key)]
    return list({_form(s.candidate): s for s in placed}.values())


def _frequency(line: Signature) -> float:
    assert line.candidate.locked is not None
    return line.candidate.shapes[0][line.candidate.locked[0]]


@dataclass(frozen=True, eq=False)
class Subset:
    """A set of candidates with the loss of every block [b], predicted without its fold."""

    candidates: tuple[Candidate, ...]
    losses: FloatArray
    columns: int

    @property
    def loss(self) -> float:
        """Sum of the losses of all blocks."""
        return float(self.losses.sum())


def ranked_subsets(found: Regression, largest: int) -> list[Subset]:
    """Subsets of up to `largest` candidates, the least cross-validated loss first.

    All single candidates and pairs are compared, larger subsets among those that do best in them.
    """
    folds = _Folds(found)
    entries = range(len(found.signatures))
    every: dict[tuple[int, ...], Subset] = {(): folds.subset(())}
    for size in (1, 2):
        for chosen in itertools.combinations(entries, size):
            if size <= largest and folds.is_complete(chosen):
                every[chosen] = folds.subset(chosen)
    for size in range(3, largest + 1):
        smaller = sorted((k for k in every if len(k) == size - 1), key=lambda k: every[k].loss)
        pool = list(dict.fromkeys(entry for chosen in smaller for entry in chosen))[: 4 * TRIED]
        for chosen in smaller[: 4 * TRIED]:
            for entry in pool:
                grown = tuple(sorted({*chosen, entry}))
                if len(grown) == size and grown not in every and folds.is_complete(grown):
                    every[grown] = folds.subset(grown)
    return sorted(every.values(), key=lambda s: s.loss)


def exchanges(found: Regression, candidates: Sequence[Candidate]) -> list[tuple[Candidate, ...]]:
    """Sets with another candidate in the place of one of `candidates` that are no worse than these
    in cross-validation, the best first. What the rows do not show of the candidates is kept.
    """
    found = reweighted(found, candidates)
    number = {_form(s.candidate): k for k, s in enumerate(found.signatures)}
    own = [number[_form(c)] for c in candidates if _form(c) in number]
    hidden = tuple(c for c in candidates if _form(c) not in number)
    folds = _Folds(found)
    whole = folds.subset(own)
    sets = [
        tuple(sorted({*own, other} - {member}))
        for member in own
        for other in range(len(found.signatures))
        if other not in own
    ]
    every = [folds.subset(chosen) for chosen in sets if folds.is_complete(chosen, hidden)]
    keys = frozenset(c.key for c in candidates)
    best: dict[frozenset[str], tuple[Candidate, ...]] = {}
    for subset in sorted(every, key=lambda s: s.loss):
        placed = (*subset.candidates, *hidden)
        fresh = frozenset(c.key for c in placed)
        if fresh != keys and is_no_worse(subset, whole, DEVIATIONS, LITTLE):
            best.setdefault(fresh, placed)
    return list(best.values())


def gain_along_motion(
    found: Regression, larger: Sequence[Candidate], smaller: Sequence[Candidate]
) -> Gain | None:
    """The predictive gain of one set over another in the rows, judged on blocks as long as their
    differences are correlated; None where the rows do not show every candidate that only one of
    them has.
    """
    forms = {_form(c) for c in larger}, {_form(c) for c in smaller}
    own = [s for s in found.signatures if _form(s.candidate) in forms[0] | forms[1]]
    number = {_form(s.candidate): k for k, s in enumerate(own)}
    if not (forms[0] ^ forms[1]) <= set(number):
        return None
    more = [s.candidate for s in own if _form(s.candidate) in forms[0]]
    folds = _Folds(reweighted(replace(found, signatures=tuple(own)), more))
    losses = [folds.subset(sorted(number[f] for f in s if f in number)).losses for s in forms]
    ends = np.flatnonzero(np.diff(np.unique(found.block, axis=0)[:, 0])) + 1
    series = np.split(losses[1] - losses[0], ends)
    label = np.concatenate(block_labels([len(s) for s in series], block_length(series)))
    merged = [np.asarray(np.bincount(label, x), dtype=np.float64) for x in losses]
    return compared(merged[0], merged[1])


def larger_sets(found: Regression, candidates: Sequence[Candidate]) -> list[tuple[Candidate, ...]]:
    """Sets with one candidate more than `candidates`, those first that predict the rows best; every
    candidate in its best form. What the rows do not show of the candidates is kept.
    """
    number = {_form(s.candidate): k for k, s in enumerate(found.signatures)}
    own = [number[_form(c)] for c in candidates if _form(c) in number]
    found = reweighted(found, [found.signatures[k].candidate for k in own])
    folds = _Folds(found)
    brought = {s.candidate.key: k for k, s in reversed(list(enumerate(found.signatures)))}
    have = {c.key for c in candidates}
    sets = []
    for k, s in enumerate(found.signatures):
        along = [brought[key] for key in s.candidate.brings if key not in have and key in brought]
        grown = sorted({*own, *along, k})
        if s.candidate.key not in have and folds.is_complete(grown):
            sets.append((folds.subset(grown).loss, [*along, k]))
    best: dict[str, tuple[Candidate, ...]] = {}
    for _, added in sorted(sets, key=lambda pair: pair[0]):
        new = tuple(found.signatures[k].candidate for k in added)
        best.setdefault(new[-1].key, (*candidates, *new))
    return list(best.values())


def _form(candidate: Candidate) -> tuple[str, int]:
    return candidate.key, candidate.member


class _Folds:
    """The normal equations of every fold, for all columns at once; rows fold by fold."""

    def __init__(self, found: Regression) -> None:
        self.found = found
        size = np.linalg.norm(found.base * np.sqrt(found.weight)[:, None], axis=0)
        base = found.base / np.where(size > 0.0, size, 1.0)
        columns = np.column_stack([base, *(s.columns for s in found.signatures)])
        sizes = [found.base.shape[1], *(s.columns.shape[1] for s in found.signatures)]
        ends = np.cumsum(sizes)
        self.own = [np.arange(b - n, b) for b, n in zip(ends, sizes, strict=True)]
        blocks, label = np.unique(found.block, axis=0, return_inverse=True)
        label = label.reshape(-1)  # NumPy 2.0 gives a column
        fold = (np.random.default_rng(SEED).permutation(len(blocks)) % REPEATS)[label]
        order = np.argsort(fold, kind="stable")
        ends = np.searchsorted(fold[order], np.arange(REPEATS + 1))
        self.members = [slice(a, b) for a, b in itertools.pairwise(ends)]
        self.label, self.rows, self.scale = label[order], found.rows[order], found.scale[order]
        self.columns = np.ascontiguousarray(columns[order].T)
        root = np.sqrt(found.weight)[order]
        weighted, right = columns[order] * root[:, None], self.rows * root
        matrices = np.stack([weighted[m].T @ weighted[m] for m in self.members])
        sides = np.stack([weighted[m].T @ right[m] for m in self.members])
        self.matrices = sum(matrices) - matrices
        self.sides = sum(sides) - sides

    def is_complete(self, chosen: Sequence[int], hidden: Sequence[Candidate] = ()) -> bool:
        """Whether no key occurs twice and everything that is brought along is there, in the set
        with those of its candidates that are `hidden` from the rows.
        """
        candidates = [*(self.found.signatures[i].candidate for i in chosen), *hidden]
        keys = [c.key for c in candidates]
        return len(set(keys)) == len(keys) and all(set(c.brings) <= set(keys) for c in candidates)

    def subset(self, chosen: Sequence[int]) -> Subset:
        """Losses of all blocks, each with the amounts that the other folds give."""
        index = np.concatenate([self.own[0], *(self.own[i + 1] for i in chosen)])
        parts = self.matrices[:, index[:, None], index]
        ridge = NOTHING * np.trace(parts, axis1=1, axis2=2) / len(index)
        parts[:, range(len(index)), range(len(index))] += ridge[:, None]
        amounts = np.linalg.solve(parts, self.sides[:, index, None])[..., 0]
        columns, left = self.columns[index], self.rows.copy()
        for members, amount in zip(self.members, amounts, strict=True):
            left[members] -= amount @ columns[:, members]
        loss = np.minimum((left / self.scale) ** 2, FAR**2)
        losses = np.asarray(np.bincount(self.label, loss), dtype=np.float64)
        candidates = tuple(self.found.signatures[i].candidate for i in chosen)
        return Subset(candidates, losses, len(index))


def is_no_worse(subset: Subset, best: Subset, deviations: float, share: float) -> bool:
    """Whether the loss of `subset` exceeds that of `best` by less than so many standard errors of
    the paired differences of blocks (Breiman et al., 1984, section 3.4.3), or by less than a share.
    """
    difference = subset.losses - best.losses
    error = float(np.std(difference) * np.sqrt(len(difference)))
    excess = float(difference.sum())
    return excess <= deviations * error or excess <= share * best.loss
