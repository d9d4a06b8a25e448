"""The linkage of a linear actuator: stroke and joint angle in closed form, limits, dead centres.

The joint, the foot of the actuator and the pin at the tip of its rod are a triangle: two sides are
fixed (ground link and arm), the third is the actuator. A growing stroke turns the joint towards
smaller angles. Source: thesis section 3.2.3.2, Fig. 3.13.
"""

from dataclasses import dataclass

import sympy as sp

from ptp_symbolic.symbolic.symbols import ZERO, real


@dataclass(frozen=True)
class Linkage:
    """Lengths in m: joint to foot (`ground`), actuator drawn in (`shortest`), joint to pin (`arm`).

    `start` is the stroke in m at joint angle zero. The triangle must close there, and lie on the
    side of the dead centres where a longer actuator opens the angle at the joint.
    """

    ground: sp.Expr
    shortest: sp.Expr
    arm: sp.Expr
    start: sp.Expr

    @property
    def cosine(self) -> sp.Expr:
        """2 ground arm cos(opening at joint angle zero) in m^2, by the law of cosines."""
        return self.arm**2 + self.ground**2 - (self.shortest + self.start) ** 2

    @property
    def sine(self) -> sp.Expr:
        """2 ground arm sin(opening at joint angle zero) in m^2; four times the triangle's area."""
        return sp.sqrt(4 * self.arm**2 * self.ground**2 - self.cosine**2)

    def length(self, angle: sp.Expr) -> sp.Expr:
        """Length of the actuator in m at joint angle `angle` in rad."""
        turned = self.cosine * sp.cos(angle) + self.sine * sp.sin(angle)
        return sp.sqrt(self.arm**2 + self.ground**2 - turned)

    def stroke(self, angle: sp.Expr) -> sp.Expr:
        """Stroke in m at joint angle `angle` in rad."""
        return self.length(angle) - self.shortest

    def ratio(self, angle: sp.Symbol) -> sp.Expr:
        """Stroke speed per joint rate in m/rad, which is joint torque per actuator force.

        The power of the force is then that of the torque (erratum 9). Its size is the distance of
        the joint from the line of the actuator.
        """
        return sp.diff(self.length(angle), angle)

    def ratio_terms(self, angle: sp.Expr, axis: str) -> tuple[dict[sp.Symbol, sp.Expr], sp.Expr]:
        """Named functions, each of those before it, and `ratio` written with them."""
        words = ("linkage_cos", "linkage_sin", "length")
        cosine, sine, length = (real(f"{word}_{axis}") for word in words)
        squares = self.arm**2 + self.ground**2
        terms = {
            cosine: self.cosine,
            sine: sp.sqrt(4 * self.arm**2 * self.ground**2 - cosine**2),
            length: sp.sqrt(squares - cosine * sp.cos(angle) - sine * sp.sin(angle)),
        }
        return terms, (cosine * sp.sin(angle) - sine * sp.cos(angle)) / (2 * length)

    def angle(self, stroke: sp.Expr) -> sp.Expr:
        """Joint angle in rad at `stroke` in m; a stroke out of reach gives the dead centre."""
        opened = self.arm**2 + self.ground**2 - (self.shortest + stroke) ** 2
        cosine = opened / (2 * self.arm * self.ground)
        return self._opening - sp.acos(sp.Max(-1, sp.Min(1, cosine)))

    def reach(self, longest: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        """Joint angles in rad, lower and upper, at the `longest` stroke in m and at none."""
        return self.angle(longest), self.angle(ZERO)

    def dead_centres(self) -> tuple[sp.Expr, sp.Expr]:
        """Joint angles in rad, lower and upper, at which the actuator has no lever.

        They are where the length, as a function of the opening at the joint, is stationary.
        """
        opening = real("opening")
        ground, arm = sp.symbols("ground arm", positive=True)
        squared = arm**2 + ground**2 - 2 * arm * ground * sp.cos(opening)
        found = sp.solveset(sp.diff(squared, opening), opening, sp.Interval(0, sp.pi))
        upper, lower = (self._opening - value for value in sorted(found))
        return lower, upper

    def stroke_limits(self) -> tuple[sp.Expr, sp.Expr]:
        """Strokes in m at which the triangle folds flat: shortest and longest possible."""
        return (
            sp.Abs(self.ground - self.arm) - self.shortest,
            self.ground + self.arm - self.shortest,
        )

    @property
    def opens(self) -> sp.Rel:
        """True when the triangle closes at joint angle zero and is not flat there."""
        return sp.Lt(sp.Abs(self.cosine), 2 * self.arm * self.ground)

    @property
    def _opening(self) -> sp.Expr:
        """Angle in rad between ground link and arm at joint angle zero."""
        return sp.acos(self.cosine / (2 * self.arm * self.ground))
