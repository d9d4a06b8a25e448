"""How visible a hidden effect is, and the size at which it becomes visible.

Visible response: change of the outputs by the effect, truth with it against truth without it under
the same inputs (over whole runs, or over windows that begin at the recorded state), less all that
small changes of the free parameters and of the starts reproduce: their finite differences are
projected off. In floors of an output; of several outputs the largest counts.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tests.benchmark.effects import Shape
from tests.benchmark.machine import (
    CURRENT_NOISE,
    Floats,
    Machine,
    Recording,
    Values,
    angle_floor,
)
from tests.benchmark.structures import Structure
from tests.benchmark.variation import Variation

RELATIVE_STEP = 1e-3  # of a parameter, for finite differences
SAMPLE_SPACING = 0.01  # s between the samples that are judged
THRESHOLD_FLOORS = 5.0
THRESHOLD_SHARE = 0.05  # of the Coulomb torque, rms
LARGEST_SHARE = 6.0  # a torque this large at the threshold is absorbed by the machine
RANK_TOLERANCE = 1e-7
THRESHOLD_ACCURACY = 0.1  # of the threshold
MOST_PROBES = 8
IRREGULAR = 0.3  # of a change by parameters, for what does not turn around with their sign
NEGLIGIBLE_FLOORS = 0.2
LEAST_REGULAR = 0.5  # of the samples


class AbsorbedError(ValueError):
    """An effect that stays invisible at every sane size."""


@dataclass(frozen=True)
class Seen:
    """Response in floors rms and torque in shares of the Coulomb torque rms (None: no torque)."""

    floors: float
    share: float | None

    def against_threshold(self) -> float:
        """One at the threshold, about proportional to the size."""
        visible = self.floors / THRESHOLD_FLOORS
        return visible if self.share is None else min(visible, self.share / THRESHOLD_SHARE)


class Yardstick:
    """Measures responses on the training runs of one machine with nothing hidden in it."""

    def __init__(
        self,
        machine: Machine,
        values: Values,
        recordings: Sequence[Recording],
        variation: Variation,
    ) -> None:
        self.machine, self.values, self.variation = machine, values, variation
        self.recordings = list(recordings)
        self.floors = np.full(len(machine.axes), angle_floor(variation))
        if machine.voltage_driven and variation.current:
            currents = np.full(len(machine.axes), CURRENT_NOISE)
            self.floors = np.append(self.floors, currents)
        self.stride = max(1, round(SAMPLE_SPACING / variation.period))
        self.widening = np.ones(len(self.floors))
        self.base = self._outputs(values)
        self.basis = self._basis()

    def _outputs(self, values: Values, shift: int = -1) -> list[Floats]:
        """Readings [n, outputs] per run along the recorded inputs, thinned out, in floors."""
        return [
            self._read(values, self.machine.replay(values, recording, shift=shift))
            for recording in self.recordings
        ]

    def _read(self, values: Values, states: Floats) -> Floats:
        """Readings [n, outputs] of states, thinned out, in floors."""
        return self.machine.readings(values, states, self.variation)[:: self.stride] / self.floors

    def _difference(self, outputs: list[Floats]) -> Floats:
        """Change [n, outputs] of all runs against the base."""
        return np.vstack([new - old for new, old in zip(outputs, self.base, strict=True)])

    def _blocks(self) -> Floats:
        """Number [n] of the window that each thinned sample lies in, over all runs."""
        numbers, first = [], 0
        for recording in self.recordings:
            window = self.machine.window(recording.run)
            number = np.arange(len(recording.inputs))[:: self.stride] // window
            numbers.append(first + number)
            first += int(number[-1]) + 1
        return np.concatenate(numbers)

    def _moved(self, step: float) -> list[Floats]:
        """Changes [n, outputs] of all runs by a relative step of each free parameter."""
        changes = []
        for name in self.machine.free(self.variation):
            moved = {**self.values, name: self.values[name] * (1.0 + step)}
            changes.append(self._difference(self._outputs(moved)))
        return changes

    def _regular(self, blocks: Floats, forward: list[Floats]) -> NDArray[np.bool_]:
        """Samples [n] of the windows whose motion changes smoothly with the parameters.

        A joint that a torque holds at the edge of sliding amplifies any change: such windows say
        nothing of an effect, and are left out.
        """
        kept = np.ones(len(blocks), dtype=bool)
        if self.machine.voltage_driven:
            return kept
        for ahead, back in zip(forward, self._moved(-RELATIVE_STEP), strict=True):
            for block in np.unique(blocks):
                inside = blocks == block
                bend, size = rms(ahead[inside] + back[inside]), rms(ahead[inside] - back[inside])
                if bend > IRREGULAR * size + NEGLIGIBLE_FLOORS:
                    kept[inside] = False
        return kept

    def _basis(self) -> Floats:
        """Orthonormal basis [n outputs, rank] of what parameters and starts reproduce."""
        blocks, moved = self._blocks(), self._moved(RELATIVE_STEP)
        self.regular = self._regular(blocks, moved)
        if np.mean(self.regular) < LEAST_REGULAR:
            raise AbsorbedError(f"{np.mean(self.regular):.0%} of the motion is regular")
        for shift in range(self.machine.shifts()):
            change = self._difference(self._outputs(self.values, shift))
            moved += [change * (blocks == block)[:, None] for block in np.unique(blocks)]
        columns = [change[self.regular].ravel() for change in moved]
        matrix = np.array([column for column in columns if np.any(column)]).T
        matrix /= np.linalg.norm(matrix, axis=0)
        left, singular, _ = np.linalg.svd(matrix, full_matrices=False)
        return left[:, singular > RANK_TOLERANCE * singular[0]]

    def visible(self, change: Floats) -> Floats:
        """The part [n, outputs] of a change that neither parameters nor starts reproduce."""
        change = change[self.regular]
        flat = change.ravel()
        return (flat - self.basis @ (self.basis.T @ flat)).reshape(change.shape)

    def change(self, hidden: Values) -> tuple[Floats, float]:
        """Visible change [n, outputs] in floors by hidden parameters, and their torque's share.

        A servo's runs are made anew with the effect in them, as its commands answer the effect.
        """
        values, made, differences = {**self.values, **hidden}, [], []
        for recording, base in zip(self.recordings, self.base, strict=True):
            if recording.run.servo is None:
                states = self.machine.replay(values, recording)
                made.append(recording._replace(states=states))
                differences.append(self._read(values, states) - base)
            else:
                made.append(self.machine.record(values, recording.run))
                differences.append(self._against(made[-1], values))
        shares = []
        for number, axis in enumerate(self.machine.axes):
            torques = [self._added_torque(hidden, recording)[:, number] for recording in made]
            coulomb = self.values.get(f"F_c_{axis}", 0.0) or self.machine.coulomb(axis)
            shares.append(rms(np.concatenate(torques)) / coulomb)
        return self.visible(np.vstack(differences)), max(shares)

    def _against(self, recording: Recording, values: Values) -> Floats:
        """Readings [n, outputs] of a recording less those without what `values` hide, in floors."""
        without = self.machine.replay(self.values, recording)
        return self._read(values, recording.states) - self._read(self.values, without)

    def _added_torque(self, hidden: Values, recording: Recording) -> Floats:
        """Torque [n, joints] in N m that hidden parameters add along a recording."""
        with_it = self.machine.torque({**self.values, **hidden}, recording, recording.states)
        return with_it - self.machine.torque(self.values, recording, recording.states)

    def seen(self, hidden: Values, torque: bool) -> Seen:
        """Response and torque share of hidden parameters."""
        change, share = self.change(hidden)
        return Seen(self.largest(change), share if torque else None)

    def largest(self, change: Floats) -> float:
        """Largest rms over the outputs of a visible change [n, outputs], in floors."""
        return float((np.sqrt(np.mean(np.square(change), axis=0)) / self.widening).max())

    def against(self, recordings: Sequence[Recording], values: Values) -> float:
        """Response in floors rms of what `values` hide, along runs that were recorded with it."""
        differences = [self._against(recording, values) for recording in recordings]
        return self.largest(self.visible(np.vstack(differences)))

    def widen_by_input_noise(self, rng: np.random.Generator, share: float, most: float) -> float:
        """Rms of white noise on the inputs that leaves `share` floors in an output; `most` at most.

        From here on the floor of each output holds that noise, too.
        """
        unit = 1e-3 * float(np.mean([np.std(recording.inputs) for recording in self.recordings]))
        noisy = []
        for recording in self.recordings:
            inputs = recording.inputs + unit * rng.normal(size=recording.inputs.shape)
            states = self.machine.replay(self.values, recording, inputs)
            noisy.append(self._read(self.values, states))
        carried = np.sqrt(np.mean(np.square(self.visible(self._difference(noisy))), axis=0))
        noise = min(most, unit * share / float(carried.max()))
        self.widening = np.hypot(1.0, carried * noise / unit)
        return noise

    def threshold(self, shape: Shape | Structure) -> float:
        """Size at which the effect is just visible.

        Raises AbsorbedError where that is beyond its limit, or takes a torque that dwarfs friction.
        """
        below, above, size = 0.0, math.inf, shape.guess
        for _ in range(MOST_PROBES):
            size = min(size, shape.limit)
            seen = self.seen(shape.values(size), shape.torque)
            ratio = seen.against_threshold()
            if ratio < 1.0 and size >= shape.limit:
                raise AbsorbedError(f"{ratio:.2f} of the threshold at the limit {size:.3g}")
            if seen.share is not None and seen.share > LARGEST_SHARE and ratio < 1.0:
                raise AbsorbedError(f"a torque of {seen.share:.1f} times Coulomb at {size:.3g}")
            if abs(ratio - 1.0) < THRESHOLD_ACCURACY:
                return size
            below, above = (size, above) if ratio < 1.0 else (below, size)
            size /= min(10.0, max(0.1, ratio))
            if not below < size < above:  # the response jumps
                size = math.sqrt(below * above)
        return above if math.isfinite(above) else size


def rms(values: Floats) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(np.square(values))))
