"""What a LaTeX log says."""

import re


def has_warning(log: str) -> bool:
    """True when a LaTeX log reports a warning or a box that does not fit."""
    return re.search(r"Warning|Overfull|Underfull", log) is not None
