"""What comes before any fit: logs looked at, runs matched to the model, workers."""

from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager

from threadpoolctl import threadpool_limits

from ptp_symbolic.models import emission, variants
from ptp_symbolic.models.declared import free_parameters, known_values, refuse_unknown_signals
from ptp_symbolic.numeric.data import Log, refuse_motionless, refuse_wrapped_angles, remarks
from ptp_symbolic.numeric.diagnose.fitted_model import FittedModel, SearchProblem, usable_cores
from ptp_symbolic.numeric.diagnose.preparation import problem_of
from ptp_symbolic.numeric.identify.ahead import FIT, begin_fit
from ptp_symbolic.numeric.identify.constants import MATERIAL
from ptp_symbolic.numeric.identify.evidence import Allowance, InTurn, Threads, simulates
from ptp_symbolic.numeric.identify.run_preparation import prepare_runs
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.ahead import (
    HELD_SAMPLES,
    RUNNER,
    SAMPLED_RUNNER,
    compile_ahead,
    wait_until_compiled,
)
from ptp_symbolic.platform import (
    EffectDeclaration,
    ParameterDeclaration,
    Platform,
    effect_key,
    naming_file,
)
from ptp_symbolic.symbolic.derivation.placement import place_effects
from ptp_symbolic.workflows.result import Progress


@contextmanager
def workers() -> Iterator[Executor]:
    """One thread per core that the process may use, for runs side by side; threads of the linear
    algebra would be in their way.
    """
    threads = Threads(usable_cores()) if simulates() else InTurn()
    with threadpool_limits(limits=1), threads as executor:
        yield executor


def effect_keys(platform: Platform) -> list[str]:
    """Keys of the declared effects, ``effect`` or ``effect@axis``."""
    return [effect_key(e.effect, e.axis) for e in platform.effects]


def material_of(platform: Platform) -> float:
    """The share of the error that an effect has to take away for a name."""
    return MATERIAL if platform.material is None else platform.material


def model_of(platform: Platform) -> Model:
    """The model of a platform; on a new machine, its kernels are compiled meanwhile."""
    placed = place_effects(platform)
    begin_fit()
    if any(effect.turning_contribution_at(at).samplers for effect, at in placed):
        compile_ahead(SAMPLED_RUNNER)
    else:
        compile_ahead(RUNNER, HELD_SAMPLES)
    return emission.emit(platform)


def look_at(
    platform: Platform, train: Sequence[Log], every: Sequence[Log], progress: Progress
) -> tuple[str, ...]:
    """Refuse logs that cannot be used, and say what is odd about the others before any fit."""
    refuse_wrapped_angles(every, platform)
    refuse_motionless(train, platform)
    noted = remarks(train, platform)
    for text in noted:
        progress(text)
    return noted


def problem_for(
    platform: Platform,
    model: Model,
    train: Iterable[Log],
    validate: Iterable[Log],
    declared: Sequence[str],
    executor: Executor,
    progress: Progress,
    allowance: Allowance | None = None,
) -> SearchProblem:
    """All that stays the same; `declared` are the keys of the effects that are not candidates, and
    `allowance` is what the search may take (None: no limit).
    """
    progress("preparing the simulation")
    wait_until_compiled(FIT)
    refuse_unknown_signals(platform, model)
    allowance = Allowance() if allowance is None else allowance
    with naming_file(platform):
        runs = [
            prepare_runs(model, platform, tuple(logs), allowance.work) for logs in (train, validate)
        ]
    free, known = free_parameters(platform, model), known_values(platform, model)
    noises = {s.signal: s.noise for s in platform.signals}
    return problem_of(
        model,
        runs[0],
        runs[1],
        free,
        known,
        declared,
        noises,
        platform.window,
        material_of(platform),
        executor,
        progress,
        allowance,
    )


def with_effects(platform: Platform, after: FittedModel, *, moves: bool = True) -> Platform:
    """`platform` with the accepted effects, and every fitted value as the new start. Without
    `moves`, parameters that `platform` declares as free keep the starts that it declares.
    """
    bounds = {p.name: p for p in after.fit.model.parameters}
    have = {(e.effect, e.axis) for e in platform.effects}
    added = [
        EffectDeclaration(c.id, c.axis, None)
        for c in after.candidates
        if not c.is_declared_value and (c.id, c.axis) not in have
    ]
    fitted = [
        ParameterDeclaration(
            name,
            bounds[name].unit,
            after.values[name],
            True,
            bounds[name].lower,
            bounds[name].upper,
        )
        for c in after.candidates
        for name in c.parameters
    ]
    before = {p.name for p in platform.parameters if p.free}
    values = {n: v for n, v in after.values.items() if moves or n not in before}
    return variants.extended(platform, added, values, fitted)
