"""A sampled controller that drives the motor from a set point and the encoder, as the LM629 does.

The integral part is limited, not the sum behind it: as in the LM629 the sum goes on growing.
"""

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.contribution import (
    Change,
    Contribution,
    Input,
    Sampler,
    State,
)
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place
from ptp_symbolic.symbolic.effects.encoder_quantization import NearestCount
from ptp_symbolic.symbolic.symbols import ZERO

PARAMETERS = (
    Parameter("K_p_{axis}", "V/rad", 100.0, 0.0, 1e9, "proportional gain"),
    Parameter("K_i_{axis}", "V/(rad s)", 0.0, 0.0, 1e9, "integral gain"),
    Parameter("K_d_{axis}", "V s/rad", 0.0, 0.0, 1e9, "derivative gain"),
    Parameter("u_i_max_{axis}", "V", 24.0, 0.0, 1e6, "largest integral part"),
    Parameter("t_sample_{axis}", "s", 2048 / 6e6, 1e-6, 1e3, "sampling time of the controller"),
    Parameter("n_d_{axis}", "1", 1.0, 1.0, 256.0, "whole samples from derivative to derivative"),
    Parameter("u_full_{axis}", "V", 24.0, 1e-3, 1e6, "largest command"),
    Parameter("n_u_{axis}", "1", 128.0, 1.0, 1e12, "steps of the command up to the largest"),
)
STATES = (
    ("command_{axis}", "V", "voltage that the {axis} controller commands"),
    ("integral_{axis}", "rad s", "errors of the {axis} controller, summed over time"),
    ("derivative_{axis}", "rad/s", "rate of the error as the {axis} controller sees it"),
    ("last_error_{axis}", "rad", "error of the {axis} controller at the last derivative"),
)


def _within(value: sp.Expr, limit: sp.Expr) -> sp.Expr:
    return sp.Max(sp.Min(value, limit), -limit)


def _contribute(place: Place) -> Contribution:
    kp, ki, kd, limit, period, every, full, steps = place.symbols(PARAMETERS)
    command, integral, derivative, last = (place.parameter(name) for name, _, _ in STATES)
    wanted = place.parameter("setpoint_{axis}")
    error, total, asked = map(place.parameter, ("error_{axis}", "sum_{axis}", "asked_{axis}"))
    between = NearestCount(every, 1) * period
    seen = {error: wanted - place.quantity(f"reading_{place.angle}")}
    part = _within(ki * total, limit)
    sums = {total: integral + period * error, asked: kp * error + part + kd * derivative}
    given = _within(NearestCount(asked, full / steps), full)
    return Contribution(
        quantities={f"computed_{place.axis}": command, f"sampling_{place.axis}": period},
        changes={f"command_{place.axis}": Change(through=lambda _: command)},
        commands={
            place.own_axis: (Input(str(wanted), "rad", f"angle asked of the {place.axis} joint"),)
        },
        states=tuple(
            State(name.format(axis=place.axis), unit, text.format(axis=place.axis), ZERO)
            for name, unit, text in STATES
        ),
        samplers=(
            Sampler(between, {derivative: (error - last) / between, last: error}, terms=seen),
            Sampler(period, {command: given, integral: total}, terms=seen | sums),
        ),
    )


PID_CONTROLLER = Effect(
    id="pid_controller",
    title="sampled PID controller on the encoder",
    reference="National Semiconductor LM629 data sheet, PID filter (6 MHz clock); thesis 3.2.3.1",
    parameters=PARAMETERS,
    contribute=_contribute,
    structural=True,
    needs=("command_{axis}",),
)
