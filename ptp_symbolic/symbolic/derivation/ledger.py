"""The energy ledger of a machine: what is stored, what comes in, what is lost."""

from collections.abc import Callable, Iterable

import sympy as sp

from ptp_symbolic.symbolic.derivation.contributions import Contributions
from ptp_symbolic.symbolic.derivation.equations import Ledger
from ptp_symbolic.symbolic.effect_interface.contribution import Contribution, Drive, Friction
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

    A potential that depends on time (a base that moves) takes in its partial derivative by time.
    """
    powers = (contributions.input_torque(axis) * kinematics.rate(axis) for axis in axes)
    total = Ledger(rigid.kinetic + rigid.potential, sum(powers, ZERO))
    for contribution, is_loss in zip(
        contributions.by_effect, contributions.dissipative, strict=True
    ):
        total += ledger_of(contribution, contributions.drive_rate, is_loss)
    for friction in frictions:
        total += Ledger(dissipated=slide(friction.axis) * friction.level * friction.rate)
    stored, power_in, dissipated = map(contributions.resolve, sum(shafts, total).parts)
    return Ledger(stored, power_in + sp.diff(stored, kinematics.TIME), dissipated)


def ledger_of(
    contribution: Contribution, rate_of: Callable[[Drive], sp.Symbol], is_loss: bool = False
) -> Ledger:
    """The ledger of one effect, without its frictions and shafts; `rate_of` tells on which rate a
    drive works. What its torques take out counts as dissipated if it `is_loss`, else as power in,
    but for what the effect itself says to be `dissipated`.
    """
    stored, dissipated = contribution.potential + contribution.stored, contribution.dissipated
    power_in = dissipated
    for drive in contribution.drives:
        stored += drive.stored + drive.inertia * rate_of(drive) ** 2 / 2
        power_in += drive.power_in
        dissipated += drive.dissipated
    power = sum((torque * rate for rate, torque in contribution.torques.items()), ZERO)
    power += _charging(contribution)
    if is_loss:
        return Ledger(stored, power_in, dissipated - power)
    return Ledger(stored, power_in + power, dissipated)


def _charging(contribution: Contribution) -> sp.Expr:
    """Power that flows into the energy of an effect's own states."""
    return sum(
        (
            sp.diff(contribution.stored, state.symbol) * state.derivative
            for state in contribution.states
        ),
        ZERO,
    )
