"""The lead screw: torque that it takes to raise and to lower a load, efficiencies, self-locking.

Square thread; the friction at the flanks has the same coefficient at rest and in motion. Source:
thesis Eq. 3.12; Shigley, Mechanical Engineering Design, 9th edition 2011, Eq. 8-1 to 8-5.
"""

from dataclasses import dataclass

import sympy as sp

from ptp_symbolic.symbolic.symbols import real


@dataclass(frozen=True)
class Screw:
    """A screw of `lead` in m per turn, mean diameter `diameter` in m, coefficient of `friction`."""

    lead: sp.Expr
    diameter: sp.Expr
    friction: sp.Expr

    @property
    def turning(self) -> sp.Expr:
        """Turn of the screw in rad per metre of stroke."""
        return 2 * sp.pi / self.lead

    @property
    def raising(self) -> sp.Expr:
        """Torque in N m that moves one newton of load against it (Eq. 3.12, upper line)."""
        top = self.lead + sp.pi * self.friction * self.diameter
        return self.diameter / 2 * top / self._wedge

    @property
    def lowering(self) -> sp.Expr:
        """Torque in N m that moves one newton of load along with it (Eq. 3.12, lower line).

        Negative where the load drives the screw and must be held back.
        """
        top = sp.pi * self.friction * self.diameter - self.lead
        return self.diameter / 2 * top / (sp.pi * self.diameter + self.friction * self.lead)

    @property
    def drive_efficiency(self) -> sp.Expr:
        """Power to the load over power into the screw, the screw driving."""
        return 1 / (self.turning * self.raising)

    @property
    def back_drive_efficiency(self) -> sp.Expr:
        """Power out of the screw over power of the load, the load driving; negative: it locks."""
        return -self.turning * self.lowering

    def steps(self, axis: str) -> list[tuple[str, sp.Expr, sp.Expr]]:
        """From the forces on the flank to the two lines of Eq. 3.12: words, left and right side."""
        slope, load, flank = (real(f"{n}_{axis}") for n in ("lambda_lead", "F_load", "N_flank"))
        up, along = self.lead, sp.pi * self.diameter
        length = sp.sqrt(up**2 + along**2)
        turns = {sp.sin(slope): up / length, sp.cos(slope): along / length}
        found = [
            ("the thread unrolled is a wedge, lambda_lead its angle", sp.tan(slope), up / along)
        ]
        for word, sign in (("raise", 1), ("lower", -1)):
            normal = load / (sp.cos(slope) - sign * self.friction * sp.sin(slope))
            turning = self.friction * sp.cos(slope) + sign * sp.sin(slope)
            torque = real(f"T_{word}_{axis}")
            whole = (self.diameter / 2 * normal * turning).xreplace(turns)
            found += [
                (
                    f"to {word} the load F_load: balance along the axis, N_flank on it",
                    flank,
                    normal,
                ),
                ("balance about the axis", torque, self.diameter / 2 * flank * turning),
                ("both, and the wedge: thesis Eq. 3.12", torque, sp.factor(sp.simplify(whole))),
            ]
        return found

    @property
    def self_locking(self) -> sp.Rel:
        """True where no load, however large, drives the screw (erratum 10)."""
        return sp.Le(self.lead, sp.pi * self.friction * self.diameter)

    @property
    def can_raise(self) -> sp.Rel:
        """False where friction wedges the screw, so that no torque raises a load."""
        return sp.Gt(self._wedge, 0)

    @property
    def _wedge(self) -> sp.Expr:
        return sp.pi * self.diameter - self.friction * self.lead


@dataclass(frozen=True)
class ScrewFriction:
    """Friction torque of a screw in N m, seen at the joint that it turns, and against its motion.

    Friction is a fixed share of the torque carried, and changes that by way of the acceleration:
    this is the solution of both relations. A drive with `driving` torque and `own` inertia works
    against `torque` on an inertia `load`, in N m and kg m^2. A self-locking screw that lowers a
    load jams where `own` falls below its share of `load`, a degree or so from a dead centre: no
    motion solves the relations there, and the friction is finite and dissipative instead.
    """

    axis: str
    screw: Screw
    driving: sp.Expr
    torque: sp.Expr
    load: sp.Expr
    own: sp.Expr

    @property
    def terms(self) -> dict[sp.Symbol, sp.Expr]:
        """Functions in which `sliding` and `breakaway` are written, each of those before it.

        The efficiencies; the torque that the screw would carry without friction, times the sum of
        the inertias; what of that is lost.
        """
        raised, lowered, carried, *lost = self._names
        return {
            raised: 1 / self.screw.drive_efficiency,
            lowered: self.screw.back_drive_efficiency,
            carried: self.load * self.driving - self.own * self.torque,
            lost[0]: (raised - 1) / (raised * self.load + self.own),
            lost[1]: (1 - lowered) / sp.Abs(lowered * self.load + self.own),
        }

    def steps(self) -> list[tuple[str, sp.Expr, sp.Expr]]:
        """From the two torques of the screw to its friction in motion: words, left and right side.

        The screw passes `T_passed` on to the joint, and takes `raised` or `lowered` times as much.
        """
        raised, lowered, *_ = self._names
        names = ("T_passed", "alpha", "T_friction", "F_load", "T_raise", "T_lower")
        passed, speed, friction, force, *torques = (real(f"{n}_{self.axis}") for n in names)
        found = self.screw.steps(self.axis)
        ways = (
            ("motor", raised, torques[0], raised - 1),
            ("load", lowered, -torques[1], 1 - lowered),
        )
        for driver, share, torque, lost in ways:
            motor, joint = self.driving - share * passed, self.torque + passed
            both = sp.linsolve([self.own * speed - motor, self.load * speed - joint], speed, passed)
            ((_, solved),) = both
            found += [
                (f"power, the {driver} driving", share, self.screw.turning * torque / force),
                ("so that the motor accelerates by", self.own * speed, motor),
                ("and the joint by", self.load * speed, joint),
                ("both solved for what is passed on", passed, sp.factor(solved)),
                ("friction takes the difference", friction, lost * sp.Abs(passed)),
            ]
        return found

    def sliding(self, direction: sp.Expr) -> sp.Expr:
        """Torque while the joint moves in `direction` (-1 or 1)."""
        _, _, carried, *lost = self._names
        return _by_sign(direction * carried, *lost)

    def breakaway(self, direction: sp.Expr) -> sp.Expr:
        """Torque that holds the joint at rest against motion in `direction` (-1 or 1)."""
        raised, lowered, *_ = self._names
        return _by_sign(-direction * self.torque, raised - 1, 1 - lowered)

    @property
    def _names(self) -> list[sp.Symbol]:
        words = ("raised", "lowered", "carried", "lost_raising", "lost_lowering")
        return [real(f"{word}_{self.axis}") for word in words]


def _by_sign(value: sp.Expr, above: sp.Expr, below: sp.Expr) -> sp.Expr:
    """`above` times a positive value, `below` times the size of a negative one."""
    return ((above - below) * value + (above + below) * sp.Abs(value)) / 2
