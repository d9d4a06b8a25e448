"""The inhomogeneous term of the variational equation: parameters, and inputs that are delayed."""

from ptp_symbolic.numeric.simulation.kernels.records import inlined

TIME_DIFFERENCE = 1e-5  # s; of the difference quotient by time


@inlined
def fill_drive(inputs, tangents, fu, fp, out):
    """Write the inhomogeneous term [n * ns] of the variational equation: fp of the parameters, and
    -fu du/dt of the delays, du/dt in inputs.ahead.
    """
    n, columns = fp.shape[0], tangents.columns
    width = len(out) // n
    for a in range(n):
        for c in range(len(columns)):
            out[a * width + c] = fp[a, columns[c]]
        for c in range(len(columns), width):
            out[a * width + c] = 0.0
    if inputs.held:
        return
    for c in range(len(inputs.u)):
        column = tangents.delay_column[c]
        if column >= 0:
            for a in range(n):
                out[a * width + column] -= fu[a, c] * inputs.ahead[c]
