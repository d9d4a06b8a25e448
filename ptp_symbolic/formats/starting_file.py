"""A platform file to start from: commented, with every number that is not known left open."""

from collections.abc import Iterator

from ptp_symbolic.formats.machine_kinds import MACHINES, Kind
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.symbolic.derivation.placement import place_effects
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter

SCHEMA_NAME = "platform.schema.json"
FRICTION = "csvs_friction"


def starting_text(name: str, machine: str, drive: str) -> str:
    """The text of a platform file named `name` for one of the `MACHINES` with one of the `DRIVES`.

    Numbers to fill in are nan, which the reader of platforms refuses by the name of its parameter.
    """
    kind = MACHINES[machine]
    declared = tuple(_declared(kind, drive))
    linear_axes = kind.axes if kind.linear else ()
    platform = Platform(
        name, kind.title, kind.axes, 9.81, declared, (), (), linear_axes=linear_axes
    )
    return "\n".join(
        [
            f"#:schema {SCHEMA_NAME}",
            "# A platform of ptp-symbolic. Fill in every nan; then run",
            f"#   ptp-symbolic check --platform {name}.toml YOUR_LOG.csv",
            "",
            *_head(platform),
            *_effects(platform),
            *_parameters(platform),
            *_signals(platform, drive),
        ]
    )


def _declared(kind: Kind, drive: str) -> Iterator[EffectDeclaration]:
    yield EffectDeclaration("rigid_bodies", None, None)
    if "tilt" in kind.axes:
        yield EffectDeclaration("payload", None, None)
    for axis in kind.axes:
        if drive == "motor":
            yield EffectDeclaration("dc_motor", axis, None)
        yield EffectDeclaration(FRICTION, axis, None)


def _head(platform: Platform) -> Iterator[str]:
    yield "[platform]"
    yield f'name = "{platform.name}"'
    yield f'title = "{platform.title}"'
    axes = ", ".join(f'"{axis}"' for axis in platform.axes)
    yield f"axes = [{axes}]"
    if platform.linear_axes:
        yield 'joints = { pan = "linear" }  # theta_pan is a position in m, tau_pan a force in N'
    yield ""


def _effects(platform: Platform) -> Iterator[str]:
    yield "# What acts on it. `ptp-symbolic effects` lists what else there is; what is missing here"
    yield "# and shows in the logs, `ptp-symbolic diagnose` looks for."
    titles = {e.id: e.worded_at(place).title for e, place in place_effects(platform)}
    for declared in platform.effects:
        yield "[[effects]]"
        yield f'effect = "{declared.effect}"  # {titles[declared.effect]}'
        if declared.axis is not None:
            yield f'axis = "{declared.axis}"'
        yield ""


def _parameters(platform: Platform) -> Iterator[str]:
    yield "# value: known. start: free, fitted to the logs from there on, within its bounds."
    yield "[parameters]"
    for effect, place in place_effects(platform):
        where = "" if place.axis is None else f", {place.axis}"
        yield f"# {effect.worded_at(place).title}{where}"
        for parameter in effect.parameters_at(place):
            yield _parameter(parameter, is_free=effect.id == FRICTION)
        yield ""


def _parameter(parameter: Parameter, is_free: bool) -> str:
    unit = f'unit = "{parameter.unit}"'
    given = f"value = {parameter.default!r}" if parameter.has_natural_default else "value = nan"
    bounds = ""
    if is_free:
        given, bounds = "start = nan", f", bounds = [{parameter.lower!r}, {parameter.upper!r}]"
    return f"{parameter.name} = {{ {given}, {unit}{bounds} }}  # {parameter.meaning}"


def _signals(platform: Platform, drive: str) -> Iterator[str]:
    yield "# Columns of the logs. With a `scale`, in `unit` per number, columns may be raw counts."
    yield "[signals]"
    linear = bool(platform.linear_axes)
    force = "N" if linear else "N m"
    letter, unit = ("u", "V") if drive == "motor" else ("tau", force)
    counts = "counts_per_metre" if linear else "counts_per_revolution"
    position, rate = ("m", "m/s") if linear else ("rad", "rad/s")
    for axis in platform.axes:
        yield _signal(f"{letter}_{axis}", "input", unit)
        yield f"{_signal(f'theta_{axis}', 'output', position)[:-2]}, {counts} = nan }}"
        yield f"# {_signal(f'omega_{axis}', 'output', rate)[:-2]}, noise = nan }}"
        if drive == "motor":
            yield f"# {_signal(f'i_{axis}', 'output', 'A')[:-2]}, noise = nan }}"
    yield ""


def _signal(name: str, role: str, unit: str) -> str:
    return f'{name} = {{ role = "{role}", column = "{name}", unit = "{unit}" }}'
