"""All machines of the benchmark by name."""

from tests.benchmark.machine import Machine
from tests.benchmark.pan_machine import PAN_DRIVE, PAN_DRIVE_DC
from tests.benchmark.rigid_machines import DIRECT_DRIVE, TILT_SERVO, TWO_AXIS, TWO_AXIS_SERVO
from tests.benchmark.rigid_pan_machine import RIGID_PAN, RIGID_PAN_DC

MACHINES: dict[str, Machine] = {
    machine.name: machine
    for machine in (PAN_DRIVE, PAN_DRIVE_DC, TILT_SERVO, DIRECT_DRIVE, TWO_AXIS, TWO_AXIS_SERVO)
}
MACHINES |= {machine.name: machine for machine in (RIGID_PAN, RIGID_PAN_DC)}
