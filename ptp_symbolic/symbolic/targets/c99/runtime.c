/* Modes, impacts, samplers and steps of fixed length: the same in every model.

A step keeps its modes when they still hold at its end: then it is the two-stage Rosenbrock method
of Verwer et al. (SIAM J. Sci. Comput. 20, 1999), L-stable, of order 2. Otherwise it is repeated as
a linearly implicit Euler step whose modes are unknowns of a complementarity problem (principal
pivoting: Murty, Opsearch 11, 1974). Rigid faces that have closed by the end of a step strike there
(Moreau, 1988). The work of a step is bounded and nothing is allocated. */

enum { MOST_SWEEPS = 30, MOST_ROUNDS = 20 };

static const real GAMMA = REAL(0.29289321881345254); /* 1 - sqrt(1/2) */
static const real LARGEST_STATE = REAL(1e12);
static const real SMALLEST_STATE = SMALLEST;         /* smaller states are set to zero */
#if EVENTS
#if FRICTIONS > 0
static const real REVERSAL_DEAD_BAND = REAL(1e-13);  /* rad/s, or m/s */
#endif
static const real PUSH_DEAD_BAND = REAL(1e-12);      /* N m, or N */
#endif
#if RIGID
static const real APPROACH_DEAD_BAND = REAL(1e-12);  /* rad/s */
static const real RESTING_SPEED = REAL(1e-5);        /* rad/s; slower faces stay together */
#endif
#if SAMPLERS > 0
static const double COINCIDENT = 1e-12;              /* s; instants that are closer are one */
#endif

static int is_coupled(const real *a, int row)
{
    for (int j = 0; j < STATES; j++)
        if (j != row && a[row * STATES + j] != REAL(0.0))
            return 1;
    return 0;
}

/* LU factors in place with partial pivoting. */
static void factor(real *a, int *order)
{
    for (int k = 0; k < STATES; k++) {
        int pivot = k;
        if (is_coupled(a, k))
            for (int i = k + 1; i < STATES; i++)
                if (ABS(a[i * STATES + k]) > ABS(a[pivot * STATES + k]))
                    pivot = i;
        order[k] = pivot;
        if (pivot != k)
            for (int j = 0; j < STATES; j++) {
                const real kept = a[k * STATES + j];
                a[k * STATES + j] = a[pivot * STATES + j];
                a[pivot * STATES + j] = kept;
            }
        const real inverse = REAL(1.0) / a[k * STATES + k];
        for (int i = k + 1; i < STATES; i++)
            if (a[i * STATES + k] != REAL(0.0)) {
                a[i * STATES + k] *= inverse;
                for (int j = k + 1; j < STATES; j++)
                    a[i * STATES + j] -= a[i * STATES + k] * a[k * STATES + j];
            }
    }
}

static void solve(const real *a, const int *order, real *b)
{
    for (int k = 0; k < STATES; k++) {
        const real kept = b[k];
        b[k] = b[order[k]];
        b[order[k]] = kept;
    }
    for (int i = 1; i < STATES; i++)
        for (int j = 0; j < i; j++)
            b[i] -= a[i * STATES + j] * b[j];
    for (int i = STATES - 1; i >= 0; i--) {
        for (int j = i + 1; j < STATES; j++)
            b[i] -= a[i * STATES + j] * b[j];
        b[i] /= a[i * STATES + i];
    }
}

/* Time derivative of the state; a gear output pressed onto a sticking joint stays at rest. */
static void rates_of(model_machine *s, real t, const real *x, const real *u, const real *p,
                     real *dx)
{
    model_prepared_derivative(t, x, u, p, s->modes, s->prepared, dx);
#if RIGID
    for (int c = 0; c < CONTACTS; c++)
        if (s->pressed[c])
            dx[CONTACT_RATES[c][0]] = REAL(0.0);
#endif
}

/* Factors of I - reach * Jacobian; rows of sticking rates are those of the identity. */
static void factor_step(model_machine *s, real reach, real t, const real *x, const real *u,
                        const real *p)
{
    real *a = s->matrix;
    model_state_jacobian(t, x, u, p, s->modes, s->by_state);
#if RIGID
    for (int c = 0; c < CONTACTS; c++)
        if (s->pressed[c])
            for (int j = 0; j < STATES; j++)
                s->by_state[CONTACT_RATES[c][0] * STATES + j] = REAL(0.0);
#endif
    for (int i = 0; i < STATES; i++) {
        for (int j = 0; j < STATES; j++)
            a[i * STATES + j] = -reach * s->by_state[i * STATES + j];
        a[i * STATES + i] += REAL(1.0);
    }
#if FRICTIONS > 0
    for (int f = 0; f < FRICTIONS; f++)
        if (s->modes[f] == REAL(0.0)) {
            const int rate = FRICTION_RATES[f];
            for (int j = 0; j < STATES; j++)
                a[rate * STATES + j] = REAL(0.0);
            a[rate * STATES + rate] = REAL(1.0);
        }
#endif
    factor(a, s->order);
}

static void rest(model_machine *s, real *k)
{
#if FRICTIONS > 0
    for (int f = 0; f < FRICTIONS; f++)
        if (s->modes[f] == REAL(0.0))
            k[FRICTION_RATES[f]] = REAL(0.0);
#else
    (void)s;
    (void)k;
#endif
}

static void fixed_mode_step(model_machine *s, real t, real h, const real *x, const real *u,
                            const real *u_end, const real *p)
{
    real *k1 = s->k1, *k2 = s->k2, *end = s->end;
    factor_step(s, GAMMA * h, t, x, u, p);
    rates_of(s, t, x, u, p, k1);
    rest(s, k1);
    solve(s->matrix, s->order, k1);
    for (int i = 0; i < STATES; i++)
        end[i] = x[i] + h * k1[i];
    rates_of(s, t + h, end, u_end, p, k2);
    for (int i = 0; i < STATES; i++)
        k2[i] -= REAL(2.0) * k1[i];
    rest(s, k2);
    solve(s->matrix, s->order, k2);
    for (int i = 0; i < STATES; i++)
        end[i] = x[i] + h * (REAL(1.5) * k1[i] + REAL(0.5) * k2[i]);
}

#if MODES > 0
#if !RIGID
static void allow_all(model_machine *s)
{
    for (int f = 0; f < 2 * FRICTIONS; f++)
        s->refused[f] = 0;
}

#if FRICTIONS > 0
/* Stop sliding against its direction; start it where the holding torque exceeds breakaway. */
static int correct_friction(model_machine *s, int f, real rate)
{
    real *m = s->modes;
    const real *g = s->guards + 3 * f;
    if (m[f] != REAL(0.0)) {
        if (m[f] * rate >= REAL(0.0))
            return 0;
        s->refused[2 * f + (m[f] > REAL(0.0) ? 0 : 1)] = 1;
        m[f] = REAL(0.0);
        return 1;
    }
    if (g[0] > g[1] && !s->refused[2 * f])
        m[f] = REAL(1.0);
    else if (-g[0] > g[2] && !s->refused[2 * f + 1])
        m[f] = REAL(-1.0);
    return m[f] != REAL(0.0);
}
#endif

#if CONTACTS > 0
/* Let a face push only from beyond the gap and never pull. */
static int correct_contact(model_machine *s, int c)
{
    const real *g = s->guards + 3 * FRICTIONS + 4 * c;
    real *m = s->modes + FRICTIONS + 2 * c;
    const real active = m[1];
    real side = m[0];
    if (active == REAL(0.0))
        side = g[0] > REAL(0.0) ? REAL(1.0) : REAL(-1.0);
    const real push = side * (side > REAL(0.0) ? g[2] : g[3]);
    if (active > REAL(0.0) && push >= REAL(0.0))
        return 0;
    const int beyond = side * g[0] > g[1];
    m[0] = beyond ? side : REAL(0.0);
    m[1] = beyond && push > REAL(0.0) ? REAL(1.0) : REAL(0.0);
    return m[1] != active;
}
#endif

/* Change the first mode that does not fit x and the guards; 0 when all of them fit. */
static int correct_a_mode(model_machine *s, const real *x)
{
#if FRICTIONS > 0
    for (int f = 0; f < FRICTIONS; f++)
        if (correct_friction(s, f, x[FRICTION_RATES[f]])) {
            for (int other = 0; other < FRICTIONS; other++)
                if (other != f)
                    s->refused[2 * other] = s->refused[2 * other + 1] = 0;
            return 1;
        }
#else
    (void)x;
#endif
#if CONTACTS > 0
    for (int c = 0; c < CONTACTS; c++)
        if (correct_contact(s, c)) {
            allow_all(s);
            return 1;
        }
#endif
    return 0;
}

/* An implicit step that finds its modes; the number of mode sets tried, 0 where none fits. */
static int mode_finding_step(model_machine *s, real t, real h, const real *x, const real *u,
                             const real *p)
{
    real *k = s->k1, *end = s->end;
    for (int i = 0; i < MODES; i++)
        s->modes_before[i] = s->modes[i];
    allow_all(s);
    for (int sweep = 1; sweep <= MOST_SWEEPS; sweep++) {
        factor_step(s, h, t + h, x, u, p);
        rates_of(s, t + h, x, u, p, k);
        for (int i = 0; i < STATES; i++)
            k[i] *= h;
#if FRICTIONS > 0
        for (int f = 0; f < FRICTIONS; f++)
            if (s->modes[f] == REAL(0.0))
                k[FRICTION_RATES[f]] = -x[FRICTION_RATES[f]];
#endif
        solve(s->matrix, s->order, k);
        for (int i = 0; i < STATES; i++) {
            end[i] = x[i] + k[i];
#if FRICTIONS > 0
            const int f = ZERO_AT_REST[i];
            if (f >= 0 && s->modes[f] == REAL(0.0) && s->modes_before[f] != REAL(0.0))
                end[i] = REAL(0.0);
#endif
        }
        model_guards(t + h, end, u, p, s->modes, s->guards);
        if (!correct_a_mode(s, end))
            return sweep;
    }
    return 0;
}
#endif

#if EVENTS
/* How far the mode of an element has ended: not above zero while it lasts. */
static real violation(const model_machine *s, int element, const real *x)
{
    const real *m = s->modes, *g;
    if (element < FRICTIONS) {
#if FRICTIONS > 0
        g = s->guards + 3 * element;
        if (m[element] != REAL(0.0))
            return -m[element] * x[FRICTION_RATES[element]] - REVERSAL_DEAD_BAND;
        return MAX(g[0] - g[1], -g[0] - g[2]);
#endif
    }
    (void)x;
    g = s->guards + 3 * FRICTIONS + 4 * (element - FRICTIONS);
    m += FRICTIONS + 2 * (element - FRICTIONS);
    if (m[0] == REAL(0.0))
        return MAX(g[0] - g[1], -g[0] - g[1]);
    const real push = m[0] * (m[0] > REAL(0.0) ? g[2] : g[3]);
    if (m[1] > REAL(0.0))
        return -push - PUSH_DEAD_BAND;
    return MAX(push - PUSH_DEAD_BAND, g[1] - m[0] * g[0]);
}

static real largest_violation(const model_machine *s, const real *x)
{
    real worst = -LARGEST_STATE;
    for (int e = 0; e < FRICTIONS + CONTACTS; e++) {
        const real own = violation(s, e, x);
        worst = MAX(worst, own);
    }
    return worst;
}

#if RIGID
/* Acceleration of a gear towards its face, alone (active 0) or with the joint (1). */
static real towards_face(model_machine *s, int c, real active, real t, const real *x,
                         const real *u, const real *p)
{
    real *m = s->modes, kept[MODES];
    for (int i = 0; i < MODES; i++)
        kept[i] = m[i];
    const real side = m[FRICTIONS + 2 * c];
    m[FRICTIONS + 2 * c + 1] = active;
    for (int f = 0; f < FRICTIONS; f++)
        if (FRICTION_RATES[f] == CONTACT_RATES[c][0] || FRICTION_RATES[f] == CONTACT_RATES[c][1])
            m[f] = side;
    model_prepared_derivative(t, x, u, p, m, s->prepared, s->k2);
    for (int i = 0; i < MODES; i++)
        m[i] = kept[i];
    return side * s->k2[CONTACT_RATES[c][0]];
}
#endif

static void fill_guards(model_machine *s, real t, const real *x, const real *u, const real *p)
{
    model_guards(t, x, u, p, s->modes, s->guards);
#if RIGID
    for (int c = 0; c < CONTACTS; c++)
        if (s->pressed[c]) {
            real *g = s->guards + 3 * FRICTIONS + 4 * c;
            const real side = s->modes[FRICTIONS + 2 * c];
            g[0] = side * towards_face(s, c, REAL(0.0), t, x, u, p);
            g[1] = REAL(0.0);
            g[2] = side * towards_face(s, c, REAL(1.0), t, x, u, p);
            g[3] = g[2];
        }
#endif
}

/* Move every violated contact to its next mode. */
static void switch_contacts(model_machine *s)
{
    for (int c = 0; c < CONTACTS; c++) {
        const real *g = s->guards + 3 * FRICTIONS + 4 * c;
        real *m = s->modes + FRICTIONS + 2 * c;
        if (m[0] == REAL(0.0)) {
            if (ABS(g[0]) > g[1]) {
                m[0] = g[0] > REAL(0.0) ? REAL(1.0) : REAL(-1.0);
                m[1] = m[0] * (m[0] > REAL(0.0) ? g[2] : g[3]) > REAL(0.0) ? REAL(1.0) : REAL(0.0);
            }
            continue;
        }
        const real push = m[0] * (m[0] > REAL(0.0) ? g[2] : g[3]);
        const int apart = g[1] - m[0] * g[0] > REAL(0.0);
#if RIGID
        if (s->pressed[c]) {
            if (push > REAL(0.0) || apart) {
                s->pressed[c] = 0;
                m[1] = push > REAL(0.0) ? REAL(1.0) : REAL(0.0);
            }
            continue;
        }
#endif
        if (m[1] > REAL(0.0)) {
            if (push < REAL(0.0))
                m[1] = REAL(0.0);
        } else if (apart) {
            m[0] = REAL(0.0);
        } else if (push > REAL(0.0)) {
            m[1] = REAL(1.0);
        }
    }
}

#if RIGID
/* One impact by Newton's law of restitution. */
static void strike(model_machine *s, int c, real t, real *x, const real *u, const real *p)
{
    real *m = s->modes, *change = s->strike + c * (STATES + 2);
    m[FRICTIONS + 2 * c + 1] = REAL(0.0);
    model_impacts(t, x, u, p, m, s->strike);
    const real speed = ABS(x[CONTACT_RATES[c][0]] - x[CONTACT_RATES[c][1]]);
    const int bounces = !s->settling[c] && change[STATES] * speed > RESTING_SPEED;
    const real restitution = bounces ? change[STATES] : REAL(0.0);
    for (int a = 0; a < STATES; a++)
        x[a] += (REAL(1.0) + restitution) * change[a];
    for (int f = 0; f < FRICTIONS; f++) {
        const int rate = FRICTION_RATES[f];
        if (change[rate] != REAL(0.0))
            m[f] = x[rate] > REAL(0.0) ? REAL(1.0) : x[rate] < REAL(0.0) ? REAL(-1.0) : REAL(0.0);
    }
    m[FRICTIONS + 2 * c + 1] = restitution == REAL(0.0) ? REAL(1.0) : REAL(0.0);
}

static void strike_faces(model_machine *s, real t, real *x, const real *u, const real *p)
{
    for (int c = 0; c < CONTACTS; c++) {
        const real *m = s->modes + FRICTIONS + 2 * c;
        const int gear = CONTACT_RATES[c][0], joint = CONTACT_RATES[c][1], rule = CONTACT_RATES[c][2];
        if (rule == 0)
            continue;
        if (m[1] == REAL(0.0)) {
            if (rule == 2)
                x[joint] = REAL(0.0);
        } else if (m[0] * (x[gear] - x[joint]) > APPROACH_DEAD_BAND) {
            strike(s, c, t, x, u, p);
        }
    }
}

/* Bring to rest every gear output pushed onto a joint that sticks. */
static void press(model_machine *s, real t, real *x, const real *u, const real *p)
{
    for (int c = 0; c < CONTACTS; c++) {
        real *m = s->modes;
        const int gear = CONTACT_RATES[c][0], joint = CONTACT_RATES[c][1];
        const int touching = m[FRICTIONS + 2 * c] != REAL(0.0)
            && m[FRICTIONS + 2 * c + 1] == REAL(0.0) && ABS(x[gear]) <= RESTING_SPEED;
        if (CONTACT_RATES[c][2] != 2 || s->pressed[c] || !touching)
            continue;
        if (towards_face(s, c, REAL(0.0), t, x, u, p) <= REAL(0.0)
            || towards_face(s, c, REAL(1.0), t, x, u, p) > REAL(0.0))
            continue;
        s->pressed[c] = 1;
        x[gear] = REAL(0.0);
        for (int f = 0; f < FRICTIONS; f++)
            if (FRICTION_RATES[f] == gear || FRICTION_RATES[f] == joint) {
                m[f] = REAL(0.0);
                for (int a = 0; a < STATES; a++)
                    if (ZERO_AT_REST[a] == f)
                        x[a] = REAL(0.0);
            }
    }
}

#endif

/* Find consistent modes and rates at one instant; 0 on chattering. */
static int settle(model_machine *s, real t, real *x, const real *u, const real *p)
{
    real *m = s->modes;
    for (int round = 0; round < MOST_ROUNDS; round++) {
        for (int f = 0; f < FRICTIONS; f++)
            if (m[f] != REAL(0.0) && violation(s, f, x) > REAL(0.0)) {
                const int rate = FRICTION_RATES[f];
                x[rate] = REAL(0.0);
                m[f] = REAL(0.0);
#if RIGID
                for (int c = 0; c < CONTACTS; c++) {
                    const int gear = CONTACT_RATES[c][0], joint = CONTACT_RATES[c][1];
                    const int joined = m[FRICTIONS + 2 * c + 1] > REAL(0.0);
                    if (CONTACT_RATES[c][2] != 0 && joined && (rate == gear || rate == joint))
                        x[gear] = x[joint] = REAL(0.0);
                }
#endif
                for (int a = 0; a < STATES; a++)
                    if (ZERO_AT_REST[a] == f)
                        x[a] = REAL(0.0);
            }
        fill_guards(s, t, x, u, p);
        switch_contacts(s);
#if RIGID
        strike_faces(s, t, x, u, p);
        press(s, t, x, u, p);
#endif
        fill_guards(s, t, x, u, p);
        for (int f = 0; f < FRICTIONS; f++)
            if (m[f] == REAL(0.0)) {
                if (s->guards[3 * f] > s->guards[3 * f + 1])
                    m[f] = REAL(1.0);
                else if (-s->guards[3 * f] > s->guards[3 * f + 2])
                    m[f] = REAL(-1.0);
            }
        fill_guards(s, t, x, u, p);
        if (largest_violation(s, x) <= REAL(0.0))
            return 1;
    }
    return 0;
}

#if RIGID
/* Impacts of faces that have closed; faces that approach before the gap has opened meet without
   restitution. */
static int land(model_machine *s, real t, real *x, const real *u, const real *p)
{
    fill_guards(s, t, x, u, p);
    if (largest_violation(s, x) <= REAL(0.0))
        return 1;
    for (int c = 0; c < CONTACTS; c++)
        s->settling[c] = s->modes[FRICTIONS + 2 * c] != REAL(0.0);
    return settle(s, t, x, u, p);
}
#endif
#endif
#endif

#if SAMPLERS > 0
/* Plan the first instant of every sampler; a status. */
static int plan_samples(model_machine *s, real t, const real *x, const real *u, const real *p)
{
    model_sample(t, x, u, p, s->modes, s->sampled);
    for (int i = 0; i < SAMPLERS; i++) {
        const double period = (double)s->sampled[3 * i], offset = (double)s->sampled[3 * i + 1];
        if (!(period > 0.0))
            return MODEL_NO_PERIOD;
        s->count[i] = fmax(0.0, ceil(((double)t - offset - COINCIDENT) / period));
        s->due[i] = offset + s->count[i] * period;
        s->armed[i] = 0;
    }
    return MODEL_DONE;
}
#endif

int model_begin(model_machine *s, real t, real *x, const real *u, const real *p)
{
    model_prepare(p, s->prepared);
    for (int i = 0; i < STATES * STATES; i++)
        s->by_state[i] = REAL(0.0);
#if SAMPLERS > 0
    if (plan_samples(s, t, x, u, p) != MODEL_DONE)
        return MODEL_NO_PERIOD;
#endif
#if RIGID
    for (int c = 0; c < CONTACTS; c++)
        s->pressed[c] = s->settling[c] = 0;
    model_initial_modes(t, x, u, p, s->modes);
    return land(s, t, x, u, p) ? MODEL_DONE : MODEL_UNDECIDED;
#elif MODES > 0
    for (int i = 0; i < MODES; i++)
        s->modes[i] = REAL(0.0);
#if FRICTIONS > 0
    for (int f = 0; f < FRICTIONS; f++) {
        const real rate = x[FRICTION_RATES[f]];
        s->modes[f] = rate > REAL(0.0) ? REAL(1.0) : rate < REAL(0.0) ? REAL(-1.0) : REAL(0.0);
    }
#endif
    allow_all(s);
    for (int sweep = 0; sweep < MOST_SWEEPS; sweep++) {
        model_guards(t, x, u, p, s->modes, s->guards);
        if (!correct_a_mode(s, x))
            return MODEL_DONE;
    }
    return MODEL_UNDECIDED;
#else
    (void)t;
    (void)x;
    (void)u;
    return MODEL_DONE;
#endif
}

int model_step(model_machine *s, real t, real h, real *x, const real *u, const real *u_end,
               const real *p)
{
    real *end = s->end;
    fixed_mode_step(s, t, h, x, u, u_end, p);
#if MODES > 0 && !RIGID
    model_guards(t + h, end, u_end, p, s->modes, s->guards);
    for (int i = 0; i < MODES; i++)
        s->modes_before[i] = s->modes[i];
    allow_all(s);
    if (correct_a_mode(s, end)) {
        for (int i = 0; i < MODES; i++)
            s->modes[i] = s->modes_before[i];
        if (!mode_finding_step(s, t, h, x, u_end, p))
            return MODEL_UNDECIDED;
    }
#endif
    for (int i = 0; i < STATES; i++)
        if (!(ABS(end[i]) < LARGEST_STATE))
            return MODEL_DIVERGED;
#if LIMITS > 0
    model_domain(p, s->bounds);
    for (int k = 0; k < LIMITS; k++)
        if (end[LIMITED[k]] < s->bounds[2 * k] || end[LIMITED[k]] > s->bounds[2 * k + 1])
            return MODEL_OUTSIDE;
#endif
#if RIGID
    if (!land(s, t + h, end, u_end, p))
        return MODEL_UNDECIDED;
#endif
    for (int i = 0; i < STATES; i++)
        x[i] = ABS(end[i]) > SMALLEST_STATE ? end[i] : REAL(0.0);
    return MODEL_DONE;
}

#if SAMPLERS > 0
void model_sample_now(model_machine *s, double t, real *x, const real *u, const real *p)
{
    real *z = s->sampled;
    for (int i = 0; i < SAMPLERS; i++) {
        if (s->due[i] > t + COINCIDENT)
            continue;
        model_sample((real)t, x, u, p, s->modes, z);
        const double period = (double)z[3 * i], offset = (double)z[3 * i + 1];
        const double phase = (double)z[3 * i + 2];
        if (!s->armed[i] && phase >= 1.0) {
            s->count[i] += 1.0;
            s->due[i] = offset + s->count[i] * period;
        } else if (!s->armed[i] && phase * period > COINCIDENT) {
            s->armed[i] = 1;
            s->due[i] = offset + (s->count[i] + phase) * period;
        } else {
            for (int r = 0; r < UPDATES; r++)
                if (SAMPLED[r][0] == i)
                    x[SAMPLED[r][1]] = z[3 * SAMPLERS + r];
            s->armed[i] = 0;
            s->count[i] += 1.0;
            s->due[i] = offset + s->count[i] * period;
        }
    }
}
#endif

int model_advance(model_machine *s, double t, double t_end, double longest, real *x, const real *u,
                  const real *p)
{
    while (t < t_end) {
        double stop = t_end;
#if SAMPLERS > 0
        double earliest = t_end;
        model_sample_now(s, t, x, u, p);
        for (int i = 0; i < SAMPLERS; i++)
            earliest = fmin(earliest, s->due[i]);
        if (earliest < t_end - COINCIDENT)
            stop = earliest;
#endif
        const double steps = fmax(1.0, ceil((stop - t) / longest - 1e-9));
        const double h = (stop - t) / steps;
        for (double k = 0.0; k < steps; k += 1.0) {
            const double begin = t + k * h, end = k + 1.0 == steps ? stop : t + (k + 1.0) * h;
            const int status = model_step(s, (real)begin, (real)(end - begin), x, u, u, p);
            if (status != MODEL_DONE)
                return status;
        }
        t = stop;
    }
    return MODEL_DONE;
}
