"""The derivation report, a file for every section."""

from ptp_symbolic.report.derivation.document import render_derivation
from ptp_symbolic.report.derivation.log import has_warning

__all__ = ["has_warning", "render_derivation"]
