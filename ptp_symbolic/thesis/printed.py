"""What the thesis prints and no packaged platform holds: tables, listings, reported results.

Numbers in SI units unless the name says otherwise, exactly as printed, wrong ones included.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Friction:
    """Steady friction of Eq. 4.1: torques in N m, Stribeck speed in rad/s, viscous N m s/rad."""

    F_c: float
    F_s: float
    v_s: float
    F_v: float


@dataclass(frozen=True)
class RampTest:
    """One row of Table 4.2 for one direction: inertia in kg m^2 and the friction."""

    J: float
    friction: Friction


@dataclass(frozen=True)
class Transition:
    """A cubic transition of a joint rate: start and end in s and in rad/s."""

    t0: float
    t1: float
    start: float
    end: float


DIRECTIONS = ("positive", "negative")
FRICTION_UNITS = {"F_c": "N m", "F_s": "N m", "v_s": "rad/s", "F_v": "N m s/rad"}
UNITS = {"J": "kg m^2", **FRICTION_UNITS}

# Table 4.1, PWM drive: initial and estimated values.
TABLE_4_1_START = {
    "positive": Friction(0.53, 0.6, 0.01, 14.36),
    "negative": Friction(0.65, 0.82, 0.02, 15.64),
}
TABLE_4_1 = {
    "positive": Friction(0.2267, 0.5578, 0.0159, 13.5844),
    "negative": Friction(0.2535, 0.7922, 0.0161, 14.3004),
}


def _row(J: float, F_s: float, F_c: float, v_s: float, F_v: float) -> RampTest:
    return RampTest(J, Friction(F_c, F_s, v_s, F_v))


# Table 4.2, DC drive: tests 1 to 5 and the printed averages, columns J, Fs, Fc, vs, Fv.
TABLE_4_2 = {
    "positive": (
        _row(0.0503, 7.203, 5.936, 0.0427, 5.304),
        _row(0.0504, 7.511, 5.699, 0.0363, 6.523),
        _row(0.05, 8.1, 6.029, 0.0492, 5.483),
        _row(0.05, 7.81, 5.89, 0.0457, 5.5),
        _row(0.0506, 6.6, 5.549, 0.0138, 5.374),
    ),
    "negative": (
        _row(0.0495, 6.504, 5.354, 0.0972, 7.601),
        _row(0.0497, 8.0, 5.001, 0.0926, 6.95),
        _row(0.0498, 7.702, 4.991, 0.1096, 5.835),
        _row(0.0499, 7.298, 5.372, 0.1109, 6.446),
        _row(0.0501, 7.771, 5.791, 0.066, 5.334),
    ),
}
TABLE_4_2_AVERAGE = {
    "positive": _row(0.0502, 7.656, 5.888, 0.0434, 5.7),
    "negative": _row(0.0498, 7.72, 5.435, 0.0844, 6.101),
}
INERTIA = 0.050

# Appendix A: readings of the backlash gap in deg, and the printed average.
BACKLASH_DEG = (
    1.45,
    1.5,
    1.6,
    1.6,
    1.5,
    1.45,
    1.45,
    1.35,
    1.4,
    1.4,
    1.45,
    1.35,
    1.5,
    1.6,
    1.55,
    1.65,
    1.45,
    1.55,
    1.55,
    1.45,
)
BACKLASH_AVERAGE_DEG = 1.49

# Appendix B: lsqcurvefit bounds in the order Tc, Ts, Ws, gamma, Tv.
APPENDIX_B_BOUNDS = {
    "positive": ((0.1, 0.4, 1e-4, 1.999, 10.0), (0.7, 0.9, 1.0, 2.001, 40.0)),
    "negative": ((0.1, 0.4, 1e-5, 1.999, 10.0), (0.6, 0.9, 1.0, 2.001, 40.0)),
}
GAMMA = 2.0

# Appendix C: start of Tc, Ts, Ws, Tv; bounds of J, Tc, Ts, Ws, Tv; the current ramp in A/s.
APPENDIX_C_START = Friction(5.0, 6.15, 0.1, 14.0)
APPENDIX_C_LOWER = (0.049, 3.0, 4.0, 0.001, 4.0)
APPENDIX_C_UPPER = (0.051, 10.0, 10.0, 1.0, 12.0)
APPENDIX_C_MOTOR_INERTIA = 2.75
CURRENT_RAMP = 0.0145
STICKING_SPEED = 0.005

# The lines of the listings that the errata are about.
LISTING_B_FIT = """
x0 = [Tc(a) Ts(b) Ws(c) gamma(d) Tv(e)];
options = optimset('GradObj','on','MaxIter',2000,'TolX',1e-12,'MaxFunEvals',1000);
counter=counter+1;
"""
LISTING_B_FILTER = """
for j = 1:counter
for i = 1:4
if sign(Parameters_GlobalMin(i,1)) == -1 || abs(Parameters_GlobalMin(i,1)) == 0
"""
LISTING_C = """
Tc = [5]; Ts = [6.15]; Ws = [0.1]; Tv = [14];
for i = 1:length(J) for j = 1:length(Tc) for k = 1:length(Ts) for l = 1:length(Ws)
x0 = [J(i) Tc(j) Ts(k) Ws(l) Tv(m)];
ResidualVal_array(:,counter)=ResidualVal;
counter=counter+1;
[t,y,ydot]=ode23tb(@system_equation_F_csvs,xdata,y0,options,x);
"""
SOLVER_IN_TEXT = "ode15s"

# Tables 5.2 and 5.4, and the results that section 5.2 reports.
IDEAL_MOTION = {"tilt": Transition(0.0, 0.5, 0.0, 10.0), "pan": Transition(2.0, 2.5, 0.0, 10.0)}
PAYLOAD_MOTION = {"tilt": Transition(0.0, 0.5, 0.0, 0.5), "pan": Transition(2.0, 2.5, 0.0, 1.0)}
PAYLOAD_OFFSET = 0.01
IDEAL_VARIATION = 0.01
PAYLOAD_PAN_VARIATION = 0.025
PAYLOAD_TILT_VARIATION = 5.0

# Section 5.4: relative L2 position errors against measured series that are not printed.
# (input, end of the comparison in s, printed error)
REPORTED_ERRORS = (
    ("step", 4.37, 0.0377),
    ("step", 12.5, 0.0378),
    ("fast_ramp", 0.51, 0.0433),
    ("fast_ramp", 0.88, 0.0365),
    ("slow_ramp", 5.12, 0.2627),
    ("slow_ramp", 10.57, 0.1065),
    ("trapezoid", 2.63, 0.0305),
    ("trapezoid", 4.28, 0.035),
)
SUPPLY_VOLTAGE = 24.0
COUNTS_PER_REVOLUTION = 7200
