"""Tasks with an FMU in a process of their own: JSON in, one line of JSON out."""

import contextlib
import ctypes
import json
import sys
from collections.abc import Iterator
from typing import Any

import numpy as np
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.simulation import instantiate_fmu


class Opened:
    """An FMU that is unpacked; makes instances of it."""

    def __init__(self, path: str) -> None:
        self.folder, self.described = extract(path), read_model_description(path)
        self.old = self.described.fmiVersion.startswith("2")
        self.references = {v.name: v.valueReference for v in self.described.modelVariables}
        self.messages: list[str] = []

    def instance(self, kind: str = "CoSimulation") -> Any:
        return instantiate_fmu(
            self.folder, self.described, fmi_type=kind, logger=self.log, debug_logging=True
        )

    def log(self, *given: Any) -> None:
        self.messages += [g.decode() if isinstance(g, bytes) else str(g) for g in given]

    def enter(self, own: Any) -> None:
        if self.old:
            own.setupExperiment(startTime=0.0)
            own.enterInitializationMode()
        else:
            own.enterInitializationMode(startTime=0.0)

    def begun(self, kind: str = "CoSimulation") -> Any:
        own = self.instance(kind)
        self.enter(own)
        own.exitInitializationMode()
        return own

    def put(self, own: Any, name: str, value: float) -> None:
        (own.setReal if self.old else own.setFloat64)([self.references[name]], [value])

    def read(self, own: Any, names: list[str]) -> list[float]:
        get = own.getReal if self.old else own.getFloat64
        return [float(v) for v in get([self.references[n] for n in names])]

    def states(self) -> list[str]:
        return [v.derivative.name for v in self.described.modelVariables if v.derivative]


def trajectory(
    path: str, kind: str, times: list[float], given: str, values: list[float], names: list[str]
) -> dict[str, list[float]]:
    """Variables at `times`, an input held from each to the next."""
    table = np.zeros(2 * len(times) - 1, dtype=[("time", float), (given, float)])
    table["time"], table[given] = np.repeat(times, 2)[1:], np.repeat(values, 2)[:-1]
    found = simulate_fmu(
        path,
        stop_time=times[-1],
        fmi_type=kind,
        output=names,
        input=table,
        output_interval=times[1],
        relative_tolerance=1e-8,
    )
    # After an event at an instant, as the simulator notes it: the last row there.
    rows = np.searchsorted(found["time"], np.array(times) + 1e-9) - 1
    before = np.searchsorted(found["time"], np.array(times) - 1e-9)
    rows = rows if kind == "ModelExchange" else before
    return {name: [float(v) for v in found[name][rows]] for name in names}


def sizes(path: str) -> list[float]:
    """Nominal values of the continuous states, as the FMU tells them."""
    opened = Opened(path)
    own = opened.begun("ModelExchange")
    found = (ctypes.c_double * len(opened.states()))()
    name = f"fmi{2 if opened.old else 3}GetNominalsOfContinuousStates"
    getattr(own, name)(own.component, found, len(found))
    return list(found)


def slopes(path: str) -> dict[str, list[list[float]]]:
    """All partial derivatives, as the FMU gives them and by central differences."""
    opened = Opened(path)
    own = opened.instance("ModelExchange")
    opened.enter(own)
    states = opened.states()
    at = dict(zip(states, (0.02, 0.1, 0.05, 0.2, 0.4), strict=True))
    for name, value in {**at, "u_pan": 2.0}.items():
        opened.put(own, name, value)
    parameters = [v.name for v in opened.described.modelVariables if v.causality == "parameter"]
    unknowns = [*(f"der({s})" for s in states), "theta_pan", "i_pan"]
    knowns = [*states, "u_pan", *parameters]
    derive = own.getDirectionalDerivative
    exact = np.zeros((len(unknowns), len(knowns)))
    difference = np.zeros_like(exact)
    rows = [opened.references[n] for n in unknowns]
    for j, name in enumerate(knowns):
        exact[:, j] = derive(rows, [opened.references[name]], [1.0])
        (value,) = opened.read(own, [name])
        step = 1e-6 * max(abs(value), 1e-2)
        ends = []
        for end in (value + step, value - step):
            opened.put(own, name, end)
            ends.append(np.array(opened.read(own, unknowns)))
        opened.put(own, name, value)
        difference[:, j] = (ends[0] - ends[1]) / (2.0 * step)
    return {"exact": exact.tolist(), "difference": difference.tolist()}


def indicators(path: str, angles: list[float]) -> list[list[float]]:
    """Event indicators in model exchange with the gear output at `angles`, all else at rest; no
    event is handled between.
    """
    opened = Opened(path)
    own = opened.begun("ModelExchange")
    (own.newDiscreteStates if opened.old else own.updateDiscreteStates)()
    own.enterContinuousTimeMode()
    states = opened.states()
    x, z = (ctypes.c_double * len(states))(), (ctypes.c_double * 2)()
    found = []
    for angle in angles:
        x[states.index("theta_gear_pan")] = angle
        own.setContinuousStates(x, len(states))
        own.getEventIndicators(z, 2)
        found.append(list(z))
    return found


def steps(opened: Opened, own: Any, first: int, last: int, value: float) -> list[float]:
    """States after communication steps of 10 ms."""
    given = next(v.name for v in opened.described.modelVariables if v.causality == "input")
    opened.put(own, given, value)
    for k in range(first, last):
        own.doStep(currentCommunicationPoint=0.01 * k, communicationStepSize=0.01)
    return opened.read(own, opened.states())


def saved(path: str) -> dict[str, Any]:
    """States at 1 s, again from a state that was saved at 0.5 s, and from the bytes of it."""
    opened = Opened(path)
    own = opened.begun()
    middle = steps(opened, own, 0, 50, 0.1)
    kept = own.getFMUState() if not opened.old else own.getFMUstate()
    store, load = (
        (own.serializeFMUstate, own.deSerializeFMUstate)
        if opened.old
        else (own.serializeFMUState, own.deserializeFMUState)
    )
    put = own.setFMUstate if opened.old else own.setFMUState
    data = store(kept)
    first = steps(opened, own, 50, 100, 0.1)
    put(kept)
    restored = steps(opened, own, 50, 100, 0.1)
    put(load(data))
    from_bytes = steps(opened, own, 50, 100, 0.1)
    moved = max(abs(a - b) for a, b in zip(first, middle, strict=True))
    return {"first": first, "restored": restored, "from_bytes": from_bytes, "moved": moved}


def two(path: str) -> dict[str, list[float]]:
    """An instance alone, and beside another one with other inputs, step by step in turn."""
    opened = Opened(path)
    alone = steps(opened, opened.begun(), 0, 50, 3.0)
    one, other = opened.begun(), opened.begun()
    beside: list[float] = []
    away: list[float] = []
    for k in range(50):
        beside = steps(opened, one, k, k + 1, 3.0)
        away = steps(opened, other, k, k + 1, -2.0)
    return {"alone": alone, "beside": beside, "other": away}


def impossible(path: str, parameter: str, value: float) -> dict[str, Any]:
    """Status and message of a run with a parameter; the process goes on."""
    from fmpy.fmi1 import FMICallException

    opened = Opened(path)
    own = opened.instance()
    status = 0
    try:
        opened.enter(own)
        opened.put(own, parameter, value)
        own.exitInitializationMode()
    except FMICallException as error:
        status = int(error.status)
    with contextlib.suppress(FMICallException):
        own.doStep(currentCommunicationPoint=0.0, communicationStepSize=0.01)
    own.freeInstance()
    return {"status": status, "message": " ".join(opened.messages)}


def by_ecos(path: str, volts: float, seconds: float) -> float:
    """Angle in rad after co-simulation by Ecos, which is C++."""
    with contextlib.suppress(OSError):  # Ecos needs what `pip install tbb` brings
        ctypes.CDLL(f"{sys.prefix}/lib/libtbb.so.12", mode=ctypes.RTLD_GLOBAL)
    from ecospy import EcosSimulation, EcosSimulationStructure

    structure = EcosSimulationStructure()
    structure.add_model("own", path)
    structure.add_parameter_set("start", {"own::u_pan": volts})
    with EcosSimulation(structure=structure, step_size=0.01) as simulation:
        simulation.init(parameter_set="start")
        simulation.step(round(seconds / 0.01))
        return float(simulation.get_real("own::theta_pan"))


def by_libcosim(path: str, volts: float, seconds: float) -> float:
    """Angle in rad after co-simulation by libcosim, which reads FMUs by the C of FMI Library."""
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    execution = CosimExecution.from_step_size(step_size=int(1e7))  # ns
    own = execution.add_local_slave(CosimLocalSlave(fmu_path=path, instance_name="own"))
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    references = {v.name: v.valueReference for v in read_model_description(path).modelVariables}
    execution.real_initial_value(own, references["u_pan"], volts)
    execution.step(round(seconds / 0.01))
    (angle,) = observer.last_real_values(own, [references["theta_pan"]])
    return float(angle)


def wrong_token(path: str) -> dict[str, bool]:
    """Whether an instance with another token is refused."""
    opened = Opened(path)
    word = "guid" if opened.old else "instantiationToken"
    setattr(opened.described, word, "{another}")
    try:
        opened.instance()
    except Exception as error:
        return {"refused": "nstantiate" in str(error)}
    return {"refused": False}


@contextlib.contextmanager
def quiet() -> Iterator[None]:
    """What libraries print goes to the error stream."""
    with contextlib.redirect_stdout(sys.stderr):
        yield


if __name__ == "__main__":
    tasks = (
        trajectory,
        sizes,
        slopes,
        indicators,
        saved,
        two,
        impossible,
        by_ecos,
        by_libcosim,
        wrong_token,
    )
    task = {t.__name__: t for t in tasks}[sys.argv[1]]
    with quiet():
        result = task(**json.load(sys.stdin))
    print(json.dumps(result))
