#if RIGID
static const real FACE_WIDTH = REAL(1e-9), SAME_SPEED = REAL(1e-9); /* of a lasting contact */
#endif

/* Contact from the separation, sticking from the holding torque. */
void model_initial_modes(real t, const real *x, const real *u, const real *p, real *m)
{
    real g[GUARDS];
    for (int i = 0; i < MODES; i++)
        m[i] = REAL(0.0);
    model_guards(t, x, u, p, m, g);
#if CONTACTS > 0
    for (int c = 0; c < CONTACTS; c++) {
        const real *own = g + 3 * FRICTIONS + 4 * c;
        const real side = own[0] > REAL(0.0) ? REAL(1.0) : REAL(-1.0);
#if RIGID
        const int rule = CONTACT_RATES[c][2];
        const real within = rule == 0 ? REAL(0.0) : FACE_WIDTH;
#else
        const real within = REAL(0.0);
#endif
        if (side * own[0] > own[1] - within) {
            const real torque = side > REAL(0.0) ? own[2] : own[3];
            m[FRICTIONS + 2 * c] = side;
            m[FRICTIONS + 2 * c + 1] = side * torque > REAL(0.0) ? REAL(1.0) : REAL(0.0);
#if RIGID
            if (rule > 0) {
                const real apart = x[CONTACT_RATES[c][0]] - x[CONTACT_RATES[c][1]];
                m[FRICTIONS + 2 * c + 1] = ABS(apart) <= SAME_SPEED ? REAL(1.0) : REAL(0.0);
            }
#endif
        }
    }
#endif
#if FRICTIONS > 0
    for (int f = 0; f < FRICTIONS; f++) {
        const real rate = x[FRICTION_RATES[f]];
        m[f] = rate > REAL(0.0) ? REAL(1.0) : rate < REAL(0.0) ? REAL(-1.0) : REAL(0.0);
    }
#endif
    model_guards(t, x, u, p, m, g);
#if RIGID
    for (int c = 0; c < CONTACTS; c++) {
        real *own = m + FRICTIONS + 2 * c;
        const real *at = g + 3 * FRICTIONS + 4 * c;
        if (CONTACT_RATES[c][2] > 0 && own[1] > REAL(0.0)) {
            const real push = own[0] * (own[0] > REAL(0.0) ? at[2] : at[3]);
            own[1] = push >= REAL(0.0) ? REAL(1.0) : REAL(0.0);
        }
    }
    model_guards(t, x, u, p, m, g);
#endif
#if FRICTIONS > 0
    for (int f = 0; f < FRICTIONS; f++) {
        if (m[f] == REAL(0.0) && g[3 * f] > g[3 * f + 1])
            m[f] = REAL(1.0);
        else if (m[f] == REAL(0.0) && -g[3 * f] > g[3 * f + 2])
            m[f] = REAL(-1.0);
    }
#endif
}

