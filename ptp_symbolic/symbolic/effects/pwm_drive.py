"""A bridge that turns a commanded voltage into pulses of its supply, averaged or pulse by pulse.

Both come from the same duty, command over supply within -1 and 1. Switching, it is taken when a
carrier period starts; the pulse ends exactly where it says. The bridge has no losses.
"""

from collections.abc import Callable
from dataclasses import replace

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution, Sampler, State
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place
from ptp_symbolic.symbolic.symbols import ZERO

Contributing = Callable[[Place], Contribution]
SUPPLY = Parameter("u_supply_{axis}", "V", 24.0, 1e-3, 1e6, "supply voltage of the {axis} bridge")
CARRIER = Parameter("f_pwm_{axis}", "Hz", 6e6 / 512, 1e-3, 1e8, "carrier of the {axis} bridge")


def _duty(place: Place) -> sp.Expr:
    share = place.quantity("command_{axis}") / place.parameter(SUPPLY.name)
    return sp.Max(sp.Min(share, 1), -1)


def _averaged(place: Place) -> Contribution:
    voltage = place.parameter(SUPPLY.name) * _duty(place)
    return Contribution(changes={f"drive_voltage_{place.axis}": Change(through=lambda _: voltage)})


def _pulses(place: Place, high: sp.Expr, low: sp.Expr, until: sp.Expr) -> Contribution:
    """High until a fraction of the carrier period, a function of the duty, then low."""
    period = 1 / place.parameter(CARRIER.name)
    bridge, duty = map(place.parameter, ("bridge_{axis}", "duty_{axis}"))
    return Contribution(
        changes={f"drive_voltage_{place.axis}": Change(through=lambda _: bridge)},
        states=(
            State(str(bridge), "V", f"voltage of the {place.axis} bridge", ZERO),
            State(str(duty), "1", f"duty of the {place.axis} bridge", ZERO),
        ),
        samplers=(
            Sampler(period, {bridge: high, duty: _duty(place)}),
            Sampler(period, {bridge: low}, phase=until),
        ),
    )


def _switching(place: Place) -> Contribution:
    supply, duty = place.parameter(SUPPLY.name), place.parameter("duty_{axis}")
    high = sp.Piecewise((supply, _duty(place) >= 0), (-supply, True))
    return _pulses(place, high, ZERO, sp.Max(duty, -duty))


def _bipolar(place: Place) -> Contribution:
    supply, duty = place.parameter(SUPPLY.name), place.parameter("duty_{axis}")
    return _pulses(place, supply, -supply, (1 + duty) / 2)


def _kind(kind: str, title: str, contribute: Contributing, *given: Parameter) -> Effect:
    return Effect(
        id="pwm_drive",
        kind=kind,
        title=title,
        contribute=contribute,
        structural=True,
        reference="Mohan (2003), section 7 (full bridge); LM629 data sheet; thesis section 3.2.3.1",
        parameters=given,
        needs=("drive_voltage_{axis}",),
    )


KINDS = (
    _kind("switching", "bridge that switches supply and zero", _switching, SUPPLY, CARRIER),
    _kind("bipolar", "bridge that switches both signs of its supply", _bipolar, SUPPLY, CARRIER),
)
PWM_DRIVE = replace(_kind("averaged", "pulsed bridge, averaged", _averaged, SUPPLY), kinds=KINDS)
