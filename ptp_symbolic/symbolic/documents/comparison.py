"""Two machines compared, statement by statement and term by term."""

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp
from sympy.simplify.fu import TR10i

from ptp_symbolic.symbolic.documents.statements import Statement


@dataclass(frozen=True)
class Change:
    """A statement that two machines do not share: that of the second, or of the first where it is
    `gone`. `added` is what a sum that both have gained, None of any other statement; `before` the
    right side in the first machine, None where that has no such statement.
    """

    statement: Statement
    before: sp.Expr | None
    added: sp.Expr | None = None
    gone: bool = False


def comparison(before: Sequence[Statement], after: Sequence[Statement]) -> list[Change]:
    """The statements in which two machines differ, in the order of the second, then those gone."""
    old = {s.key: s for s in before}
    changes = []
    for statement in after:
        found = old.pop(statement.key, None)
        if found is None:
            if statement.right != 0:
                changes.append(Change(statement, None))
        elif _differ(found.right, statement.right):
            added = None
            if statement.sums and found.right != 0:
                added = _difference(found.right, statement.right)
            changes.append(Change(statement, found.right, added))
    gone = [Change(s, s.right, gone=True) for s in old.values() if s.right != 0]
    return changes + gone


def _differ(before: sp.Expr, after: sp.Expr) -> bool:
    return bool(before != after and sp.expand(after - before) != 0)


def _difference(before: sp.Expr, after: sp.Expr) -> sp.Expr:
    """What a sum gained, in the shortest of three forms."""
    new, gone = (set(sp.Add.make_args(e)) for e in (after, before))
    as_written = sp.Add(*(new - gone)) - sp.Add(*(gone - new))
    difference = sp.expand(after - before)
    # sums and differences of angles as one: sin a cos b + cos a sin b
    of_sums = sp.factor_terms(TR10i(difference))
    return min(as_written, sp.factor_terms(difference), of_sums, key=sp.count_ops)
