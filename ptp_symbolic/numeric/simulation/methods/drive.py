"""What drives a step from outside: time, inputs that are late, and parameters."""

from ptp_symbolic.numeric.simulation.kernels.records import inlined

TIME_DIFFERENCE = 1e-5  # s; of the difference quotient by time


@inlined
def fill_drive(inputs, tangents, out):
    """Write what drives the tangents apart from themselves: parameters, and delays of inputs."""
    n, columns = tangents.fp.shape[0], tangents.columns
    width = len(out) // n
    for a in range(n):
        for c in range(len(columns)):
            out[a * width + c] = tangents.fp[a, columns[c]]
        for c in range(len(columns), width):
            out[a * width + c] = 0.0
    if inputs.held:
        return
    for c in range(len(inputs.u)):
        column = tangents.delay_column[c]
        if column >= 0:
            for a in range(n):
                out[a * width + column] -= tangents.fu[a, c] * inputs.ahead[c]
