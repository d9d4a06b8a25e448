"""Two rivals that know no physics: sparse regression and a small neural network.

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

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.identify.equation_space import EquationSpace
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.weak_form import weak_average

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
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
