"""The parameters of a friction map as entries of a platform file."""

from collections.abc import Mapping
from typing import Any

import tomlkit

from ptp_symbolic.numeric.friction_map.summary import LARGEST_DIFFERENCE


def platform_fragment(summary: Mapping[str, Any]) -> str:
    """TOML text with the effects and parameters of `summary` (see `friction_map`).

    A law without a rise has F_s tied to F_c. A difference by direction that is larger than its
    effect allows is written as a constant torque on the joint, where it is one of Coulomb friction.
    """
    axis, found, units = summary["axis"], summary["parameters"], summary["units"]
    entries: dict[str, Any] = {
        name: {"value": max(of["value"], 0.0), "unit": of["unit"]}
        for name, of in found.items()
        if not name.startswith("a_")
    }
    rise = f"F_s_{axis}" in entries
    if not rise:
        entries[f"F_s_{axis}"] = {"same_as": f"F_c_{axis}"}
    if rise and f"v_s_{axis}" not in entries:
        lowest = min(abs(rate) for rate in summary["points"]["rate"] if rate)
        entries[f"v_s_{axis}"] = {"value": lowest, "unit": units["rate"]}
    if f"F_v_{axis}" not in entries:
        entries[f"F_v_{axis}"] = {"value": 0.0, "unit": units["viscous"]}
    effects = [{"effect": "csvs_friction", "axis": axis}]
    differences = {n: of["value"] for n, of in found.items() if n.startswith("a_")}
    if max(map(abs, differences.values()), default=0.0) > LARGEST_DIFFERENCE:
        torque = differences.pop(f"a_F_c_{axis}", 0.0) * found[f"F_c_{axis}"]["value"]
        effects.append({"effect": "constant_torque", "axis": axis})
        # what drives the joint against it has the other sign
        entries[f"tau0_{axis}"] = {"value": -torque, "unit": units["torque"]}
        if f"a_F_s_{axis}" in differences:
            static = found[f"F_s_{axis}"]["value"]
            differences[f"a_F_s_{axis}"] -= torque / static
    elif differences and not rise and f"a_F_c_{axis}" in differences:
        entries[f"a_F_s_{axis}"] = {"same_as": f"a_F_c_{axis}"}
    if differences:
        effects.append({"effect": "direction_dependent_friction", "axis": axis})
        entries |= {name: {"value": value} for name, value in differences.items()}
    notes = [f"# {summary['member']}", *(f"# {text}" for text in summary["remarks"])]
    tables = tomlkit.table()
    for name, entry in entries.items():
        tables[name] = tomlkit.inline_table()
        tables[name].update(entry)
    return "\n".join([*notes, tomlkit.dumps({"effects": effects, "parameters": tables})])
