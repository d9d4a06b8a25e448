"""What a finite amount of a candidate would change in the simulated outputs of a trial.

Breakaways, gaps and delays do not show in the torque along the motion, or have no derivative where
they vanish: their response to a finite amount, the free parameters following, tells what a refit
could gain, and where it should start.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear

from ptp_symbolic.diagnose.candidates import Candidate
from ptp_symbolic.diagnose.proposals import Proposal
from ptp_symbolic.diagnose.signatures import brought
from ptp_symbolic.diagnose.trial import Task, Trial, simulated
from ptp_symbolic.identify.coordinates import to_search
from ptp_symbolic.identify.fit import all_values
from ptp_symbolic.identify.intervals import project_out

FloatArray = NDArray[np.float64]

REACH = 3.0  # times the residual: a response beyond is shrunk, for it is no longer linear
SHRINKS, SHRINK = 4, 0.25
FARTHEST = 0.5  # search coordinates (half a decade or half a scale) that free parameters may follow
RIDGE = 1e-6


@dataclass(frozen=True, eq=False)
class Response:
    """A candidate added to a trial: the share of the squared residual that is predicted to be left,
    and where a refit should start. `columns` [n, k] are its responses, `changes` the values that
    made each.
    """

    candidate: Candidate
    left: float
    proposal: Proposal


def responses(task: Task, trial: Trial, candidates: Sequence[Candidate]) -> list[Response]:
    """Responses of `candidates` that the trial does not have, the most promising first.

    A candidate that needs another brings it along.
    """
    have = {c.key for c in trial.candidates}
    by_key = {c.key: c for c in reversed(task.candidates)}
    wanted = [
        (c, shape)
        for c in candidates
        if c.key not in have
        for shape in c.shapes
    ]
    fit = trial.fit
    residual = [e.residual for e in fit.evaluations]
    here = _projected(trial, residual)
    declared = np.vstack(
        [project_out(e.by_parameter, e.by_start) for e in fit.evaluations]
    )

    def respond(pair: tuple[Candidate, Mapping[str, float]]) -> Response | None:
        candidate, shape = pair
        base = {k: v for k, v in brought(candidate, by_key).items()
                if not any(key in have for key in candidate.brings)}  # fmt: skip
        found = [
            _column(task, trial, residual, {**base, **shape}, f.name, f.tied, candidate)
            for f in candidate.defining
        ]
        kept = [(f, c) for f, c in zip(candidate.defining, found, strict=True) if c is not None]
        if not kept:
            return None
        columns = np.column_stack([c[0] for _, c in kept])
        amounts, left = _least(here, declared, columns, fit, kept, candidate)
        values = _moved(trial, amounts[: declared.shape[1]])
        values.update(base)
        values.update(shape)
        for (f, _), amount in zip(kept, amounts[declared.shape[1] :], strict=True):
            zero = candidate.vanishing[f.name]
            value = float(np.clip(zero + amount, f.lower, f.upper))
            values.update(dict.fromkeys((f.name, *f.tied), value))
        added = [by_key[key] for key in candidate.brings if key not in have]
        return Response(candidate, left, Proposal((*trial.candidates, *added, candidate), values))

    jobs = list(task.executor.map(respond, wanted))
    best: dict[tuple[str, int], Response] = {}
    for response in sorted((r for r in jobs if r is not None), key=lambda r: r.left):
        best.setdefault((response.candidate.key, response.candidate.member), response)
    return list(best.values())


def _column(
    task: Task,
    trial: Trial,
    residual: Sequence[FloatArray],
    base: Mapping[str, float],
    name: str,
    tied: Sequence[str],
    candidate: Candidate,
) -> tuple[FloatArray, float] | None:
    """The response per unit of a defining parameter, and the amount that made it; None where
    nothing can be simulated or nothing changes.
    """
    zero = candidate.vanishing[name]
    f = next(p for p in candidate.free if p.name == name)
    whole = f.start - zero
    if candidate.is_declared_value:
        whole = min(0.05 * abs(f.start), 0.5 * (f.upper - f.start))
    most = REACH * float(np.sqrt(sum(r @ r for r in residual)))
    amount = whole
    for _ in range(SHRINKS):
        changed = simulated(
            task, trial.fit, {**base, **dict.fromkeys((name, *tied), zero + amount)}, None
        )
        if not any(e.failed for e in changed):
            without = residual
            if base:
                plain = simulated(task, trial.fit, base, None)
                if any(e.failed for e in plain):
                    return None
                without = [e.residual for e in plain]
            change = _projected(
                trial, [e.residual - r for e, r in zip(changed, without, strict=True)]
            )
            size = float(np.linalg.norm(change))
            if size == 0.0:
                return None
            if size <= most:
                return change / amount, amount
        amount *= SHRINK
    return None


def _projected(trial: Trial, columns: Sequence[FloatArray]) -> FloatArray:
    """One column [n] over all runs, without what the unknown starts can explain."""
    pairs = zip(columns, trial.fit.evaluations, strict=True)
    return np.concatenate([project_out(c[:, None], e.by_start)[:, 0] for c, e in pairs])


def _least(here, declared, columns, fit, kept, candidate):  # type: ignore[no-untyped-def]
    """Amounts of the declared search coordinates and of the defining parameters that make the
    residual least within bounds, and the share of its square that is left.
    """
    table = np.column_stack([declared, columns])
    lower = np.concatenate(
        [np.full(declared.shape[1], -FARTHEST),
         [f.lower - candidate.vanishing[f.name] for f, _ in kept]]
    )  # fmt: skip
    upper = np.concatenate(
        [np.full(declared.shape[1], FARTHEST),
         [f.upper - candidate.vanishing[f.name] for f, _ in kept]]
    )  # fmt: skip
    size = np.maximum(np.linalg.norm(table, axis=0), 1e-300)
    triangle = np.linalg.qr(np.column_stack([table / size, here]), mode="r")
    k = table.shape[1]
    ridge = RIDGE * np.linalg.norm(triangle[:, k]) * np.eye(k)
    solved = lsq_linear(
        np.vstack([triangle[:, :k], ridge]),
        -np.concatenate([triangle[:, k], np.zeros(k)]),
        ((lower - 1e-12) * size, (upper + 1e-12) * size),
    )
    left = 2.0 * solved.cost / max(float(here @ here), 1e-300)
    return solved.x / size, float(left)


def _moved(trial: Trial, shift: FloatArray) -> dict[str, float]:
    """Values of all parameters, the free ones shifted in their search coordinates."""
    free = trial.fit.free
    phi = to_search(free, trial.fit.values) + shift
    return {**trial.values, **all_values(free, phi)}
