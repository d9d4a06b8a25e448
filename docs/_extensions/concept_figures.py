"""Figures of the concept pages: the drawing of a machine, and small computations of their own."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from effect_pages import write_if_new
from matplotlib.axes import Axes
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from numpy.typing import NDArray
from sphinx.application import Sphinx

from ptp_symbolic.platform import read_platform
from ptp_symbolic.report.drawing import drawn, svg_text
from ptp_symbolic.report.figures import AFTER, BEFORE, FLOOR, MEASURED, STYLE
from ptp_symbolic.symbolic.derivation.assembly import assemble

FloatArray = NDArray[np.float64]

FOLDER = "_generated"
PLATFORM = "thesis-full"
DRIVES = ("drive_pan", "drive_tilt")
SEED = 5
REPETITIONS, SAMPLES, BLOCKS = 400, 5000, 20
CORRELATION = 0.95  # of neighbouring samples of an AR(1) noise
SHOWN = 40  # intervals in the figure
STEPS = (
    "fit the declared model\nto the training runs",
    "residual at the\nnoise floor?",
    "compare all candidates\nalong the measured motion",
    "refit the best sets\nby simulation",
    "is each effect significant,\nlarge enough, off its bounds?",
    "does it hold on runs\nthat were never fitted?",
    "named, with what\ncannot be told from it",
)
ASIDES = {
    1: "yes: nothing_missing",
    4: "none is: unexplained",
    5: "no: unexplained\nyes, noise remains: explained\nyes, more remains: partly_explained",
    6: "something predicts as well:\nexplained_up_to_group",
}


def setup(app: Sphinx) -> dict[str, Any]:
    """Draw before the sources are read."""
    app.connect("builder-inited", draw)
    return {"version": "1", "parallel_read_safe": True}


def draw(app: Sphinx) -> None:
    """Write all figures into `_generated/`."""
    folder = Path(app.srcdir) / FOLDER
    folder.mkdir(exist_ok=True)
    platform = read_platform(PLATFORM)
    picture = drawn(platform, assemble(platform))
    for name, scene in (("frames", picture.frames), *zip(DRIVES, picture.drives, strict=True)):
        write_if_new(folder / f"{name}.md", f'<div class="drawing">\n{svg_text(scene)}\n</div>\n')
    rows = "\n".join(f"| {e.number} | `{e.effect}` | {e.title} |" for e in picture.key)
    write_if_new(folder / "key.md", f"| No. | Effect | What it is |\n|---|---|---|\n{rows}\n")
    for name, size, figure in (
        ("friction_modes", (6.2, 3.0), _friction_modes),
        ("verdict", (6.6, 6.4), _verdict),
        ("noise_floor", (6.4, 3.0), _noise_floor),
        ("coverage", (6.4, 4.2), _coverage),
    ):
        _save(figure, size, folder / f"{name}.svg")


def _save(figure_of: Callable[[Axes], None], size: tuple[float, float], path: Path) -> None:
    style = {**STYLE, "svg.fonttype": "path", "font.size": 9.5}
    with matplotlib.rc_context(style):
        figure = Figure(figsize=size, layout="constrained")
        FigureCanvasSVG(figure)
        figure_of(figure.subplots())
        figure.savefig(path, format="svg", metadata={"Date": None})


def _friction_modes(axes: Axes) -> None:
    """Dry friction as a set: sliding levels, and at rest all torques up to breakaway."""
    rate = np.linspace(0.0, 1.0, 200)
    level = 0.24 + 0.26 * np.exp(-((rate / 0.12) ** 2)) + 0.12 * rate
    for sign in (-1.0, 1.0):
        axes.plot(sign * rate, sign * level, color=AFTER, linewidth=1.6)
    axes.plot([0.0, 0.0], [-0.5, 0.5], color=BEFORE, linewidth=2.2)
    axes.annotate("slides forward", (0.55, 0.36), color=AFTER)
    axes.annotate("slides backward", (-0.95, -0.45), color=AFTER)
    axes.annotate("sticks: any torque up to breakaway", (0.03, -0.12), color=BEFORE)
    axes.set_xlabel("rate")
    axes.set_ylabel("friction torque")
    axes.set_xticks([])
    axes.set_yticks([])


def _verdict(axes: Axes) -> None:
    """The steps from a fit to a verdict."""
    axes.set_axis_off()
    axes.set_xlim(0.0, 10.0)
    axes.set_ylim(-len(STEPS) + 0.4, 0.6)
    box = {"boxstyle": "round,pad=0.45", "facecolor": "#eef4f8", "edgecolor": AFTER}
    side = {"boxstyle": "round,pad=0.35", "facecolor": "#fbf1ea", "edgecolor": BEFORE}
    for number, text in enumerate(STEPS):
        axes.text(3.0, -number, text, ha="center", va="center", bbox=box)
        if number:
            arrow = {"arrowstyle": "->", "color": "#6b747e"}
            axes.annotate("", (3.0, -number + 0.3), (3.0, -number + 0.7), arrowprops=arrow)
    for number, text in ASIDES.items():
        arrow = {"arrowstyle": "->", "color": BEFORE}
        axes.annotate("", (5.9, -number), (5.2, -number), arrowprops=arrow)
        axes.text(7.9, -number, text, ha="center", va="center", bbox=side)


def _noise_floor(axes: Axes) -> None:
    """Residuals of a model that lacks an effect, and of one that does not."""
    random = np.random.default_rng(SEED)
    time = np.linspace(0.0, 10.0, 500)
    noise = random.normal(0.0, 0.35, time.size)
    lacking = 2.2 * np.sin(1.9 * time) * np.sign(np.cos(0.9 * time)) + noise
    axes.axhspan(-0.7, 0.7, color=FLOOR, label="noise, two standard deviations")
    axes.plot(time, lacking, color=BEFORE, linewidth=1.0, label="an effect is missing")
    axes.plot(time, noise, color=AFTER, linewidth=1.0, label="nothing is missing")
    axes.set_xlabel("time [s]")
    axes.set_ylabel("residual [counts]")
    axes.set_ylim(-3.2, 4.4)
    axes.legend(frameon=False, loc="upper right", ncols=3, fontsize=8)


def _coverage(axes: Axes) -> None:
    """Intervals of a mean under autocorrelated noise: by white noise, and by a block jackknife."""
    found = {"white-noise formula": 0, "block jackknife": 0}
    for number, noise in enumerate(_autocorrelated(REPETITIONS)):
        own = intervals(noise)
        for column, (name, (middle, half)) in enumerate(own.items()):
            found[name] += abs(middle) <= half
            if number < SHOWN:
                colour = AFTER if abs(middle) <= half else BEFORE
                at = number + column * (SHOWN + 6)
                axes.plot([at, at], [middle - half, middle + half], color=colour, linewidth=1.6)
    axes.axhline(0.0, color=MEASURED, linewidth=1.0)
    axes.set_xticks([SHOWN / 2, SHOWN / 2 + SHOWN + 6])
    shares = [
        f"{name}\n{100 * n / REPETITIONS:.0f} % contain the truth" for name, n in found.items()
    ]
    axes.set_xticklabels(shares)
    axes.set_ylabel("estimate, truth at zero")


def _autocorrelated(repetitions: int) -> FloatArray:
    """Noise [repetitions, SAMPLES] of variance one and the autocorrelation of a first-order lag."""
    random = np.random.default_rng(SEED)
    noise = random.normal(size=(repetitions, SAMPLES))
    for k in range(1, SAMPLES):
        fresh = np.sqrt(1.0 - CORRELATION**2) * noise[:, k]
        noise[:, k] = CORRELATION * noise[:, k - 1] + fresh
    return noise


def intervals(samples: FloatArray) -> dict[str, tuple[float, float]]:
    """The mean of `samples` [n] and the half width of its 95 % interval, by two methods."""
    from scipy import stats

    mean = float(samples.mean())
    white = float(samples.std(ddof=1)) / np.sqrt(samples.size)
    blocks = samples.reshape(BLOCKS, -1)
    left_out = (samples.sum() - blocks.sum(axis=1)) / (samples.size - blocks.shape[1])
    spread = np.sqrt((BLOCKS - 1) / BLOCKS * np.sum((left_out - left_out.mean()) ** 2))
    return {
        "white-noise formula": (mean, float(stats.norm.ppf(0.975)) * white),
        "block jackknife": (mean, float(stats.t.ppf(0.975, BLOCKS - 1)) * float(spread)),
    }
