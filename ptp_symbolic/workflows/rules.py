"""The rules by which a diagnosis decides, and how each of them is switched off.

Stored evidence can be decided upon again without one of them: the verdicts that change are its
price (`python -m tests.benchmark price`).
"""

import inspect
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from importlib import import_module
from operator import attrgetter
from typing import Any

import numpy as np

from ptp_symbolic.numeric.diagnose.gain import Gain
from ptp_symbolic.numeric.identify.evaluate import mean_squares
from ptp_symbolic.numeric.identify.fit import Fit

DIAGNOSE = "ptp_symbolic.numeric.diagnose"
WORKFLOWS = "ptp_symbolic.workflows"

ALL_OF_IT = Gain(1.0, 1.0, 1.0, np.inf, 1, 0.0)  # all of the error, beyond doubt


@dataclass(frozen=True)
class Rule:
    """A rule by its `name`, and what it `asks`.

    `where` are the constants and functions, as `module:name`, that hold it; without the rule they
    are as `off` says: a value. `price` is what is known to go wrong without it, or why it is kept.
    """

    name: str
    asks: str
    where: tuple[str, ...]
    off: Any
    price: str = ""

    def at(self, value: float) -> "Rule":
        """The rule with another value of what it compares with, in place of being off."""
        owner, name = self.targets()[0]
        return replace(self, off=_always(value) if callable(vars(owner)[name]) else value)

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


def _as_it_is(stepwise: Any, trial: Any, steps: Any, fit: Any, alike: Any) -> Any:
    """A set with all that belongs to it."""
    return trial, steps, fit, alike


def _left_as_fitted(after: Fit, *others: Any) -> Any:
    """The residuals of validation runs with the values of the fit."""
    return mean_squares(after.evaluations, after.runs)


def _white(problem: Any, fit: Fit, propagated: Any) -> Any:
    """A noise floor of white noise."""
    return (np.ones(len(fit.runs[0].signals)),) * 2


def _in(module: str, *names: str, package: str = DIAGNOSE) -> tuple[str, ...]:
    return tuple(f"{package}.{module}:{name}" for name in names)


RULES = (
    Rule(
        "material",
        "A set, or a member of one, reduces the sum of squares by a material share (10 %, or"
        " `[fit] material`).",
        _in("preparation", "material_of", package=WORKFLOWS),
        _always(0.0),
        "12 of 14 sets need refits; stated level",
    ),
    Rule(
        "significant",
        "What a member gains is above zero, significant at 5 %, over all that was compared.",
        _in("stepwise", "is_significant"),
        _always(True),
        "387 and 357 need refits; stated level",
    ),
    Rule(
        "most beside a remainder",
        "Where more than noise remains, the lower limit of a member's share is above one half.",
        _in("gain", "Gain.is_most"),
        True,
        "370, 342 and 387 need refits; set 254 (a wrong name)",
    ),
    Rule(
        "in innovations",
        "Where more than noise remains, a member reduces more than slow drift.",
        _in("confirm", "gain_in_innovations"),
        _always(ALL_OF_IT),
        "safety: slow drift is credited to any effect",
    ),
    Rule(
        "not the noise of the inputs",
        "Without a member, the residual exceeds the propagated noise of the inputs.",
        _in("confirm", "is_within_noise_of_inputs"),
        _always(False),
        "safety: a torque of 7e-7 N m was named on perfect direct drives",
    ),
    Rule(
        "amount known",
        "Where more than noise remains, the amount of a member differs significantly from zero.",
        _in("confirm", "is_amount_known"),
        _always(True),
        "342 and 387 need refits; an interval held zero",
    ),
    Rule(
        "not done by others",
        "Where noise alone remains, other parameters within bounds cannot reproduce a member.",
        _in("confirm", "is_reproduced_by_others"),
        _always(False),
        "log-l (a payload for an inertia that was stuck)",
    ),
    Rule(
        "harmonics",
        "The first harmonic of a member is the largest where it must be.",
        _in("confirm", "first_dominates"),
        _always(True),
        "definition of such an effect; viscous friction by angle was an encoder's error",
    ),
    Rule(
        "bounds",
        "No parameter of a member ends on a bound.",
        _in("confirm", "at_bound"),
        _always(None),
        "safety: at the end of its range an effect is another one",
    ),
    Rule(
        "any run left out",
        "More than half of a member is found without any one run.",
        _in("confirm", "depends_on_run"),
        _always(None),
        "safety: an effect that runs contradict (not where one run holds all that is known of it)",
    ),
    Rule(
        "law of the speed",
        "The torque of a member depends on the speed as its law says.",
        (*_in("confirm", "contradicts_its_law"), *_in("along_rows", "contradicts_its_law")),
        _always(False),
        "set 261 (a wrong name)",
    ),
    Rule(
        "inputs move it",
        "The inputs move the fitted model by more than its residual.",
        tuple(
            place
            for module in ("confirm", "structures", "along_rows")
            for place in _in(module, "is_moved_by_inputs")
        ),
        _always(True),
        "safety: free initial states alone follow the logs",
    ),
    Rule(
        "better alternatives",
        "No other set of the same size predicts significantly better.",
        _in("verdict", "better_alternative"),
        _always(None),
        "safety: the best of indistinguishable sets is named",
    ),
    Rule(
        "smaller alternatives",
        "No alternative with fewer effects has a white residual.",
        _in("verdict", "smaller_alternative"),
        _always(None),
        "safety: two effects where one will do",
    ),
    Rule(
        "simplest alternative",
        "Of one effect and its alternatives the one with the fewest parameters is named.",
        _in("verdict", "simplest_alternative"),
        _as_it_is,
        "definition: fewest parameters of a group",
    ),
    Rule(
        "all alternatives",
        "Effects that resemble a named one are refitted in its place, and may form a group.",
        _in("verdict", "refitted_alternatives"),
        _always([]),
        "safety: a group in place of one name",
    ),
    Rule(
        "alternatives within the noise of the inputs",
        "An alternative within the propagated noise of the inputs is not refuted.",
        _in("groups", "is_within_noise_of_inputs"),
        _always(False),
        "set 189 (a wrong name)",
    ),
    Rule(
        "ambiguous values",
        "Where more than noise remains, no declared value is blamed that has alternatives.",
        _in("verdict", "ambiguous_value"),
        _always(None),
        "safety: declared values imitate much",
    ),
    Rule(
        "every member validated",
        "The validation runs are not predicted significantly better without a member.",
        _in("verdict", "rejected_on_validation"),
        _always(None),
        "safety: an effect that validation runs contradict",
    ),
    Rule(
        "validated",
        "The validation runs gain a material share (50 % where they show more than noise),"
        " significantly where they are 12 blocks or more.",
        (
            *_in("verdict", "is_validated"),
            *_in("structure_choice", "is_validated", package=WORKFLOWS),
        ),
        _always(True),
        "safety: names hold on runs that were never fitted; set 409 (a wrong name)",
    ),
    Rule(
        "unusual noise validated",
        "Where training runs show unusually large noise, validation runs gain significantly.",
        _in("verdict", "exceeds_usual_noise"),
        _always(False),
        "set 273 (a wrong name)",
    ),
    Rule(
        "values of the joint region",
        "Validation runs are judged with values in the joint confidence region.",
        _in("verdict", "left_by_best_values"),
        _left_as_fitted,
        "set 271 (explained by a wrong name); 337 partly explained without",
    ),
    Rule(
        "windows alike",
        "Residuals of validation windows rank no higher than those of training windows (0.1 %).",
        _in("gain", "UNALIKE"),
        -1.0,
        "safety: a lack in some windows alone",
    ),
    Rule(
        "no run far off",
        "The residual of no validation run exceeds eight times its noise.",
        _in("gain", "NEARBY"),
        np.inf,
        "safety: a lack in one run alone",
    ),
    Rule(
        "colour of the noise",
        "The noise floor has the autocorrelation of the residual, as far as rests and runs allow.",
        _in("noise_floor", "_of_its_colour"),
        _white,
        "413, 386, 418, 370, 346 and 342 need refits",
    ),
    Rule(
        "along the motion",
        "Where more than noise remains, a set is extended by gains in the torque along the motion.",
        _in("verdict", "extended_along_motion"),
        _always(None),
        "EMPS (friction beside friction, a delay); the servo pendulum (no name)",
    ),
    Rule(
        "declared model over windows",
        "Gains are those over the declared model fitted over windows too.",
        _in("verdict", "with_declared_over_windows"),
        _given(0),
        "log-d needs a refit",
    ),
    Rule(
        "structure identifiable",
        "A parameter of an added structure is identifiable; beside noise alone, off its bounds.",
        _in("structures", "is_there"),
        _always(True),
        "set 353 (a wrong name, a harmonic drive for a gap)",
    ),
    Rule(
        "simpler structures",
        "Of structures that predict as well the one with the fewest parameters is followed.",
        _in("structures", "_is_as_good"),
        _always(False),
        "definition: fewest parameters of equals",
    ),
    Rule(
        "parts of a structure",
        "No structure that a named one contains predicts as well.",
        _in("structure_choice", "part_as_good", package=WORKFLOWS),
        _always(None),
        "safety: a gap beside a shaft that is not identifiable (an antenna, a wrong name)",
    ),
    Rule(
        "better terms",
        "No terms of the declared structure, confirmed or not, predict significantly better.",
        _in("structure_choice", "is_beaten_by_terms", package=WORKFLOWS),
        _always(False),
        "safety: a structure in place of terms that are not confirmed",
    ),
    Rule(
        "better structures",
        "Named terms that predict worse than what a structure has form a group with it.",
        _in("structure_choice", "beats_terms", package=WORKFLOWS),
        _always(False),
        "safety: a delay in place of a lag that is not confirmed",
    ),
    Rule(
        "alternative structures",
        "Structures that predict as well as the chosen one form a group with it; where more than"
        " noise remains, all that come near it.",
        _in("structure_choice", "alternatives", package=WORKFLOWS),
        _always([]),
        "an antenna (a lag in place of a shaft)",
    ),
    Rule(
        "simplest forms",
        "Every member has the simplest form that loses nothing material and significant.",
        (*_in("search", "simplified"), *_in("confirm", "simplified")),
        _given(1),
        "346, 387 and 357 need refits",
    ),
    Rule(
        "restarts",
        "A set is fitted again from other starts and over windows, unless its residual is noise.",
        _in("stepwise", "StepwiseSearch.restarted"),
        _given(1),
        "387, 390 and 409 need refits",
    ),
    Rule(
        "floating",
        "A set is extended again without one of its members.",
        _in("search", "floated"),
        lambda stepwise, best, steps: (best, steps),
        "none in 35 sets; a torque in place of a spring (test_search_roads)",
    ),
    Rule(
        "effects alone",
        "A set is searched for among effects alone, without declared values.",
        _in("search", "by_effects_alone"),
        lambda stepwise, best, steps, end=None: (best, steps),
        "271 and 409 need refits; a spring behind declared values (test_search)",
    ),
    Rule(
        "far starts",
        "Declared parameters that are weakly identified by the rows are started far off too.",
        _in("search", "_better_from_far_off"),
        _given(1),
        "374 needs refits; set 228 (a shaft damping of 2.30 for 0.62)",
    ),
    Rule(
        "declared model restarted",
        "The declared model is fitted again from the end of a set.",
        _in("search", "_declared_after"),
        lambda stepwise, trial: stepwise.declared if trial.candidates else trial,
        "048 and 228 unchanged after a refit; friction for a stuck fit (test_search_roads)",
    ),
    Rule(
        "windows where errors grow",
        "The search restarts in windows where a set multiplies small errors.",
        _in("search", "_in_windows"),
        _always(None),
        "a cogging of 48 per turn (unexplained without)",
    ),
    Rule(
        "each through windows",
        "Effects without influence on the rows are fitted over growing windows.",
        _in("search", "each_through_windows"),
        _always([]),
        "sets 071 and 072 (missed without)",
    ),
    Rule(
        "lines of the outputs",
        "Frequencies of waves are looked for in the outputs too.",
        _in("search", "at_lines_of_outputs"),
        _always(()),
        "set 014 (missed without)",
    ),
)


def table() -> str:
    """The rules as a table of the documentation, each with the functions that hold it."""
    rows = ["| Rule | It asks | Price | Defined in |", "|---|---|---|---|"]
    for rule in RULES:
        places = dict.fromkeys(map(_definition, rule.where))
        rows.append(
            f"| {rule.name} | {rule.asks} | {rule.price} | {', '.join(f'`{p}`' for p in places)} |"
        )
    return "\n".join(rows) + "\n"


def _definition(place: str) -> str:
    """Where what is called at a `place` is defined; the place itself of a number."""
    module, name = place.split(":")
    found = inspect.unwrap(attrgetter(name)(import_module(module)))
    own = f"{found.__module__}.{found.__qualname__}" if callable(found) else place.replace(":", ".")
    return own.removeprefix("ptp_symbolic.")
