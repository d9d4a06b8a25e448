"""The derivation report, a file for every section."""

from ptp_symbolic.report.derivation.document import render_derivation
from ptp_symbolic.report.derivation.operating_points import read_points

__all__ = ["read_points", "render_derivation"]
