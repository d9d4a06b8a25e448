"""The diagnosis as one HTML page that works without a network, and its curves as CSV."""

import base64
import hashlib
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from markupsafe import Markup

from ptp_symbolic.report import figures, map_figures, quantities, rivals, tables
from ptp_symbolic.report.drawing import PlatformDrawing, svg_text
from ptp_symbolic.report.pages import TEMPLATES, environment
from ptp_symbolic.report.tables import usable

Curves = Mapping[str, Mapping[str, Any]]

SHOWN_RUNS = 2
POINTS_IN_ALL = 60_000  # of all lines together: about 0.9 MB of SVG


@dataclass(frozen=True)
class Verdict:
    """What a verdict says in plain words; `heading` takes the names of the added effects."""

    tone: str
    label: str
    heading: str
    lead: str


VERDICTS = {
    "nothing_missing": Verdict(
        "good",
        "nothing missing",
        "Nothing is missing from the declared model",
        "It reproduces the logs down to the noise, and no candidate effect predicts them better.",
    ),
    "explained": Verdict(
        "found",
        "explained",
        "Missing effect{s} found: {effects}",
        "With it the model reproduces the validation runs, which were never fitted.",
    ),
    "explained_up_to_group": Verdict(
        "found",
        "explained up to a group",
        "Missing effect{s} found, up to a group of alternatives: {effects}",
        "With it the model reproduces the validation runs. The alternatives named below reproduce"
        " these logs as well.",
    ),
    "partly_explained": Verdict(
        "partly",
        "partly explained",
        "Part of the error explained by: {effects}",
        "The error falls significantly, but not to the noise floor: something else is missing too.",
    ),
    "unexplained": Verdict(
        "open",
        "unexplained",
        "Something is missing, and no known effect could be confirmed",
        "The residual exceeds the noise, yet no candidate could be confirmed. The closest one is"
        " shown with its figures, as a hint and not as a finding.",
    ),
}

# the presentation elements that SymPy's printer writes, without attributes that could run or load
_MATHML_TAG = re.compile(
    r"</?(?:math|mrow|mi|mn|mo|mfrac|msup|msub|msubsup|msqrt|mroot|mtable|mtr|mtd|mtext|mstyle"
    r"|mover|munder|munderover|mspace)"
    r'(?: (?:display|mathvariant|stretchy|xmlns|columnalign|width|accent|form)="[^"<>]*")* ?/?>'
)


def render_diagnosis(
    diagnosis: Mapping[str, Any], curves: Curves, machine: PlatformDrawing | None = None
) -> str:
    """The page for one diagnosis (the content of diagnosis.json) and its curves.

    curves: {run: {"set": "train" or "validate", "time": [n] s, "signals": {signal: {"unit",
    "measured", "before", "after" (or None): [n], "counts": size of one count or None}},
    "inputs": {name: {"unit", "values": [n]}} (optional),
    "angle": {axis: [n] rad}, "rate": {axis: [n] rad/s}, "angle_unit": {axis: "m" where the joint is
    linear} (optional), "borders": [k] s, the starts of windows after the first (optional), "run":
    the name of the run where the key is not (optional)}}. `machine` is drawn, with what was added
    marked at its place. Loads nothing from elsewhere.
    """
    verdict = VERDICTS[diagnosis["verdict"]]
    if not diagnosis.get("added"):
        diagnosis, curves = _declared_alone(diagnosis, curves)
    key, unit = tables.error_measure(tables.declared_totals(diagnosis))
    shown, folded = _motion(diagnosis, curves, key)
    page = environment().get_template("diagnosis.html.j2")
    script = (TEMPLATES / "diagnosis.js").read_text(encoding="utf-8")
    return page.render(
        diagnosis=diagnosis,
        verdict=verdict,
        heading=_heading(diagnosis, verdict),
        colours=figures.COLOURS,
        key=key,
        unit=unit,
        error_groups=tables.error_groups(diagnosis, key),
        parameter_rows=tables.parameter_rows(diagnosis),
        ranking=tables.ranking(diagnosis, key),
        shown=shown,
        folded=folded,
        residual_maps=_residual_maps(diagnosis, curves),
        torque_maps=_torque_maps(diagnosis.get("remainder")),
        rivals=rivals.rival_parts(diagnosis.get("black_box")),
        rival_names=rivals.MODELS,
        free_errors=rivals.free_errors(diagnosis),
        equations=_equations(diagnosis),
        machine=machine,
        pictures=[Markup(svg_text(s)) for s in (machine.frames, *machine.drives)]
        if machine
        else [],
        window=_window(curves),
        script=Markup(script),
        script_hash=base64.b64encode(hashlib.sha256(script.encode()).digest()).decode(),
        words=_words(curves),
    )


def _declared_alone(
    diagnosis: Mapping[str, Any], curves: Curves
) -> tuple[Mapping[str, Any], Curves]:
    """Diagnosis and curves without what comes "after", where nothing was added: it is the same."""
    parts = {
        name: {s: e for s, e in part.items() if s != "after"} if name in tables.SETS else part
        for name, part in (diagnosis.get("error") or {}).items()
    }
    fit = {"before": (diagnosis.get("fit") or {}).get("before")}
    signals = {
        run: {name: {**signal, "after": None} for name, signal in curve["signals"].items()}
        for run, curve in curves.items()
    }
    return (
        {**diagnosis, "error": parts, "fit": fit},
        {run: {**curve, "signals": signals[run]} for run, curve in curves.items()},
    )


def _heading(diagnosis: Mapping[str, Any], verdict: Verdict) -> str:
    """The heading of the page; of values that are declared wrong it is their own sentence."""
    added = diagnosis.get("added") or []
    effects = [str(a.get("title") or a["effect"]) for a in added]
    text = " and ".join(effects)
    if added and all(str(a["effect"]).startswith("declared_value") for a in added):
        return f"{text[:1].upper()}{text[1:]}"
    return verdict.heading.format(effects=text, s="s" * (len(effects) > 1))


def _window(curves: Curves) -> float | None:
    """Usual length in s of the windows into which runs were cut; None where none was."""
    lengths = [
        np.diff([curve["time"][0], *curve["borders"], curve["time"][-1]])
        for curve in curves.values()
        if len(curve.get("borders") or ())
    ]
    return float(np.median(np.concatenate(lengths))) if lengths else None


def _words(curves: Curves) -> quantities.JointWords:
    """The words of the joints: a linear one is alone on its platform."""
    axes = [(curve, axis) for curve in curves.values() for axis in curve.get("angle") or {}]
    return quantities.joint_words(*axes[0]) if axes else quantities.ROTARY


def _motion(
    diagnosis: Mapping[str, Any], curves: Curves, key: str
) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """Figures of the runs: the two worst validation runs, and all the others."""
    lines = sum(6 * len(curve["signals"]) for curve in curves.values())
    points = min(max(POINTS_IN_ALL // max(lines, 1), 100), 900)
    entries, sheets = [], figures.Sheets()
    for key_of_curve, curve in curves.items():
        run = curve.get("run", key_of_curve)
        errors = {s: tables.error_of(diagnosis, curve["set"], s, run) for s in tables.STAGES}
        svg = figures.motion_figure(curve, _floors(diagnosis, curve["set"]), points, sheets)
        before, after = (errors[stage].get(key) for stage in ("before", "after"))
        entries.append(
            {"run": run, "set": curve["set"], "svg": Markup(svg), "before": before, "after": after}
        )
    entries.sort(key=lambda e: (e["set"] != "validate", e["run"]))
    entries.sort(key=lambda e: -e["before"] if usable(e["before"]) else 0.0)
    validation = [e for e in entries if e["set"] == "validate"]
    shown = (validation or entries)[:SHOWN_RUNS]
    rest = sorted(entries, key=lambda e: (e["set"] != "validate", e["run"]))
    return shown, [entry for entry in rest if entry not in shown]


def _floors(diagnosis: Mapping[str, Any], set_name: str) -> dict[str, float]:
    """Noise floor (rms) of every signal, in counts where it has an encoder."""
    found = tables.signal_errors(diagnosis, set_name, "noise_floor")
    return {name: value for name, (value, _) in found.items() if usable(value)}


def _residual_maps(diagnosis: Mapping[str, Any], curves: Curves) -> list[dict[str, Any]]:
    """One figure per measured signal, validation runs pooled (all runs when there are none)."""
    pooled = {run: c for run, c in curves.items() if c["set"] == "validate"} or dict(curves)
    found = []
    for signal in dict.fromkeys(name for curve in pooled.values() for name in curve["signals"]):
        runs = [curve for curve in pooled.values() if signal in curve["signals"]]
        axes = [a for a in runs[0].get("angle") or {} if all(a in r["rate"] for r in runs)]
        if not axes:
            continue
        axis = next((axis for axis in axes if signal.endswith(f"_{axis}")), axes[0])
        floor = _floors(diagnosis, runs[0]["set"]).get(signal)
        svg = map_figures.residual_map_figure(signal, axis, pooled, floor)
        found.append(
            {"signal": signal, "svg": Markup(svg), "runs": len(runs), "set": runs[0]["set"]}
        )
    return found


def _torque_maps(left: Mapping[str, Any] | None) -> list[dict[str, Any]]:
    """One figure per axis of the torque that is left along the measured motion."""
    maps = left["maps"] if left else []
    return [
        {
            "axis": axis,
            "svg": Markup(
                map_figures.torque_map_figure([m for m in maps if m["axis"] == axis], left["unit"])
            ),
        }
        for axis in dict.fromkeys(m["axis"] for m in maps)
        if left
    ]


def _equations(diagnosis: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Equations of the added effects; MathML is left out unless it is formula markup alone.

    Each of its lines becomes a formula of its own, so that a long equation wraps like text.
    """
    found = []
    for equation in diagnosis.get("equations") or []:
        mathml = str(equation.get("mathml") or "").strip()
        pieces = None
        if mathml and "<" not in _MATHML_TAG.sub("", mathml):
            pieces = [
                Markup('<math displaystyle="true">{}</math>').format(
                    Markup(re.sub(r"^<math[^>]*>|</math>$", "", line))
                )
                for line in mathml.splitlines()
            ]
        found.append({**equation, "mathml": pieces})
    return found


def write_curves_csv(curves: Curves) -> dict[str, str]:
    """Every plotted curve as CSV text by file name: one file per run, a header `name [unit]`."""
    texts: dict[str, str] = {}
    for run, curve in curves.items():
        columns = list(_columns(curve))
        rows = np.column_stack([values for _, values in columns]).tolist()
        lines = [",".join(header for header, _ in columns)]
        lines += [",".join(map(repr, row)) for row in rows]
        stem = re.sub(r"[^A-Za-z0-9._-]+", "_", f"{curve['set']}-{run}")
        while f"{stem}.csv" in texts:
            stem += "_"
        texts[f"{stem}.csv"] = "\n".join(lines) + "\n"
    return texts


def _columns(curve: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    yield "time [s]", curve["time"]
    for axis, angle in (curve.get("angle") or {}).items():
        words = quantities.joint_words(curve, axis)
        yield f"{words.angle}_{axis} [{words.unit}]", angle
    for axis, rate in (curve.get("rate") or {}).items():
        words = quantities.joint_words(curve, axis)
        yield f"{words.rate}_{axis} [{words.unit}/s]", rate
    for name, given in (curve.get("inputs") or {}).items():
        yield f"{name} [{given['unit']}]", given["values"]
    for name, signal in curve["signals"].items():
        for stage in ("measured", "before", "after"):
            if signal.get(stage) is not None:
                yield f"{name}_{stage} [{signal.get('unit') or ''}]", signal[stage]
        for stage in ("before", "after"):
            values = figures.residual(signal, stage)
            if values is not None:
                yield f"{name}_residual_{stage} [{figures.residual_unit(signal)}]", values
