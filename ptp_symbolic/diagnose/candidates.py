"""Candidates: effects that the declared machine may lack, and declared values that may be wrong."""

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ptp_symbolic.identify.coordinates import FreeParameter, free_parameter
from ptp_symbolic.runtime.model import Model, ModelParameter

DECLARED_VALUE = "declared_value"


@dataclass(frozen=True)
class Candidate:
    """One explanation: its id and axis, and for every start the parameters to be freed."""

    id: str
    axis: str | None
    title: str
    separating_experiment: str
    starts: tuple[tuple[FreeParameter, ...], ...]

    @property
    def key(self) -> str:
        """Id and axis in one word, e.g. ``cable_spring@pan``."""
        return self.id if self.axis is None else f"{self.id}@{self.axis}"

    @property
    def is_declared_value(self) -> bool:
        """True where it frees a value that the platform declares as known."""
        return self.id.startswith(DECLARED_VALUE)

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of the parameters that it frees."""
        return tuple(f.name for f in self.starts[0])


def find_candidates(
    model: Model, declared: Sequence[str], known: Mapping[str, float]
) -> tuple[Candidate, ...]:
    """Candidates in the emitted union `model`: effects not in `declared`, then `known` values."""
    by_name = {p.name: p for p in model.parameters}
    found = [
        Candidate(
            effect.id,
            effect.axis,
            effect.title,
            effect.separating_experiment,
            tuple(_starts([by_name[name] for name in effect.parameters])),
        )
        for effect in model.effects
        if effect.key not in declared and effect.parameters
    ]
    for name, value in known.items():
        parameter = by_name.get(name)
        if parameter is not None and value != 0.0 and parameter.lower < value < parameter.upper:
            freed = free_parameter(name, value, parameter.lower, parameter.upper)
            title = f"declared value of {name} is wrong ({parameter.meaning})"
            found.append(
                Candidate(
                    f"{DECLARED_VALUE}:{name}", None, title,
                    f"Measure {name} on its own, apart from the machine.", ((freed,),),
                )
            )  # fmt: skip
    return tuple(found)


def _starts(parameters: Sequence[ModelParameter]) -> list[tuple[FreeParameter, ...]]:
    grid = itertools.product(*(p.starts or (p.default,) for p in parameters))
    return [
        tuple(
            free_parameter(p.name, value, p.lower, p.upper, p.period)
            for p, value in zip(parameters, point, strict=True)
        )
        for point in grid
    ]


def vanished(model: Model, declared: Sequence[str]) -> dict[str, float]:
    """Parameter values at which every effect outside `declared` is off."""
    by_name = {p.name: p for p in model.parameters}
    return {
        name: by_name[name].default if by_name[name].vanishes is None else by_name[name].vanishes  # type: ignore[misc]
        for effect in model.effects
        if effect.key not in declared
        for name in effect.parameters
    }
