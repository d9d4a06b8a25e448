"""Causal strokes of a bond graph: which end of every bond sets the effort, and which the flow.

The sequential procedure: sources first, then integral causality of what stores, then resistors, and
after each what the junctions, transformers and gyrators make follow from it. Source: Karnopp,
Margolis and Rosenberg, System Dynamics, 5th edition 2012, section 5.2.
"""

from collections.abc import Mapping, Sequence

Ends = tuple[str, str]
Marks = dict[int, str]  # number of a bond: the node at its stroke


def strokes(kinds: Mapping[str, str], bonds: Sequence[Ends]) -> list[bool]:
    """For every bond, given by its (tail, head), whether its causal stroke is at the head.

    `kinds` are those of `bond_graph.Node`, by name. Raises ValueError where sources contradict each
    other.
    """
    marks: Marks = {}
    for number in sorted(range(len(bonds)), key=lambda n: _rank(kinds, bonds[n])):
        element, other = _element_first(kinds, bonds[number])
        wanted = element if kinds[element] in ("I", "Sf") else other
        unwanted = other if wanted == element else element
        if number not in marks:
            found = _with(marks, number, wanted, kinds, bonds)
            marks = found or _with(marks, number, unwanted, kinds, bonds) or marks
        if marks.get(number) != wanted and kinds[element].endswith(("Se", "Sf")):
            raise ValueError(f"The source '{element}' contradicts another source; remove one.")
        if number not in marks:
            raise ValueError(f"No causality fits the bond of '{element}' and '{other}'.")
    return [marks[number] == head for number, (_, head) in enumerate(bonds)]


def _is_element(kind: str) -> bool:
    return kind not in ("0", "1", "TF", "MTF", "GY")


def _element_first(kinds: Mapping[str, str], ends: Ends) -> Ends:
    tail, head = ends
    return (tail, head) if _is_element(kinds[tail]) else (head, tail)


def _rank(kinds: Mapping[str, str], ends: Ends) -> int:
    """Sources, then stores, then what only loses, then bonds between junctions."""
    kind = kinds[_element_first(kinds, ends)[0]]
    if not _is_element(kind):
        return 3
    if kind.endswith(("Se", "Sf")):
        return 0
    return 1 if kind == "I" or "C" in kind else 2


def _with(
    marks: Marks, number: int, node: str, kinds: Mapping[str, str], bonds: Sequence[Ends]
) -> Marks | None:
    """`marks` with one more stroke and all that follow; None where they contradict each other."""
    found, open_bonds = {**marks, number: node}, [number]
    while open_bonds:
        for end in bonds[open_bonds.pop()]:
            own = [n for n, ends in enumerate(bonds) if end in ends]
            following = _following(kinds[end], end, own, found, bonds)
            if following is None:
                return None
            found |= following
            open_bonds += following
    return found


def _following(
    kind: str, node: str, own: Sequence[int], marks: Marks, bonds: Sequence[Ends]
) -> Marks | None:
    """Strokes of the bonds `own` of a node that follow from those there are."""
    here = [n for n in own if marks.get(n) == node]
    away = [n for n in own if n in marks and marks[n] != node]
    left = [n for n in own if n not in marks]

    def at(chosen: Sequence[int], is_here: bool) -> Marks:
        return {n: node if is_here else _other(bonds[n], node) for n in chosen}

    if kind in ("0", "1"):
        single, rest = (here, away) if kind == "0" else (away, here)
        if len(single) > 1 or (not single and not left):
            return None
        if single:
            return at(left, kind == "1")
        return at(left, kind == "0") if len(left) == 1 and len(rest) == len(own) - 1 else {}
    if kind in ("TF", "MTF", "GY"):
        if not left:
            return {} if (len(here) == 1) == (kind != "GY") else None
        if len(left) == 1:
            return at(left, bool(here) == (kind == "GY"))
    return {}


def _other(ends: Ends, node: str) -> str:
    return ends[1] if ends[0] == node else ends[0]
