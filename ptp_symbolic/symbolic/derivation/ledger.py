"""The energy ledger of a machine: what is stored, what comes in, what is lost."""

from collections.abc import Callable, Iterable

import sympy as sp

from ptp_symbolic.symbolic.derivation.contributions import Contributions
from ptp_symbolic.symbolic.derivation.equations import Ledger
from ptp_symbolic.symbolic.effect_interface.contribution import Contribution, Friction
from ptp_symbolic.symbolic.effect_interface.place import slide
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.mechanics.bodies import RigidEquations
from ptp_symbolic.symbolic.symbols import ZERO


def energy_ledger(
    axes: Iterable[str],
    contributions: Contributions,
    frictions: Iterable[Friction],
    shafts: Iterable[Ledger],
    rigid: RigidEquations,
) -> Ledger:
    """Sum the ledgers of bodies, drives, shafts, `frictions` and effects.

    Power comes in by torque inputs, at the terminals of motors, and by a base that moves as its
    parameters say: the partial derivative by time of a potential. `rigid` has the energies of the
    bodies relative to a base whose motion is measured, as if it stood still.
    """
    powers = (contributions.input_torque(a) * contributions.drive_rate(a) for a in axes)
    total = Ledger(rigid.kinetic + rigid.potential, sum(powers, ZERO))
    for contribution in contributions.by_effect:
        total += ledger_of(contribution, contributions.drive_rate)
    for friction in frictions:
        total += Ledger(dissipated=slide(friction.axis) * friction.level * friction.rate)
    stored, power_in, dissipated = map(contributions.resolve, sum(shafts, total).parts)
    return Ledger(stored, power_in + sp.diff(stored, kinematics.TIME), dissipated)


def ledger_of(contribution: Contribution, rate_of: Callable[[str], sp.Symbol]) -> Ledger:
    """The ledger of one effect, without its frictions and shafts; `rate_of` tells on which rate the
    drive of an axis works. What its torques take out of the machine and do not store is lost.
    """
    stored, power_in, dissipated = contribution.potential + contribution.stored, ZERO, ZERO
    for drive in contribution.drives:
        stored += drive.stored + drive.inertia * rate_of(drive.axis) ** 2 / 2
        power_in += drive.power_in
        dissipated += drive.dissipated
    for rate, inertia in contribution.inertias.items():
        stored += inertia * rate**2 / 2
    power = sum((torque * rate for rate, torque in contribution.torques.items()), ZERO)
    return Ledger(stored, power_in, dissipated - power - _charging(contribution))


def _charging(contribution: Contribution) -> sp.Expr:
    """Power that flows into the energy of an effect's own states."""
    return sum(
        (
            sp.diff(contribution.stored, state.symbol) * state.derivative
            for state in contribution.states
        ),
        ZERO,
    )
