"""Title of the derivation report: platform, date, version, and the module that it belongs to."""

import os
from datetime import UTC, datetime
from hashlib import sha256

from ptp_symbolic import __version__
from ptp_symbolic.platform import Platform
from ptp_symbolic.report.latex_text import escaped
from ptp_symbolic.symbolic.codegen.module import module_text
from ptp_symbolic.symbolic.derivation.equations import Equations

HALF_HASH = 32  # of 64 digits, on a line


def title_block(platform: Platform, equations: Equations) -> str:
    """Title, date, version, and the SHA-256 of the text of the module emitted for `platform`.

    The date is today's, or that of SOURCE_DATE_EPOCH, in UTC.
    """
    digest = sha256(module_text(equations).encode()).hexdigest()
    given = os.environ.get("SOURCE_DATE_EPOCH", "")
    now = datetime.fromtimestamp(int(given), UTC) if given.isdigit() else datetime.now(UTC)
    return "\n".join(
        [
            rf"\title{{\vspace{{-15mm}}{escaped(platform.title)}\\",
            r"\large Derivation of the equations of motion}",
            rf"\author{{\small ptp-symbolic {__version__}}}\date{{\small {now:%Y-%m-%d}}}",
            r"\begin{document}\maketitle",
            r"\noindent The emitted module that computes these equations has the SHA-256\\",
            rf"\texttt{{{digest[:HALF_HASH]}}}\\\texttt{{{digest[HALF_HASH:]}}}.",
        ]
    )
