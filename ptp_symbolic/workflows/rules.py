"""The rules by which a diagnosis decides, and how each of them is switched off.

Stored evidence can be decided upon again without one of them: the verdicts that change are its
price (`python -m tests.benchmark price`).
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np

from ptp_symbolic.numeric.diagnose.gain import Gain
from ptp_symbolic.numeric.identify.evaluate import mean_squares
from ptp_symbolic.numeric.identify.fit import Fit

DIAGNOSE = "ptp_symbolic.numeric.diagnose"
WORKFLOWS = "ptp_symbolic.workflows"

CERTAIN = Gain(1.0, 1.0, 1.0, np.inf, 1, 0.0)  # all of the error, beyond doubt


@dataclass(frozen=True)
class Rule:
    """A rule by its `name`, and what it `asks`.

    `where` are the constants and functions, as `module:name`, that hold it; without the rule they
    are as `off` says: a value.
    """

    name: str
    asks: str
    where: tuple[str, ...]
    off: Any

    def targets(self) -> list[tuple[Any, str]]:
        """The modules or classes that hold it, with the name in each. Raises AttributeError for a
        name that is not there.
        """
        found = []
        for place in self.where:
            module, _, path = place.partition(":")
            *outer, name = path.split(".")
            owner: Any = import_module(module)
            for one in outer:
                owner = getattr(owner, one)
            getattr(owner, name)
            found.append((owner, name))
        return found


@contextmanager
def switched_off(rule: Rule | None) -> Iterator[None]:
    """Decide without a rule (None: with all of them), in all threads."""
    targets = [] if rule is None else rule.targets()
    before = [vars(owner)[name] for owner, name in targets]
    try:
        for owner, name in targets:
            setattr(owner, name, rule.off if rule else None)
        yield
    finally:
        for (owner, name), value in zip(targets, before, strict=True):
            setattr(owner, name, value)


def _always(value: Any) -> Callable[..., Any]:
    """A function that gives a value whatever it is asked."""
    return lambda *args, **kwargs: value


def _given(number: int) -> Callable[..., Any]:
    """A function that gives its argument of this number as it is."""
    return lambda *args, **kwargs: args[number]


def _as_it_is(seeker: Any, trial: Any, steps: Any, fit: Any, alike: Any) -> Any:
    """A set with all that belongs to it."""
    return trial, steps, fit, alike


def _left_as_fitted(after: Fit, *others: Any) -> Any:
    """What validation runs leave with the values of the fit."""
    return mean_squares(after.evaluations, after.runs)


def _white(task: Any, fit: Fit, carried: Any) -> Any:
    """A floor of white noise."""
    return (np.ones(len(fit.runs[0].signals)),) * 2


def _in(module: str, *names: str, package: str = DIAGNOSE) -> tuple[str, ...]:
    return tuple(f"{package}.{module}:{name}" for name in names)


RULES = (
    Rule(
        "material",
        "A set, or a member of one, reduces the sum of squares by a material share (10 %).",
        _in("preparation", "MATERIAL", package=WORKFLOWS),
        0.0,
    ),
    Rule(
        "significant",
        "What a member gains is significant at 5 %, over all that was looked at.",
        _in("seeker", "FALSE_ALARM"),
        np.inf,
    ),
    Rule(
        "most beside a remainder",
        "Where more than noise remains, a member surely explains more of the error than remains.",
        _in("gain", "Gain.is_most"),
        True,
    ),
    Rule(
        "in innovations",
        "Where more than noise remains, a member reduces more than slow drift.",
        _in("confirm", "gain_in_innovations"),
        _always(CERTAIN),
    ),
    Rule(
        "not the noise of the inputs",
        "Without a member, more is left than the noise of the inputs leaves.",
        _in("confirm", "leaves_noise_of_inputs"),
        _always(False),
    ),
    Rule(
        "amount known",
        "Where more than noise remains, the amount of a member is significantly above none.",
        _in("confirm", "is_amount_known"),
        _always(True),
    ),
    Rule(
        "not done by others",
        "Where noise alone remains, no change of other parameters within bounds does the same.",
        _in("confirm", "is_done_by_others"),
        _always(False),
    ),
    Rule(
        "harmonics",
        "The first harmonic of a member is the largest where it must be.",
        _in("confirm", "leads"),
        _always(True),
    ),
    Rule(
        "bounds",
        "No parameter of a member ends on a bound.",
        _in("confirm", "at_bound"),
        _always(None),
    ),
    Rule(
        "any run left out",
        "More than half of a member is found without any one run.",
        _in("confirm", "unstable_without"),
        _always(None),
    ),
    Rule(
        "law of the speed",
        "The torque of a member goes with the speed as its law says.",
        (*_in("confirm", "breaks_its_law"), *_in("along_rows", "breaks_its_law")),
        _always(False),
    ),
    Rule(
        "inputs move it",
        "The inputs move the fitted model by more than it leaves.",
        tuple(
            place
            for module in ("confirm", "structures", "along_rows")
            for place in _in(module, "answers_to_inputs")
        ),
        _always(True),
    ),
    Rule(
        "better alternatives",
        "No other set of the same size predicts significantly better.",
        _in("verdict", "overtaking"),
        _always(None),
    ),
    Rule(
        "smaller alternatives",
        "No alternative leaves noise alone with fewer effects.",
        _in("verdict", "leaner_rival"),
        _always(None),
    ),
    Rule(
        "simplest alternative",
        "Of one effect and its alternatives the one with the fewest parameters is named.",
        _in("verdict", "simplest_alike"),
        _as_it_is,
    ),
    Rule(
        "all alternatives",
        "What the logs cannot tell from a named effect is refitted, and forms a group with it.",
        _in("verdict", "rivals"),
        _always([]),
    ),
    Rule(
        "alternatives within the noise of the inputs",
        "An alternative that leaves no more than the noise of the inputs is not refuted.",
        _in("groups", "leaves_noise_of_inputs"),
        _always(False),
    ),
    Rule(
        "ambiguous values",
        "Where more than noise remains, no declared value is blamed that has alternatives.",
        _in("verdict", "doubtful"),
        _always(None),
    ),
    Rule(
        "every member validated",
        "The validation runs are not predicted significantly better without a member.",
        _in("verdict", "denied"),
        _always(None),
    ),
    Rule(
        "validated",
        "The validation runs gain a material share (50 % where they show more than noise).",
        (
            *_in("verdict", "is_borne_out"),
            *_in("structure_choice", "is_borne_out", package=WORKFLOWS),
        ),
        _always(True),
    ),
    Rule(
        "unusual noise validated",
        "Where training runs leave unusually much noise, validation runs gain significantly.",
        _in("verdict", "leaves_unusual_noise"),
        _always(False),
    ),
    Rule(
        "values of the joint region",
        "Validation runs are judged with values in the joint confidence region.",
        _in("verdict", "left_by_best_values"),
        _left_as_fitted,
    ),
    Rule(
        "windows alike",
        "Validation windows leave no more than training windows do (ranks, 0.1 %).",
        _in("gain", "UNALIKE"),
        -1.0,
    ),
    Rule(
        "no run far off",
        "No validation run leaves more than eight times its noise.",
        _in("gain", "NEARBY"),
        np.inf,
    ),
    Rule(
        "colour of the noise",
        "The noise floor has the autocorrelation of the residual, as far as rests and runs allow.",
        _in("noise_floor", "_of_its_colour"),
        _white,
    ),
    Rule(
        "along the motion",
        "Where more than noise remains, a set grows by what gains in the torque along the motion.",
        _in("verdict", "grown_along_motion"),
        _always(None),
    ),
    Rule(
        "declared model over windows",
        "What a set gains is told over the declared model led over windows too.",
        _in("verdict", "as_fitted_alone"),
        _given(0),
    ),
    Rule(
        "structure identifiable",
        "Some parameter of an added structure is identifiable.",
        _in("structures", "is_told"),
        _always(True),
    ),
    Rule(
        "simpler structures",
        "Of structures that predict as well the one with the fewest parameters is followed.",
        _in("structures", "_is_as_good"),
        _always(False),
    ),
    Rule(
        "alternative structures",
        "Structures that predict as well as the chosen one form a group with it.",
        _in("structure_choice", "alternatives", package=WORKFLOWS),
        _always([]),
    ),
    Rule(
        "simplest forms",
        "Every member has the simplest form that loses nothing clear and material.",
        (*_in("search", "simplified"), *_in("confirm", "simplified")),
        _given(1),
    ),
    Rule(
        "restarts",
        "A set is fitted again from other starts and over windows, unless its residual is noise.",
        _in("seeker", "Seeker.restarted"),
        _given(1),
    ),
    Rule(
        "exchanges",
        "A member is exchanged for another where that fits better.",
        _in("seeker", "Seeker.exchanged"),
        _always(None),
    ),
    Rule(
        "floating",
        "A set is grown again without one of its members.",
        _in("search", "floated"),
        lambda seeker, best, steps: (best, steps),
    ),
    Rule(
        "effects alone",
        "A set is searched for among effects alone, without declared values.",
        _in("search", "by_effects_alone"),
        lambda seeker, best, steps, end=None: (best, steps),
    ),
    Rule(
        "far starts",
        "Declared parameters that the rows do not tell are begun far off too.",
        _in("search", "_better_from_far_off"),
        _given(1),
    ),
    Rule(
        "declared model led",
        "The declared model is fitted from where a set ended.",
        _in("search", "_led_by"),
        lambda seeker, trial: seeker.declared if trial.candidates else trial,
    ),
    Rule(
        "windows where errors grow",
        "The search begins again in windows where a set multiplies small errors.",
        _in("search", "_in_windows"),
        _always(None),
    ),
    Rule(
        "each through windows",
        "Effects that the motion does not show are led over growing windows.",
        _in("search", "each_through_windows"),
        _always([]),
    ),
    Rule(
        "lines of the outputs",
        "Frequencies of waves are looked for in the outputs too.",
        _in("search", "at_lines_of_outputs"),
        _always(()),
    ),
)


def table() -> str:
    """The rules as a table of the documentation."""
    rows = ["| Rule | It asks | Where |", "|---|---|---|"]
    for rule in RULES:
        places = [p.removeprefix("ptp_symbolic.").replace(":", ".") for p in rule.where]
        rows.append(f"| {rule.name} | {rule.asks} | {', '.join(f'`{p}`' for p in places)} |")
    return "\n".join(rows) + "\n"
