"""The energy ledger."""

from ptp_symbolic.report.latex_text import numbered
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.documents.statements import by_name


def energy(equations: Equations) -> str:
    """Section with stored energy, power in and dissipated power."""
    ledger = equations.ledger
    return r"\section{Energy}Stored energy, power in and dissipated power:" + numbered(
        [
            (r"E", by_name(ledger.stored, equations)),
            (r"P_{\mathrm{in}}", by_name(ledger.power_in, equations)),
            (r"P_{\mathrm{diss}}", by_name(ledger.dissipated, equations)),
        ]
    )
