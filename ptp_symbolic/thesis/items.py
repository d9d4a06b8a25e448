"""One printed result of the thesis beside the same result as this program computes it."""

import math
from dataclasses import dataclass
from decimal import Decimal
from enum import StrEnum

import sympy as sp

Value = float | str | None


class Kind(StrEnum):
    """What stands behind the computed value of an item, and so what an agreement is worth."""

    COMPUTED = "computed"
    ROUND_TRIP = "round_trip"
    NOTHING_PRINTED = "nothing_printed"
    MEASUREMENTS_NOT_PRINTED = "measurements_not_printed"
    ERRATUM = "erratum"


@dataclass(frozen=True)
class Item:
    """A printed value, the computed one, and whether they agree.

    `kind` says what is compared: a value COMPUTED from other printed ones, by equations or by
    arithmetic; a ROUND_TRIP, fitted to data that were made from the printed value itself, which
    tests the fit alone; NOTHING_PRINTED, where the thesis prints no value; a printed value about
    MEASUREMENTS_NOT_PRINTED, which nobody can recompute; or an ERRATUM.

    `agrees` is None where there is nothing to compare: the thesis prints no value, or the data
    behind it. `erratum` is the number of the erratum that explains a disagreement. `tolerance` is
    the difference up to which two numbers agree, in `unit`. `settled` is set for errata alone: the
    correction, and not the printed text, passed its check. `check` says how it was computed.
    """

    id: str
    kind: Kind
    title: str
    printed: Value
    computed: Value
    unit: str
    agrees: bool | None
    erratum: int | None
    check: str
    tolerance: float | None = None
    settled: bool | None = None


def compared(
    identity: str,
    title: str,
    printed: float,
    computed: float,
    unit: str,
    check: str,
    tolerance: float | None = None,
    erratum: int | None = None,
    kind: Kind = Kind.COMPUTED,
) -> Item:
    """An item of two numbers, which agree within `tolerance` (None: the last digit printed).

    `erratum` is kept only where the numbers disagree, as their explanation.
    """
    allowed = half_last_digit(printed) if tolerance is None else tolerance
    agrees = math.isfinite(computed) and abs(computed - printed) <= allowed * (1.0 + 1e-9)
    return Item(
        identity,
        kind,
        title,
        printed,
        float(computed),
        unit,
        agrees,
        None if agrees else erratum,
        check,
        allowed,
    )


def same_text(
    identity: str,
    title: str,
    printed: str,
    computed: str,
    check: str,
    erratum: int | None = None,
) -> Item:
    """An item of two statements, which agree when they are the same."""
    agrees = printed == computed
    named = None if agrees else erratum
    return Item(identity, Kind.COMPUTED, title, printed, computed, "", agrees, named, check)


def unprinted(identity: str, title: str, computed: Value, unit: str, check: str) -> Item:
    """An item for which the thesis prints no value."""
    return Item(identity, Kind.NOTHING_PRINTED, title, None, computed, unit, None, None, check)


def erratum(
    number: int, where: str, printed: Value, computed: Value, unit: str, settled: bool, check: str
) -> Item:
    """The item of an erratum; `settled` tells whether its check confirms the correction.

    A statement in words stands only where it does.
    """
    found = computed if settled or not isinstance(computed, str) else None
    return Item(
        f"erratum_{number:02d}",
        Kind.ERRATUM,
        f"Erratum {number}: {where}",
        printed,
        found,
        unit,
        False if settled else None,
        number,
        check,
        None,
        bool(settled),
    )


def half_last_digit(printed: float) -> float:
    """Half a unit of the last digit of a printed number: 0.025 gives 0.0005."""
    exponent = Decimal(repr(printed)).as_tuple().exponent
    return 0.5 * 10.0 ** int(exponent)


def plain(expression: object) -> str:
    """An expression or a dimension as text: powers with ^, products with a space."""
    text = str(sp.sstr(expression)) if isinstance(expression, sp.Basic) else str(expression)
    return text.replace(" ** ", "^").replace("**", "^").replace(" * ", " ").replace("*", " ")
