"""Many small deviations at once, as real machines have them: none dominates, none has a name.

Stribeck's exponent below 2, a curved viscous law, nameplate values off by up to 1 %, cogging of
three frequencies, transmission error of two harmonics, friction by angle of three harmonics,
friction by load, a short delay, a soft contact, a slow random torque. Together they leave 2 to 8
floors after a refit of the declared parameters.
"""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from tests.benchmark.effects import Numbers, Shape
from tests.benchmark.machine import Floats, Machine, Values
from tests.benchmark.sizing import AbsorbedError, Yardstick

TOTAL_FLOORS = (2.0, 8.0)
LARGEST_PART = 0.2  # of the mean square, for any one deviation
TOLERATED_PART = 0.27  # after joint scaling
PROBES = 2  # of the size of one deviation
TARGET_ACCURACY = 0.2
EVEN_ENOUGH = 1.05  # of the largest part


def _sign(rng: np.random.Generator) -> float:
    """Plus or minus one."""
    return 1.0 if rng.random() < 0.5 else -1.0


def _nameplate(machine: Machine, values: Values, rng: np.random.Generator) -> Iterator[Shape]:
    """Known values that are up to 1 % off."""
    names = ["c_x_payload"]
    if machine.voltage_driven:
        names += [f"{name}_{axis}" for name in ("R", "K_t") for axis in machine.axes]
    if len(machine.axes) > 1:
        names += ["J_pan", "J_y_tilt"]
    for name in names:
        value = values[name]
        yield Shape({name: _sign(rng) * value}, {name: value}, guess=0.005, limit=0.01)


def _waves(rng: np.random.Generator, axis: str, names: tuple[str, str], count: int) -> Numbers:
    """Sine and cosine parts of `count` harmonics, each with a phase of its own."""
    parts = {}
    for number in range(1, count + 1):
        size, phase = rng.uniform(0.5, 1.0), rng.uniform(-math.pi, math.pi)
        suffix = axis if number == 1 else f"{number}_{axis}"
        parts[f"{names[0]}_{suffix}"] = float(size * np.cos(phase))
        parts[f"{names[1]}_{suffix}"] = float(size * np.sin(phase))
    return parts


def _on_axis(
    machine: Machine, values: Values, rng: np.random.Generator, axis: str
) -> Iterator[Shape]:
    """Deviations of one drive."""
    coulomb = values[f"F_c_{axis}"]
    if values.get(f"F_s_{axis}", coulomb) > coulomb:
        name = f"stribeck_exponent_{axis}"
        yield Shape({name: -1.0}, {name: 2.0}, guess=0.3, limit=1.0)
    name = f"viscous_exponent_{axis}"
    yield Shape({name: -1.0}, {name: 1.0}, guess=0.02, limit=0.1)
    counts = np.exp(rng.uniform(math.log(3.0), math.log(90.0), 3))
    cycles = {f"n_cog_{k}{axis}": float(n) for k, n in zip(("", "2_", "3_"), counts, strict=True)}
    cogging = _waves(rng, axis, ("T_sin", "T_cos"), 3)
    yield Shape(cogging, cycles, guess=0.03 * coulomb, limit=0.5 * coulomb)
    friction = _waves(rng, axis, ("f_sin", "f_cos"), 3)
    yield Shape(friction, guess=0.02, limit=0.3)
    yield Shape({f"mu_load_{axis}": 1.0}, guess=0.005, limit=0.01)
    late = f"t_delay_{axis}"
    yield Shape({late: 1.0}, {late: values.get(late, 0.0)}, guess=1e-4, limit=3e-4)
    yield Shape({f"gust_torque_{axis}": 1.0}, guess=0.01 * coulomb, limit=0.3 * coulomb)
    if f"gap_{axis}" in values:
        yield Shape(_waves(rng, axis, ("g_sin", "g_cos"), 2), guess=2e-4, limit=5e-3)
        yield Shape({f"contact_softness_{axis}": 1.0}, guess=5e-5, limit=5e-4)


def draw_deviations(machine: Machine, values: Values, rng: np.random.Generator) -> list[Shape]:
    """All small deviations that the machine can have, each with a size of its own."""
    shapes = list(_nameplate(machine, values, rng))
    for axis in machine.axes:
        shapes += _on_axis(machine, values, rng, axis)
    if any(name.startswith("gap_") for name in values):
        return shapes  # in a gap the load falls to one side, however small the lean
    azimuth = {"alpha_base": float(rng.uniform(-math.pi, math.pi))}
    return [*shapes, Shape({"beta_base": 1.0}, azimuth, guess=5e-4, limit=5e-3)]


def _joint(shapes: list[Shape], sizes: Floats) -> Numbers:
    """Parameters of all deviations together."""
    values: Numbers = {}
    for shape, size in zip(shapes, sizes, strict=True):
        values |= shape.values(float(size))
    return values


def _floors(yardstick: Yardstick, hidden: Values) -> float:
    """Response in floors rms, of the output that shows most."""
    return yardstick.largest(yardstick.change(hidden)[0])


def _alone(yardstick: Yardstick, shapes: list[Shape], sizes: Floats) -> Floats:
    """Floors rms that each deviation leaves on its own."""
    return np.array(
        [_floors(yardstick, shape.values(s)) for shape, s in zip(shapes, sizes, strict=True)]
    )


def _balanced(yardstick: Yardstick, shapes: list[Shape], target: float) -> Floats:
    """Sizes at which all deviations leave about the same on their own."""
    wanted = target * math.sqrt(min(1.3 / len(shapes), LARGEST_PART))
    sizes = np.empty(len(shapes))
    for k, shape in enumerate(shapes):
        size = shape.guess
        for _ in range(PROBES):
            left = max(_floors(yardstick, shape.values(size)), 1e-9)
            factor = max(min(wanted / left, shape.limit / size), 1e-3)
            size *= factor
            if 0.3 < factor < 3.0:
                break
        sizes[k] = size
    return sizes


def _to_target(
    yardstick: Yardstick, shapes: list[Shape], sizes: Floats, target: float
) -> tuple[Floats, float]:
    """Sizes scaled together within their limits, and the floors that they leave then."""
    limits = np.array([shape.limit for shape in shapes])
    for last in (False, False, True):
        total = _floors(yardstick, _joint(shapes, sizes))
        if last or abs(total / target - 1.0) < TARGET_ACCURACY or np.all(sizes >= limits):
            break
        sizes = np.minimum(sizes * target / total, limits)
    return sizes, total


def scaled(
    machine: Machine, yardstick: Yardstick, rng: np.random.Generator
) -> tuple[Numbers, dict[str, Any]]:
    """Parameters of all deviations, and what is to be told of them.

    Raises AbsorbedError if they cannot reach the total, or if one of them dominates.
    """
    shapes = draw_deviations(machine, yardstick.values, rng)
    target = float(np.exp(rng.uniform(*np.log(TOTAL_FLOORS))))
    sizes = _balanced(yardstick, shapes, target)
    for last in (False, False, True):
        sizes, total = _to_target(yardstick, shapes, sizes, target)
        alone = _alone(yardstick, shapes, sizes)
        excess = alone / (total * math.sqrt(LARGEST_PART))
        if last or np.all(excess <= EVEN_ENOUGH):
            break
        sizes /= np.maximum(1.2 * excess, 1.0)
    part = float(np.max(np.square(alone)) / total**2)
    if not 0.9 * TOTAL_FLOORS[0] <= total <= 1.1 * TOTAL_FLOORS[1] or part > TOLERATED_PART:
        raise AbsorbedError(f"deviations leave {total:.1f} floors, the largest {part:.2f} of them")
    record = {
        "deviations": ["+".join(shape.slope) for shape in shapes],
        "sizes": sizes.tolist(),
        "response_floors_alone": alone.tolist(),
        "response_floors": total,
        "largest_part": part,
    }
    return _joint(shapes, sizes), record
