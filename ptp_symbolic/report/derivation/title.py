"""Title of the derivation report: platform, date, version, and the module that it belongs to."""

import os
import re
from datetime import UTC, datetime
from hashlib import sha256

from ptp_symbolic import __version__
from ptp_symbolic.platform import Platform
from ptp_symbolic.report.latex_text import escaped
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.targets.numba.module import module_text


def title_block(platform: Platform, equations: Equations) -> str:
    """Title, date, version, hash of the mathematics and SHA-256 of the module of `platform`.

    The date is today's, or that of SOURCE_DATE_EPOCH, in UTC.
    """
    text = module_text(equations)
    digest = sha256(text.encode()).hexdigest()
    header = re.search(r'^MODEL_HASH = "(\w+)"', text, re.MULTILINE)
    mathematics = header[1] if header else ""
    given = os.environ.get("SOURCE_DATE_EPOCH", "")
    now = datetime.fromtimestamp(int(given), UTC) if given.isdigit() else datetime.now(UTC)
    return "\n".join(
        [
            rf"\title{{\vspace{{-15mm}}{escaped(platform.title)}\\",
            r"\large Derivation of the equations of motion}",
            rf"\author{{\small ptp-symbolic {__version__}}}\date{{\small {now:%Y-%m-%d}}}",
            r"\begin{document}\maketitle",
            r"\noindent This document belongs to the module whose \texttt{MODEL\_HASH} is",
            rf"\texttt{{{mathematics}}}; the SHA-256 of its text, as emitted, is\\",
            rf"\texttt{{{digest}}}.",
        ]
    )
