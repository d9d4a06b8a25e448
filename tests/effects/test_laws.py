"""Laws that hold for every effect of the catalogue, and the check that refuses what breaks them."""

import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from importlib.metadata import EntryPoint
from pathlib import Path

import pytest

import ptp_symbolic as ptp
from ptp_symbolic.api.effect_bases import bases, machine_with
from ptp_symbolic.api.effect_laws import LAWS, Case
from ptp_symbolic.models import variants
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.report.derivation.power import judged
from ptp_symbolic.symbolic import effects as catalogue
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.documents.laws import laws
from ptp_symbolic.symbolic.effect_interface.contribution import Contribution, Switch
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place, active, side
from ptp_symbolic.symbolic.effects import EFFECTS, effects_of_others, on_trial
from ptp_symbolic.symbolic.effects.quadratic_drag import QUADRATIC_DRAG

PACKAGED = catalogue.PACKAGED


def test_every_effect_has_its_file_and_one_import() -> None:
    folder = Path(catalogue.__file__).parent
    files = {p.stem for p in folder.glob("*.py")} - {"__init__"}
    ids = {effect.id for effect in PACKAGED}
    assert files == ids, "a file per effect, imported and listed in effects/__init__.py"
    assert all(len(p.read_text().splitlines()) <= 80 for p in folder.glob("*.py") if p.stem in ids)


@cache
def case_of(identifier: str) -> Case:
    effect = next(effect for effect in EFFECTS if effect.id == identifier)
    return Case(effect, machine_with(effect))


@pytest.mark.parametrize("effect", EFFECTS, ids=lambda effect: effect.id)
@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.__name__)
def test_every_effect_obeys_every_law(effect: Effect, law: Callable[[Case], None]) -> None:
    law(case_of(effect.id))


@pytest.mark.parametrize("base", bases(), ids=lambda base: base.name)
def test_all_candidates_fit_into_one_machine(base: Platform) -> None:
    """Names of parameters and states differ: a diagnosis places them all at once."""
    everything = replace(base, effects=(*base.effects, *variants.candidate_effects(base)))
    assert len(assemble(everything).effects) == len(everything.effects)


def test_an_unknown_effect_is_refused() -> None:
    base = bases()[0]
    with pytest.raises(ValueError, match=r"Unknown effect 'wings'; the nearest are "):
        assemble(replace(base, effects=(*base.effects, EffectDeclaration("wings", None, None))))


# An end stop with a switch, as its author would write it: beyond the angle q_s a spring and a
# damper act while the joint goes deeper, and the spring alone while it comes back.

STIFFNESS = Parameter("k_wall_{axis}", "N m/rad", 0.0, 0.0, 1e6, "stiffness", vanishes=0.0)
DAMPING = Parameter("d_wall_{axis}", "N m s/rad", 0.0, 0.0, 1e6, "damping", vanishes=0.0)
WALL = Parameter("theta_wall_{axis}", "rad", 0.5, 1e-3, 100.0, "angle of the walls")


def walls(place: Place, sign: int = 1) -> Contribution:
    stiffness, damping, wall = place.symbols((STIFFNESS, DAMPING, WALL))
    name = f"wall_{place.axis}"
    deeper, touched = active(name), side(name)
    depth = place.angle - touched * wall
    lost = sign * damping * place.rate * deeper
    return Contribution(
        potential=stiffness * depth**2 * touched**2 / 2,
        torques={place.rate: -lost},
        switches=(Switch(name, place.angle, wall, place.rate),),
    )


def end_stop(**changes: object) -> Effect:
    given = {
        "id": "switched_walls",
        "title": "walls with a switch",
        "reference": "hand-written",
        "parameters": (
            replace(STIFFNESS, starts=(100.0,)),
            replace(DAMPING, starts=(2.0,)),
            WALL,
        ),
        "contribute": walls,
        "dissipative": True,
        "separating_experiment": "Turn the joint to its ends by hand.",
        **changes,
    }
    return Effect(**given)  # type: ignore[arg-type]


def test_a_correct_end_stop_with_a_switch_passes_and_is_judged_dissipative() -> None:
    stop = end_stop()
    assert len(ptp.check_effect(stop)) == len(LAWS)
    with on_trial(stop):
        platform = machine_with(stop)
        law = next(each for each in laws(platform) if each.effect.id == stop.id)
        equations = assemble(platform)
        assert judged(law, law.ledger, equations).only_dissipates
    assert stop.id not in {effect.id for effect in EFFECTS}


def driving(place: Place) -> Contribution:
    return walls(place, sign=-1)


def unaccounted(place: Place) -> Contribution:
    stiffness, damping, wall = place.symbols((STIFFNESS, DAMPING, WALL))
    return Contribution(
        torques={place.rate: -stiffness * place.angle - damping * place.rate * wall},
        stored=stiffness * place.angle**2,
    )


def in_other_units(place: Place) -> Contribution:
    stiffness, damping, wall = place.symbols((STIFFNESS, DAMPING, WALL))
    return Contribution(torques={place.rate: -stiffness * place.rate - damping * place.rate / wall})


def always_there(place: Place) -> Contribution:
    stiffness, damping, wall = place.symbols((STIFFNESS, DAMPING, WALL))
    return Contribution(torques={place.rate: -(damping + stiffness * wall + 1) * place.rate})


def idle(place: Place) -> Contribution:
    return Contribution()


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"contribute": driving}, "it is `dissipative`, and feeds .* W at .* correct the sign"),
        ({"contribute": unaccounted}, "its energies do not balance: .* W come from nowhere"),
        ({"contribute": in_other_units, "dissipative": False}, "units do not fit mode_derivative"),
        ({"contribute": always_there}, "at its vanishing values it changes the force on omega_pan"),
        ({"contribute": idle}, "parameter 'd_wall_pan' is in no equation; use it"),
        ({"separating_experiment": ""}, "say by `separating_experiment` which run"),
        ({"needs": ("unobtainium_{axis}",)}, "no machine has all that it `needs`, unobtainium"),
        (
            {
                "parameters": (
                    replace(STIFFNESS, vanishes=None),
                    replace(DAMPING, vanishes=None),
                    WALL,
                )
            },
            "give one of its parameters `vanishes`",
        ),
    ],
)
def test_an_effect_that_breaks_a_law_is_refused_by_name(
    changes: dict[str, object], message: str
) -> None:
    with pytest.raises(ptp.InputError, match=message) as found:
        ptp.check_effect(end_stop(**changes))
    assert str(found.value).startswith("Effect 'switched_walls': ")


def test_what_is_no_effect_is_refused() -> None:
    with pytest.raises(ptp.InputError, match="is of type str; give an Effect"):
        ptp.check_effect("quadratic_drag")  # type: ignore[arg-type]


def named(monkeypatch: pytest.MonkeyPatch, value: str) -> None:
    point = EntryPoint("own", value, catalogue.GROUP)
    monkeypatch.setattr(catalogue, "entry_points", lambda group: [point])


def test_an_installed_package_adds_its_effects(tmp_path: Path) -> None:
    """A package of one module and its metadata, as pip would leave them, in a fresh interpreter."""
    (tmp_path / "windage.py").write_text(
        "from dataclasses import replace\n"
        "from ptp_symbolic.symbolic.effects.quadratic_drag import QUADRATIC_DRAG\n"
        "WINDAGE = replace(QUADRATIC_DRAG, id='windage', parameters=tuple(\n"
        "    replace(p, name='w_' + p.name) for p in QUADRATIC_DRAG.parameters),\n"
        "    contribute=lambda place: QUADRATIC_DRAG.contribute(place))\n"
    )
    metadata = tmp_path / "windage-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: windage\nVersion: 1.0\n")
    (metadata / "entry_points.txt").write_text(
        "[ptp_symbolic.effects]\nwindage = windage:WINDAGE\n"
    )
    program = (
        "from ptp_symbolic.symbolic.effects import EFFECTS; print(EFFECTS[-1].id, len(EFFECTS))"
    )
    ran = subprocess.run(
        [sys.executable, "-c", program],
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
    )
    assert ran.stdout == f"windage {len(PACKAGED) + 1}\n", ran.stderr


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ("nowhere_at_all:EFFECT", "cannot be loaded: No module named 'nowhere_at_all'"),
        ("math:pi", "is of type float; give an Effect"),
        (
            "ptp_symbolic.symbolic.effects.quadratic_drag:QUADRATIC_DRAG",
            "has the id 'quadratic_drag', which is taken",
        ),
    ],
)
def test_an_effect_of_another_package_that_cannot_be_used_is_refused(
    value: str, message: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    named(monkeypatch, value)
    with pytest.raises(ptp.InputError, match=message):
        effects_of_others()


def test_an_effect_on_trial_takes_the_place_of_its_namesake() -> None:
    other = replace(QUADRATIC_DRAG, title="another drag")
    with on_trial(other):
        found = catalogue.catalogue()
        assert other in found and QUADRATIC_DRAG not in found
        assert len(found) == len(EFFECTS)
    assert catalogue.catalogue() == EFFECTS
