"""Named effects beside rivals without physics, on runs that none of them was fitted to.

Free simulation with a learned torque on the joints of the declared model.

Two rivals that know no physics: sparse regression and a small neural network.

Both map what is seen of the motion to a torque. How strongly each is regularised is chosen by
cross-validation over whole blocks of the training runs, since neighbouring rows resemble each
other.

What a rival without physics may see: the residual torque, and motion and inputs beside it.
"""

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations_with_replacement
from typing import Any

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.identify.equation_space import EquationSpace
from ptp_symbolic.numeric.identify.evaluate import Tolerance
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.start import start_state
from ptp_symbolic.numeric.identify.weak_form import weak_average
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import delayed, delays_of
from ptp_symbolic.numeric.simulation.integration import Accuracy, integrate
from ptp_symbolic.numeric.simulation.kernels.records import DONE

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

Torque = Callable[[FloatArray], FloatArray]

TORQUE = "tau0_{axis}"  # of the effect constant_torque, which is in every model of a diagnosis


@dataclass(frozen=True, eq=False)
class FreeRuns:
    """What is simulated: `runs` (or windows of them) at p [np], from the better of several
    `starts`, each the start unknowns of every run.
    """

    model: Model
    runs: Sequence[Run]
    p: FloatArray
    starts: Sequence[Sequence[FloatArray]]
    tolerance: Tolerance


def free_error(free: FreeRuns, torques: Mapping[str, Torque]) -> dict[str, float | None] | None:
    """The error (rms) of the angles together in rad (positions in m) and in counts, with the
    `torques` by axis on the joints; every run from that start which leaves less.

    None where a simulation ends early, and for a model without a place for the torques.
    """
    if any(TORQUE.format(axis=axis) not in free.model.parameter_names for axis in torques):
        return None
    tried = [
        [
            _left(free.model, run, states, free.p)
            for run, states in zip(free.runs, simulated(free, z, torques), strict=True)
        ]
        for z in free.starts
    ]
    best = [min(parts, key=_size) for parts in zip(*tried, strict=True)]
    left = np.vstack(best)
    if not np.all(np.isfinite(left)):
        return None
    counts = free.runs[0].counts[_angles(free.runs[0])]
    in_counts = float(np.sqrt(np.mean((left / counts) ** 2)))
    return {
        "rmse": float(np.sqrt(np.mean(left**2))),
        "rmse_counts": in_counts if np.isfinite(in_counts) else None,
    }


def _size(left: FloatArray) -> float:
    square = float(np.sum(left**2))
    return square if np.isfinite(square) else np.inf


def _angles(run: Run) -> list[int]:
    return [k for k, name in enumerate(run.signals) if name.startswith("theta_")]


def _left(model: Model, run: Run, states: FloatArray, p: FloatArray) -> FloatArray:
    """Measured minus simulated angles [k, na] of a run at its `states` [k, n]."""
    shown = np.zeros((len(run.time), len(model.output_names)))
    for k, x in enumerate(states):
        model.module.outputs(run.time[k], x, run.held_inputs[k], p, shown[k])
    columns = _angles(run)
    return np.asarray((run.measured - shown[:, run.outputs])[:, columns])


def simulated(
    free: FreeRuns, z: Sequence[FloatArray], torques: Mapping[str, Torque]
) -> list[FloatArray]:
    """The states [k, n] of all runs from the start unknowns `z`, with the `torques` by
    axis of angles, rates and inputs [s] added to the joints; nan from where a simulation ends.

    A torque is held from sample to sample of the log. All runs go on sample by
    sample, so that a torque is asked for once a sample.
    """
    model, runs, p, tolerance = free.model, free.runs, free.p, free.tolerance
    none = np.zeros(0, dtype=np.int64)
    axes = model.module.AXES
    places = [model.state_names.index(f"{w}_{a}") for w in ("theta", "omega") for a in axes]
    acts = {model.parameter_names.index(TORQUE.format(axis=a)): f for a, f in torques.items()}
    table = [delayed(run.inputs, delays_of(model, p)) for run in runs]
    accuracy = Accuracy(tolerance.relative, tolerance.absolute(model), 1.0)
    states = [np.full((len(run.time), len(model.state_names)), np.nan) for run in runs]
    for found, run, start in zip(states, runs, z, strict=True):
        found[0] = start_state(model, run, p, start, none)[0]
    for k in range(max(len(run.time) for run in runs) - 1):
        going = [r for r, x in enumerate(states) if k + 1 < len(x) and np.all(np.isfinite(x[k]))]
        if not going:
            break
        seen = np.array([[*states[r][k][places], *runs[r].held_inputs[k]] for r in going])
        added = {place: torque(seen) for place, torque in acts.items()}
        for row, r in enumerate(going):
            own = p.copy()
            for place, torque in added.items():
                own[place] += torque[row]
            ends = runs[r].time[k : k + 2]
            stops, x = table[r].with_stops(ends), states[r][k]
            end = integrate(model, None, own, x, table[r], table[r].held, stops, ends, accuracy)
            if end.status == DONE:
                states[r][k + 1] = end.x[-1]
    return states


Values = Mapping[str, float]


@dataclass(frozen=True, eq=False)
class AxisRows:
    """The rows of one axis: what is `seen` [n, s] under `names`, which columns of it are joint
    `rates`, the number of the run [n], and the residual torque [n] in N m (N of a linear joint) of
    the `declared` model and of the one with the `named` effects.
    """

    names: tuple[str, ...]
    rates: tuple[int, ...]
    seen: FloatArray
    run: IntArray
    declared: FloatArray
    named: FloatArray


def space_along(
    space: EquationSpace, runs: Sequence[Run], declared: Values, named: Values
) -> EquationSpace:
    """`space` over other `runs`, with the rows that count for both sets of parameter values."""
    vector = space.model.parameter_vector
    other = replace(space, runs=tuple(runs), rows_of=())
    other.decide_rows(vector(dict(declared)), [vector(dict(named))])
    return other


def axis_rows(space: EquationSpace, axis: int, declared: Values, named: Values) -> AxisRows:
    """The rows of the torque of `axis` (its number), at the values of all parameters of the
    declared model and of the one with the named effects.
    """
    axes, model = space.model.module.AXES, space.model
    equation, number, _ = space.labels()
    own = equation == axis
    before, after = (
        space.rows(model.parameter_vector(dict(values)))[own] for values in (declared, named)
    )
    seen = [
        _seen(space, run, rows.grid[rows.chosen[rows.kept[:, axis]]])
        for run, rows in zip(space.runs, space.rows_of, strict=True)
    ]
    names = (*(f"{word}_{a}" for word in ("theta", "omega") for a in axes), *model.input_names)
    rates = tuple(range(len(axes), 2 * len(axes)))
    return AxisRows(names, rates, np.concatenate(seen), number[own], before, after)


def _seen(space: EquationSpace, run: Run, at: IntArray) -> FloatArray:
    """Angles, rates and inputs [c, 2 na + nu] of a run, averaged under the test functions of its
    rows at the samples `at` [c].
    """
    columns = [run.signals.index(f"theta_{a}") for a in space.model.module.AXES]
    angles = np.ascontiguousarray(run.measured[:, columns])
    motion = [weak_average(run.time, angles, space.half_width, d, at) for d in (0, 1)]
    inputs = np.ascontiguousarray(run.held_inputs)
    return np.hstack([*motion, weak_average(run.time, inputs, space.half_width, 0, at)])


Folds = Sequence[tuple[IntArray, IntArray]]

DEGREE = 3  # factors in a product, signs among them: more extrapolate wildly between runs
WEAKEST = 1e-4  # 1; of the penalties of the Lasso, over the strongest
BLOCKS = 5  # fewest blocks to leave out: fewer runs are cut
MOST_FOLDS = 10
PENALTIES = (1e-2, 1e-1, 1.0, 1e1, 1e2)  # 1; of the squared weights of the network
NEURONS = (32, 32)
NETWORKS = 5  # of different initial weights, averaged
ITERATIONS = 300


@dataclass(frozen=True, eq=False)
class Learned:
    """A rival after learning: its `size` in words, its `torque` [n] in N m (N) of what is seen
    [n, s], and the coefficients in N m (N) of its terms, where it is a formula.
    """

    size: str
    torque: Callable[[FloatArray], FloatArray]
    terms: Mapping[str, float] | None


def require_library() -> None:
    """Raise InputError where scikit-learn is not installed."""
    try:
        import sklearn  # noqa: F401
    except ImportError as error:
        raise InputError(
            "`black_box` needs scikit-learn; run pip install 'ptp-symbolic[black-box]', or leave"
            " the option out."
        ) from error


def folds_of(run: IntArray) -> Folds:
    """Rows to learn from and rows left out, fold by fold: whole runs [n] are left out in turn, or
    consecutive pieces of them where there are fewer than five.
    """
    from sklearn.model_selection import GroupKFold

    runs = np.unique(run)
    pieces = -(-BLOCKS // len(runs))
    block = np.zeros(len(run), dtype=np.int64)
    for k, number in enumerate(runs):
        own = np.flatnonzero(run == number)
        block[own] = k * pieces + np.arange(len(own)) * pieces // len(own)
    count = min(len(np.unique(block)), MOST_FOLDS)
    return list(GroupKFold(count).split(block, groups=block))


def sparse_regression(train: AxisRows) -> Learned:
    """Lasso (Tibshirani, 1996) on all products of up to three factors: what is seen, centred and
    scaled to variance one on the training rows, and the signs of the joint rates.
    """
    from sklearn.linear_model import LassoCV
    from sklearn.preprocessing import StandardScaler

    signs = [f"sign({train.names[k]})" for k in train.rates]
    factors, squares = (
        (*train.names, *signs),
        range(len(train.names), len(train.names) + len(signs)),
    )
    products = [
        list(chosen)
        for degree in range(1, DEGREE + 1)
        for chosen in combinations_with_replacement(range(len(factors)), degree)
        if all(chosen.count(sign) < 2 for sign in squares)
    ]
    scaled = StandardScaler().fit(train.seen)

    def library(seen: FloatArray) -> FloatArray:
        factor = np.hstack([scaled.transform(seen), _signs(seen, train.rates)])
        return np.column_stack([np.prod(factor[:, p], axis=1) for p in products])

    units = StandardScaler().fit(library(train.seen))
    lasso = LassoCV(cv=folds_of(train.run), eps=WEAKEST, max_iter=20_000)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of weak penalties, which the blocks left out reject
        lasso.fit(units.transform(library(train.seen)), train.declared)
    weights = lasso.coef_ / units.scale_
    terms = {
        _product([factors[k] for k in p]): float(w)
        for p, w in zip(products, weights, strict=True)
        if w != 0.0
    }
    constant = terms["1"] = float(lasso.intercept_ - weights @ units.mean_)
    size = f"{len(terms) - 1} of {len(products)} terms"
    return Learned(size, lambda seen: library(seen) @ weights + constant, terms)


def _signs(seen: FloatArray, rates: Sequence[int]) -> FloatArray:
    return np.asarray(np.sign(seen[:, list(rates)]))


def _product(factors: Sequence[str]) -> str:
    """The name of a product of `factors`, such as `theta_pan^2 u_pan`."""
    found = [(name, factors.count(name)) for name in dict.fromkeys(factors)]
    return " ".join(name if n == 1 else f"{name}^{n}" for name, n in found)


def neural_network(train: AxisRows) -> Learned:
    """The mean of five networks of two hidden layers with 32 neurons each."""
    from sklearn.model_selection import GridSearchCV
    from sklearn.neural_network import MLPRegressor
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    def network(start: int, penalty: float) -> Any:
        options = {"activation": "tanh", "solver": "lbfgs", "max_iter": ITERATIONS}
        layers = MLPRegressor(
            hidden_layer_sizes=NEURONS, alpha=penalty, random_state=start, **options
        )
        return make_pipeline(StandardScaler(), layers)

    def features(seen: FloatArray) -> FloatArray:
        return np.hstack([seen, _signs(seen, train.rates)])

    def torque(seen: FloatArray) -> FloatArray:
        return np.asarray(size * np.mean([n.predict(features(seen)) for n in every], axis=0))

    given = features(train.seen)
    size = float(np.std(train.declared)) or 1.0
    search = GridSearchCV(
        network(0, 1.0),
        {"mlpregressor__alpha": PENALTIES},
        cv=folds_of(train.run),
        scoring="neg_mean_squared_error",
        refit=False,
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # stopped early is part of the regularisation
        penalty = search.fit(given, train.declared / size).best_params_["mlpregressor__alpha"]
        every = [network(k, penalty).fit(given, train.declared / size) for k in range(NETWORKS)]
    weights = sum(w.size for w in (*every[0][-1].coefs_, *every[0][-1].intercepts_))
    return Learned(f"{NETWORKS} x {weights} weights", torque, None)


RIVALS = {"sparse": sparse_regression, "network": neural_network}
FEWEST = 50  # rows of an axis, in the training and in the validation runs


def black_box(
    space: EquationSpace,
    train: Sequence[Run],
    validate: Sequence[Run],
    declared: Values,
    named: Values | None,
    size: str,
    free: FreeRuns,
) -> dict[str, Any]:
    """The torque that the declared model lacks along the measured motion, axis by axis: how much of
    it the named effects and the rivals explain, and how far off the rivals are in `free` simulation
    with their torque on the joints; as plain data.

    `declared` and `named` are the values of all parameters before and after (None: nothing was
    named), `size` says how many parameters the named effects have. The rivals learn from the rows
    of the whole `train` runs; `validate` judges all.
    """
    after = declared if named is None else named
    spaces = [space_along(space, runs, declared, after) for runs in (train, validate)]
    found, learned = {}, {}
    for axis, name in enumerate(space.model.module.AXES):
        fitted, judging = (axis_rows(part, axis, declared, after) for part in spaces)
        if min(len(fitted.run), len(judging.run)) < FEWEST:
            continue
        names = [run.name for run in validate]
        learned[name] = learn(fitted)
        found[name] = {
            "unit": "N" if space.model.is_linear(name) else "N m",
            "seen": _rows_seen(fitted),
            "rows": {"train": len(fitted.run), "validate": len(judging.run)},
            **compared(fitted, judging, names, None if named is None else size, learned[name]),
        }
    freely = {
        rival: free_error(free, {axis: own[rival].torque for axis, own in learned.items()})
        for rival in RIVALS
        if learned
    }
    return {"half_width": space.half_width, "axes": found, "free": freely}


def learn(train: AxisRows) -> dict[str, Learned]:
    """The rivals of one axis, by name."""
    with threadpool_limits(limits=1):  # matrices are small: more threads would wait for each other
        return {name: rival(train) for name, rival in RIVALS.items()}


def compared(
    train: AxisRows,
    validate: AxisRows,
    runs: Sequence[str],
    size: str | None,
    learned: Mapping[str, Learned],
) -> dict[str, Any]:
    """The residual torque of every model on the rows of one axis; `runs` are the names of the
    validation runs, `size` is that of the named effects (None: there are none).
    """
    models = {
        "declared": (None, train.declared, validate.declared),
        "named": (size, train.named, validate.named),
        **{name: (own.size, *_left_at_both(train, validate, own)) for name, own in learned.items()},
    }
    if size is None:
        del models["named"]
    return {
        "models": {
            key: {
                "size": size,
                "train": _figures(left, train.declared),
                "validate": _figures(judged, validate.declared),
                "by_run": {
                    runs[k]: _rms(judged[validate.run == k]) for k in np.unique(validate.run)
                },
            }
            for key, (size, left, judged) in models.items()
        },
        "terms": learned["sparse"].terms,
    }


def _rows_seen(rows: AxisRows) -> dict[str, dict[str, float]]:
    """Mean and deviation in SI by which what is seen is centred and scaled."""
    centre, scale = rows.seen.mean(axis=0), rows.seen.std(axis=0)
    return {
        name: {"mean": float(c), "deviation": float(s)}
        for name, c, s in zip(rows.names, centre, scale, strict=True)
    }


def _left_at_both(
    train: AxisRows, validate: AxisRows, learned: Learned
) -> tuple[FloatArray, FloatArray]:
    left = [r.declared - learned.torque(r.seen) for r in (train, validate)]
    return left[0], left[1]


def _figures(left: FloatArray, declared: FloatArray) -> dict[str, float]:
    """Rms of what is left, and the share of the declared model's mean square that is explained."""
    whole = float(declared @ declared)
    return {"rms": _rms(left), "share": 1.0 - float(left @ left) / whole if whole else 0.0}


def _rms(left: FloatArray) -> float:
    return float(np.sqrt(np.mean(left**2)))
