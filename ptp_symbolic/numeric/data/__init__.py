"""Measured logs: read, checked and converted to SI units."""

from ptp_symbolic.numeric.data.formats import stored_at
from ptp_symbolic.numeric.data.log import (
    Log,
    log_files,
    read_inputs,
    read_log,
    read_logs,
    read_split_logs,
)
from ptp_symbolic.numeric.data.remarks import refuse_motionless, refuse_wrapped_angles, remarks

__all__ = [
    "Log",
    "log_files",
    "read_inputs",
    "read_log",
    "read_logs",
    "read_split_logs",
    "refuse_motionless",
    "refuse_wrapped_angles",
    "remarks",
    "stored_at",
]
