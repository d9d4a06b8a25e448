"""Reports that people read: the diagnosis page and the derivation document."""

from ptp_symbolic.report import style as style
