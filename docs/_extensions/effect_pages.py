"""A page for every effect, written from the effect itself before Sphinx reads the sources.

Law, parameters, needs, reference and experiment are those of the object in the catalogue; the curve
is computed from the law. What an effect looks like in a log is in `effects_in_logs.toml`.
"""

import inspect
import re
import sys
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import groupby
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import sympy as sp
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from sphinx.application import Sphinx

from ptp_symbolic.api.effect_bases import machine_with
from ptp_symbolic.cli.lists import described
from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import AXES, Platform
from ptp_symbolic.report.derivation.curves import WITH, WITHOUT, Drawing, drawing_of
from ptp_symbolic.report.derivation.ranges import FloatArray, evaluated, setting
from ptp_symbolic.report.figures import AFTER, BEFORE, MEASURED, STYLE
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.documents.latex import latex_lines, latex_of, rate_latex, symbol_latex
from ptp_symbolic.symbolic.documents.laws import Law, laws
from ptp_symbolic.symbolic.documents.statements import RELATIONS, Statement
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import QUANTITY, Place, quantity_name
from ptp_symbolic.symbolic.effects import PACKAGED
from ptp_symbolic.symbolic.mechanics.kinematics import TIME
from ptp_symbolic.symbolic.symbols import real

Placed = tuple[Law, Equations]

FOLDER = "effects"
IN_LOGS = "effects_in_logs.toml"
ROOM = 60  # characters of a formula before it breaks
LINES = {WITH: {"color": AFTER}, WITHOUT: {"color": BEFORE, "linestyle": "--"}}
FIGURE = {**STYLE, "svg.fonttype": "path", "font.size": 9.5}
TIMES = np.linspace(0.0, 10.0, 1200)  # s, of the motion along which effects are shown
SLOW, FAST = 2.0 * np.pi * 0.2, 2.0 * np.pi * 0.5  # rad/s
MOTION = 0.5 * np.sin(SLOW * TIMES) + 0.12 * np.sin(FAST * TIMES)  # rad
MOTION_RATES = 0.5 * SLOW * np.cos(SLOW * TIMES) + 0.12 * FAST * np.cos(FAST * TIMES)  # rad/s
AT_REST = {"color": AFTER, "linestyle": ":"}


def setup(app: Sphinx) -> dict[str, Any]:
    """Write the pages before the sources are read."""
    app.connect("builder-inited", write_pages)
    return {"version": "1", "parallel_read_safe": True}


def write_pages(app: Sphinx) -> None:
    """Write the pages of all packaged effects, and the list of them, into `effects/`."""
    folder = Path(app.srcdir) / FOLDER
    folder.mkdir(exist_ok=True)
    groups = in_logs(Path(app.srcdir))
    texts = {name: text for group in groups for name, text in group["effects"].items()}
    for effect in PACKAGED:
        pages = page(effect, texts[effect.id], folder)
        write_if_new(folder / f"{effect.id}.md", pages)
    write_if_new(folder / "index.md", index(groups))


def in_logs(docs: Path) -> list[dict[str, Any]]:
    """The groups of effects, each with a title and what its effects look like in a log."""
    return list(tomllib.loads((docs / IN_LOGS).read_text("utf-8")).values())


def write_if_new(path: Path, text: str) -> None:
    """Write `text`, unless the file says it already: Sphinx reads again what is newer."""
    if not path.is_file() or path.read_text("utf-8") != text:
        path.write_text(text, encoding="utf-8")


def index(groups: Sequence[dict[str, Any]]) -> str:
    """The list of all effects by group."""
    titles = {effect.id: effect.title for effect in PACKAGED}
    searched = {e.id for e in PACKAGED if e.searched or e.structure}
    parts = [
        "# Effects",
        "What a platform may declare, a page each. A dot (•) marks what `diagnose` looks for by"
        " itself; the others are declared only. The pages are written from the code: the law,"
        " its parameters and its bounds are those that are compiled.",
    ]
    for group in groups:
        names = list(group["effects"])
        parts.append(f"## {group['title']}")
        parts.append(
            "\n".join(
                f"- [`{n}`]({n}.md): {titles[n]}{' •' if n in searched else ''}" for n in names
            )
        )
    listed = "\n".join(name for group in groups for name in group["effects"])
    parts.append(f"```{{toctree}}\n:hidden:\n\n{listed}\n```")
    return "\n\n".join(parts) + "\n"


def page(effect: Effect, in_log: str, folder: Path) -> str:
    """The page of an effect and all its kinds."""
    kinds = [effect, *effect.kinds]
    parts = [f"# {_upper(effect.title)}", _about(effect), _heading(effect)]
    placed = [law_of(kind) for kind in kinds]
    for kind, own in zip(kinds, placed, strict=True):
        more = [] if len(kinds) == 1 else [f'## `kind = "{kind.kind}"`: {kind.title}']
        parts += more + list(_kind(kind, own, folder, "##" if len(kinds) == 1 else "###"))
    parts += ["## In a log", in_log, *_along_motion(placed[0], folder)]
    if effect.separating_experiment:
        parts += ["## Separating experiment", effect.separating_experiment]
    sources = {k.reference: None for k in kinds if k.reference}
    parts += ["## Reference", "\n".join(f"- {_upper(source)}" for source in sources)]
    return "\n\n".join(parts) + "\n"


def _about(effect: Effect) -> str:
    """What the file of the effect says of it: what it is, what it assumes."""
    text = inspect.cleandoc(sys.modules[effect.contribute.__module__].__doc__ or "")
    return text.replace("``", "`")


def _heading(effect: Effect) -> str:
    facts = described(effect)
    if effect.searched:
        found = "A candidate of `diagnose`."
    elif effect.structure:
        found = "`diagnose` rebuilds the platform with it."
    else:
        found = "Declared only: `diagnose` does not look for it."
    text = f"`{effect.id}` sits on {facts['sits_on']}. {found}"
    for need in facts["needs"]:
        text += f" It needs {' or '.join(_code(need['from']))} (`{need['quantity']}`)."
    if effect.instead_on_linear:
        text += f" It is not for a linear joint: {effect.instead_on_linear}."
    lines = ["[[effects]]", f'effect = "{effect.id}"', *(['axis = "pan"'] * effect.on_axis)]
    if effect.kinds:
        lines.append(f'kind = "{effect.kind}"')
    if effect.sites:
        lines.append(f'site = "{effect.sites[-1]}"  # {" or ".join(effect.sites)}')
    return f"{text}\n\n```toml\n" + "\n".join(lines) + "\n```"


def _code(names: Sequence[str]) -> list[str]:
    return [name if " " in name else f"`{name}`" for name in names]


def _kind(kind: Effect, placed: Placed | None, folder: Path, level: str) -> Iterator[str]:
    """Law, curve and parameters of one kind."""
    if placed is not None:
        law, equations = placed
        if law.rows:
            yield f"{level} Law"
            yield from _formulas(law.rows, equations)
        yield from _states(law, equations)
        drawing = drawing_of(law, (), equations)
        if drawing is not None and not _is_identity(drawing):
            name = f"{kind.id}-{kind.kind}.svg" if kind.kind else f"{kind.id}.svg"
            _draw(drawing, folder / name)
            yield f"```{{image}} {name}\n:alt: {kind.title}, drawn from its law\n:class: curve\n```"
            yield f"*{drawing.caption}*" if "*" not in drawing.caption else drawing.caption
    rows = described(kind)["parameters"]
    if rows:
        yield f"{level} Parameters"
        yield _table(rows, _on_linear(kind))


def _along_motion(placed: Placed | None, folder: Path) -> Iterator[str]:
    """The torque that a model without the effect lacks along a motion; nothing of an effect that is
    no torque of angle, rate and time.
    """
    lacking = None if placed is None else _lacking_torque(*placed)
    if placed is None or lacking is None or not np.abs(lacking).max() > 0.0:
        return
    law, equations = placed
    name, unit = f"{law.effect.id}-log.svg", equations.unit("N m")
    with matplotlib.rc_context(FIGURE):
        figure = Figure(figsize=(6.4, 2.9), layout="constrained")
        FigureCanvasSVG(figure)
        axes = figure.subplots()
        axes.plot(TIMES, lacking, color=BEFORE, linewidth=1.4)
        axes.set_xlabel("time [s]")
        axes.set_ylabel(f"torque [{unit}]", color=BEFORE)
        beside = axes.twinx()
        beside.plot(TIMES, MOTION_RATES, color=MEASURED, linewidth=1.0)
        beside.set_ylabel("rate [rad/s]", color="#6b747e")
        beside.grid(False)
        figure.savefig(folder / name, format="svg", metadata={"Date": None})
    yield f"```{{image}} {name}\n:alt: {law.effect.title}, along a motion\n:class: curve\n```"
    yield (
        "*The torque that a model without it lacks (orange) along a motion whose rate is grey,"
        " computed from the law.*"
    )


def _lacking_torque(law: Law, equations: Equations) -> FloatArray | None:
    """The torque [k] at the times of the motion; None where it depends on anything else."""
    place = law.place
    if place.axis is None:
        return None
    given = setting(law, equations)
    angles, rates = {place.angle, place.gear_angle}, {place.rate, place.gear_rate}
    points = {**dict.fromkeys(angles, MOTION), **dict.fromkeys(rates, MOTION_RATES), TIME: TIMES}
    points[place.slide] = np.sign(MOTION_RATES)
    parts = [(row.right, np.ones_like(TIMES)) for row in law.rows if str(row.left)[:2] == "T_"]
    against = -points[place.slide]
    for before, after in law.frictions:
        parts.append((after.level, against))
        parts += [] if before is None else [(before.level, -against)]
    known = {*points, *given.values}
    if not parts or any(torque.free_symbols - known for torque, _ in parts):
        return None
    return np.sum([sign * evaluated(torque, points, given) for torque, sign in parts], axis=0)


def law_of(kind: Effect) -> Placed | None:
    """The law of one kind on the first machine that takes it; None where the kind differs from the
    usual one by the signal alone.
    """
    try:
        platform = machine_with(kind)
    except InputError:
        return None
    platform = _of_kind(platform, kind)
    if kind.structural and kind.splits_axis and kind.id == "backlash":
        rigid = tuple(e for e in platform.effects if e.effect != "shaft_compliance")
        platform = replace(platform, effects=rigid)
    found = next(f for f in laws(platform) if (f.effect.id, f.effect.kind) == (kind.id, kind.kind))
    return found, assemble(platform)


def _of_kind(platform: Platform, kind: Effect) -> Platform:
    declared = tuple(
        replace(e, kind=kind.kind) if e.effect == kind.id else e for e in platform.effects
    )
    return replace(platform, effects=declared)


def _formulas(rows: Sequence[Statement], equations: Equations) -> Iterator[str]:
    for name, group in groupby(rows, key=lambda row: row.name):
        words = _with_symbols(equations.worded(_upper(name)))
        shown = _display([(r.left_latex, RELATIONS[r.relation][0], r.right) for r in group])
        yield f"{words}:\n\n{shown}"
    named = {str(symbol) for row in rows for symbol in row.right.free_symbols}
    meant = [(symbol_latex(n), "=", e) for n, e in equations.quantities if n in named]
    if meant:
        yield f"where\n\n{_display(meant)}"


def _states(law: Law, equations: Equations) -> Iterator[str]:
    """The states of an effect, how they change, and what is sampled."""
    own = law.contribution
    if own.states:
        rows = [
            f"| ${symbol_latex(s.name)}$ | {s.unit} | {s.initial:g} |"
            f" {equations.worded(s.meaning)} |"
            for s in own.states
        ]
        yield "\n".join(["| State | Unit | Start | Meaning |", "|---|---|---|---|", *rows])
    slopes = [(rate_latex(s.name), "=", s.derivative) for s in own.states if s.derivative != 0]
    if slopes:
        yield _display(slopes)
    for sampler in own.samplers:
        yield f"Every ${latex_of(_bare(sampler.period))}$, held in between (zero-order hold):"
        named = [(symbol_latex(str(s)), "=", e) for s, e in sampler.terms.items()]
        updates = [(symbol_latex(str(s)), r"\leftarrow", e) for s, e in sampler.updates.items()]
        yield _display([(left, sign, _bare(e)) for left, sign, e in (*named, *updates)])
    for switch in own.switches:
        deviation, threshold = latex_of(switch.deviation), latex_of(switch.threshold)
        yield f"`{switch.name}` is on where $|{deviation}|$ has reached ${threshold}$ and grows."


def _display(rows: Sequence[tuple[str, str, sp.Expr]]) -> str:
    lines = []
    for left, sign, right in rows:
        first, *more = latex_lines(right, ROOM)
        lines += [f"{left} &{sign} {first}", *(f"&\\quad {m}" for m in more)]
    text = " \\\\\n".join(lines)
    return f"$$\n\\begin{{aligned}}\n{text}\n\\end{{aligned}}\n$$"


def _bare(expression: sp.Expr) -> sp.Expr:
    """`expression` with quantities of others by their names."""
    named = [s for s in expression.free_symbols if s.name.startswith(QUANTITY)]
    return expression.xreplace({s: real(quantity_name(s)) for s in named})


def _is_identity(drawing: Drawing) -> bool:
    """Whether a drawing has one line on which nothing happens."""
    shown = [(x, y) for x, y, _ in drawing.lines if y.any()]
    return len(shown) == 1 and np.allclose(*shown[0])


def _with_symbols(text: str) -> str:
    """`text` with the names of symbols in it as formulas."""
    return re.sub(
        r"\b[A-Za-z0-9]+(?:_[A-Za-z0-9]+)+\b",
        lambda found: f"${symbol_latex(found[0])}$",
        text,
    )


def _table(rows: Sequence[dict[str, Any]], on_linear: Mapping[str, Parameter]) -> str:
    """The parameters of a rotary joint, with units on a linear one; then those of that alone."""
    lines = [
        "| Parameter | Unit | Linear joint | Default | Bounds | Off at | Meaning |",
        "|---|---|---|---|---|---|---|",
    ]
    for p in rows:
        default = "declare it" if p["default"] is None else f"{p['default']:g}"
        off = "" if p["off_at"] is None else f"{p['off_at']:g}"
        low, high = p["bounds"]
        linear = on_linear[p["name"]].unit if p["name"] in on_linear else ""
        cells = (p["unit"], linear, default, f"{low:g} to {high:g}", off, p["meaning"])
        lines.append(_row(p["name"], *cells))
    for name in on_linear.keys() - {p["name"] for p in rows}:
        p = on_linear[name]
        bounds = f"{p.lower:g} to {p.upper:g}"
        lines.append(_row(name, "", p.unit, "declare it", bounds, "", p.meaning))
    return "\n".join(lines)


def _row(name: str, *cells: str) -> str:
    return "| " + " | ".join([f"`{name}`", *cells]).replace("<", "‹").replace(">", "›") + " |"


def _on_linear(kind: Effect) -> dict[str, Parameter]:
    """The parameters on a linear joint, by name; none of an effect that is not for one."""
    if kind.instead_on_linear:
        return {}
    axis = "<axis>" if kind.on_axis else None
    place = Place(AXES[:1], axis, None, frozenset(), linear=True)
    return {p.name: p for p in kind.parameters_at(place)}


def _draw(drawing: Drawing, path: Path) -> None:
    with matplotlib.rc_context(FIGURE):
        figure = Figure(figsize=(5.6, 3.0), layout="constrained")
        FigureCanvasSVG(figure)
        axes = figure.subplots()
        for x, y, style in drawing.lines:
            axes.plot(x, y, linewidth=1.6, **LINES.get(style, AT_REST))
        axes.set_xlabel(drawing.across)
        axes.set_ylabel(drawing.up)
        figure.savefig(path, format="svg", metadata={"Date": None})


def _upper(text: str) -> str:
    return text[:1].upper() + text[1:]
