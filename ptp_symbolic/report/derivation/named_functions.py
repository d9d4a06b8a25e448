"""What the functions mean that the equations keep under their names: ``ratio_tilt``, for one."""

from ptp_symbolic.symbolic.documents.letters import SLOPE

MEANINGS = {  # in LaTeX
    "linkage_cos": ("twice ground link times arm times the cosine of their angle at zero", "m^2"),
    "linkage_sin": ("twice ground link times arm times the sine of their angle at zero", "m^2"),
    "length": ("length of the actuator", "m"),
    "ratio": ("turns of the motor per turn of the joint, by the lever of the linkage", "1"),
    "follower_coupling": ("inertia that couples the other joint to this one", "kg m^2"),
    "follower_inertia": ("inertia of the other joint", "kg m^2"),
    "follower_torque": ("torque on the other joint", "N m"),
    "driving_torque": ("torque of the drive at the joint, friction aside", "N m"),
    "load_torque": ("torque of the rest of the machine on the joint", "N m"),
    "load_inertia": ("inertia of the rest of the machine at the joint", "kg m^2"),
    "raised": (
        r"$2\pi T_\mathrm{raise}/(lF)$ with thesis Eq.~3.12: power in over out, the motor driving",
        "1",
    ),
    "lowered": (
        r"$-2\pi T_\mathrm{lower}/(lF)$ with thesis Eq.~3.12: efficiency, the load driving",
        "1",
    ),
    "carried": (
        "torque that the screw would carry without friction, times the sum of the inertias",
        "kg m^2 N m",
    ),
    "lost_raising": ("share of it lost where the motor drives the load", "1/(kg m^2)"),
    "lost_lowering": ("share of it lost where the load drives the motor", "1/(kg m^2)"),
}
UNKNOWN = "a function of those above, given with the equations"


def meaning_of(name: str) -> tuple[str, str]:
    """Meaning and unit of the function `name`; of a derivative that of what it is taken from."""
    term, by, _ = name.partition(SLOPE)
    word = next((w for w in MEANINGS if term.startswith(f"{w}_")), None)
    if word is None:
        return UNKNOWN, "1"
    meaning, unit = MEANINGS[word]
    if not by:
        return meaning, unit
    return f"slope over the angle: {meaning}", "1/rad" if unit == "1" else f"{unit}/rad"
