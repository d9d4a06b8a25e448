"""The derivation report of a machine on a base that moves as measured."""

from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.report.derivation.coupling import coupled_axes
from ptp_symbolic.report.derivation.routes import three_routes
from ptp_symbolic.symbolic.derivation.assembly import assemble

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("base_rotation", None, None),
    EffectDeclaration("base_acceleration", None, None, "specific_force"),
)


def test_three_routes_agree_and_what_the_base_does_stands_by_itself() -> None:
    equations = assemble(Platform("moved", "Moved", ("pan", "tilt"), 9.81, EFFECTS, (), ()))
    text = three_routes(equations)
    assert text.count("Lagrange & $0$") == 2 and "not 0" not in text
    assert "gravity, and the motion of the base" in text and r"h_{\mathrm{pan,base}}" in text
    assert "is skew" in text and "on a base at rest leaves $0$" in text
    assert "J_{\\mathrm{x,pan}}" not in text.partition("centrifugal")[2].partition("base}")[0]
    assert "omega_{\\mathrm{x,base}}" not in coupled_axes(equations)
