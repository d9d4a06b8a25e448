"""TDMS files of LabVIEW, read with npTDMS: every group is a part."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.files.content import NUMERIC, Column, Part, lacking, seconds

TIME = "time"  # of channels that have a sampling period and no channel of times
START, PERIOD = "wf_start_offset", "wf_increment"  # properties of a waveform, in s


def tdms_parts(path: Path) -> Sequence[Part]:
    """The groups, channels of another sampling than others of theirs as parts of their own.

    Times are the channel `time` or those of the waveforms. Raises InputError where npTDMS is not
    installed, and whatever npTDMS raises.
    """
    try:
        from nptdms import TdmsFile
    except ImportError as error:
        raise InputError(lacking(path, "TDMS", "npTDMS", "tdms")) from error
    file = TdmsFile.open(path)
    found = []
    for group in file.groups():
        alike: dict[Any, list[Any]] = {}
        for channel in group.channels():
            if channel.dtype.kind in NUMERIC + "M" and len(channel) > 1:
                properties = channel.properties
                sampling = len(channel), properties.get(PERIOD), properties.get(START)
                alike.setdefault(sampling, []).append(channel)
        found += [_part(group.name, channels) for channels in alike.values()]
    return found


def _part(group: str, channels: Sequence[Any]) -> Part:
    known = {channel.name: channel for channel in channels}
    columns = [Column(name, _unit(channel), len(channel)) for name, channel in known.items()]
    first = channels[0]
    has_clock = any(
        name.lower().split("[")[0].split("(")[0].strip() in ("time", "t") for name in known
    )
    is_waveform = float(first.properties.get(PERIOD) or 0.0) > 0.0
    if is_waveform and not has_clock:
        columns.insert(0, Column(TIME, "s", len(first)))

    def load(names: Sequence[str]) -> Iterator[NDArray[Any]]:
        for name in names:
            if name in known:
                values = np.asarray(known[name][:])
                yield seconds(values) if values.dtype.kind == "M" else values
            else:
                start = float(first.properties.get(START) or 0.0)
                yield start + float(first.properties[PERIOD]) * np.arange(len(first))

    return Part(group, columns, load)


def _unit(channel: Any) -> str | None:
    if channel.dtype.kind == "M":
        return "s"
    unit = channel.properties.get("unit_string") or channel.properties.get("NI_UnitDescription")
    return str(unit).strip() or None if unit else None
