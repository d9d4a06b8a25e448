"""A linear joint in place of a rotary one: the same effects and equations, other units and words.

Effects declare units for a joint that turns: its coordinate in rad, what acts on it in N m, what
it carries in kg m^2 (energies are in J throughout). On a joint that slides these are m, N and kg,
wherever they stand in a unit. What belongs to the motor behind the joint turns all the same; its
parameters say so.
"""

import re
from dataclasses import replace

from ptp_symbolic.symbolic.effect_interface.contribution import (
    Contribution,
    Drive,
    Input,
    Sensor,
    State,
)
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter

_UNITS = (("kg m^2", "kg"), ("N m", "N"), ("rad", "m"))
_WORDS = {"angle": "position", "torque": "force", "rate": "speed", "inertia": "mass"}


def linear_unit(unit: str) -> str:
    """The unit on a linear joint of what has `unit` on a rotary one: N m/rad becomes N/m."""
    for rotary, linear in _UNITS:
        unit = unit.replace(rotary, linear)
    return unit


def linear_words(text: str) -> str:
    """`text` about a rotary joint in the words of a linear one: torque becomes force."""
    for rotary, linear in _WORDS.items():
        text = re.sub(rf"\b{rotary}(s?)\b(?! of change)", rf"{linear}\1", text)
    return text


def linear_parameter(parameter: Parameter) -> Parameter:
    """`parameter` on a linear joint: what it says of one itself, and the rest by rule."""
    own = dict(parameter.linear or {})
    if parameter.turns:
        return replace(parameter, **own)
    unit, meaning = linear_unit(parameter.unit), linear_words(parameter.meaning)
    return replace(parameter, **{"unit": unit, "meaning": meaning, **own})


def linear_contribution(given: Contribution) -> Contribution:
    """`given` with the units and words of its states and inputs on a linear joint; its sensors are
    of the motor, which turns.
    """
    return replace(
        given,
        states=tuple(map(_state, given.states)),
        drives=tuple(map(_drive, given.drives)),
        commands={axis: tuple(map(_input, inputs)) for axis, inputs in given.commands.items()},
        prescribed={rate: _input(own) for rate, own in given.prescribed.items()},
        inputs=tuple(map(_input, given.inputs)),
    )


def linear_sensor(sensor: Sensor) -> Sensor:
    """`sensor` of a joint or shaft with its unit and words on a linear joint."""
    return replace(sensor, unit=linear_unit(sensor.unit), meaning=linear_words(sensor.meaning))


def _state(state: State) -> State:
    if state.turns:
        return state
    return replace(state, unit=linear_unit(state.unit), meaning=linear_words(state.meaning))


def _drive(drive: Drive) -> Drive:
    return replace(drive, inputs=tuple(map(_input, drive.inputs)))


def _input(given: Input) -> Input:
    return replace(given, unit=linear_unit(given.unit), meaning=linear_words(given.meaning))
