"""How many lines each rule of the diagnosis costs: those of definitions that nothing else uses.

References are followed through the source from what other packages import. An attribute is taken
for every method of its name, and the lines where a rule is asked are not counted: it costs rather
more than is said here.
"""

import ast
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import ptp_symbolic
from ptp_symbolic.workflows.rules import Rule

PACKAGE = Path(ptp_symbolic.__file__).parent
ENGINE = ("numeric/diagnose", "numeric/identify", "workflows")
TABLE = "ptp_symbolic.workflows.rules"  # names every rule, and is no part of one
Place = tuple[str, str]  # a module and a name in it, `Class.method` for methods


@dataclass(frozen=True)
class Definition:
    """A function, class, method or constant: how many `lines` it has, and what its text names."""

    lines: int
    names: frozenset[str]
    attributes: frozenset[str]


@dataclass(frozen=True)
class Engine:
    """All definitions by place, what the modules import by the name there, and what is used from
    outside.
    """

    definitions: dict[Place, Definition]
    imported: dict[Place, Place]
    entries: frozenset[Place]

    def reached(self, cut: Collection[Place] = ()) -> set[Place]:
        """What is used, where nothing refers to the places that are `cut`."""
        methods: dict[str, list[Place]] = {}
        for module, name in self.definitions:
            _, dot, method = name.partition(".")
            if dot and (module, name) not in cut:
                methods.setdefault(method, []).append((module, name))
        found: set[Place] = set()
        ahead = list(self.entries)
        while ahead:
            named = ahead.pop()
            place = self.imported.get(named, named)
            if place in found or place not in self.definitions:
                continue
            found.add(place)
            definition, module = self.definitions[place], place[0]
            ahead += [(module, n) for n in definition.names if (module, n) not in cut]
            for attribute in definition.attributes:
                ahead += methods.get(attribute, ())
        return found

    def lines(self, places: Collection[Place]) -> int:
        """Lines of all these definitions."""
        return sum(self.definitions[place].lines for place in places)


def rule_lines(rules: Sequence[Rule]) -> dict[str, int]:
    """Lines that go with a rule, by its name."""
    engine = read_engine()
    every = engine.reached()
    found = {}
    for rule in rules:
        cut = {(module, name) for module, _, name in (p.partition(":") for p in rule.where)}
        found[rule.name] = engine.lines(every - engine.reached(cut))
    return found


def read_engine() -> Engine:
    """The definitions of `ENGINE`, read from its text."""
    definitions: dict[Place, Definition] = {}
    imported: dict[Place, Place] = {}
    entries: set[Place] = set()
    for path in sorted(PACKAGE.rglob("*.py")):
        module = ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts)
        tree = ast.parse(path.read_text("utf-8"))
        sources = dict(_imports(tree))
        if path.parent.relative_to(PACKAGE).as_posix() not in ENGINE or module == TABLE:
            entries |= set(sources.values()) if module != TABLE else set()
            continue
        imported |= {(module, name): source for name, source in sources.items()}
        for node in tree.body:
            if isinstance(node, ast.Import | ast.ImportFrom):
                continue
            for name, part in _parts(node):
                definitions[module, name] = part
    return Engine(definitions, imported, frozenset(entries))


def _imports(tree: ast.Module) -> Iterator[tuple[str, Place]]:
    """Names that a module imports, with where they come from."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module:
            for alias in node.names:
                yield alias.asname or alias.name, (node.module, alias.name)


def _parts(node: ast.stmt) -> Iterator[tuple[str, Definition]]:
    """The definitions in a statement of a module; methods apart from their class."""
    if not isinstance(node, ast.ClassDef):
        names = [node.name] if isinstance(node, ast.FunctionDef) else _targets(node)
        for name in names or [f"line {node.lineno}"]:
            yield name, _definition([node])
        return
    methods = [n for n in node.body if isinstance(n, ast.FunctionDef)]
    rest = [n for n in node.body if n not in methods]
    always = [m for m in methods if m.name.startswith("__")]
    yield node.name, _definition([*node.bases, *node.decorator_list, *rest, *always])
    for method in methods:
        if method not in always:
            yield f"{node.name}.{method.name}", _definition([method])


def _targets(node: ast.stmt) -> list[str]:
    """Names that an assignment binds."""
    names = (n for n in ast.walk(node) if isinstance(n, ast.Name))
    return [n.id for n in names if isinstance(n.ctx, ast.Store)]


def _definition(nodes: Sequence[ast.AST]) -> Definition:
    """What these nodes are together."""
    parts = [n for node in nodes for n in ast.walk(node)]
    lines = {k for n in nodes for k in range(_first(n), (getattr(n, "end_lineno", 0) or 0) + 1)}
    return Definition(
        len(lines),
        frozenset(n.id for n in parts if isinstance(n, ast.Name)),
        frozenset(n.attr for n in parts if isinstance(n, ast.Attribute)),
    )


def _first(node: ast.AST) -> int:
    """The first line of a node, that of its decorators where it has some."""
    decorators = getattr(node, "decorator_list", [])
    return min(n.lineno for n in (*decorators, node))
