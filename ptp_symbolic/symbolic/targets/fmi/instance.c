/* An instance of a machine behind the Functional Mock-up Interface, the same for FMI 2.0 and 3.0.

Modes change where an event function of theirs rises above zero: these are the event indicators,
which are continuous as long as the modes are kept, and beyond. Co-simulation integrates with
Rodas5P (Steinebach, BIT Numerical Mathematics 63:27, 2023), whose steps end at events and samples;
an event is located by repeating the step itself with other lengths, and inputs are held over a
communication step. Nothing is allocated but the instance, when it is made, and copies of its
state, when they are asked for. */

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ROOM(number) ((number) > 0 ? (number) : 1)
#define ELEMENTS (FRICTIONS + CONTACTS)
#define INDICATORS (ELEMENTS + LIMITS)

/* Value references: each group of variables is an array, one behind the other. */
enum {
    AT_TIME = 0,
    AT_STATES = 1,
    AT_DERIVATIVES = AT_STATES + STATES,
    AT_INPUTS = AT_DERIVATIVES + CONTINUOUS,
    AT_OUTPUTS = AT_INPUTS + INPUTS,
    AT_PARAMETERS = AT_OUTPUTS + OUTPUTS,
    AT_INDICATORS = AT_PARAMETERS + PARAMETERS,
    AT_MODES = AT_INDICATORS + INDICATORS,
    AT_END = AT_MODES + MODES
};

enum { STAGES = 8, TEXT = 400, MOST_SEARCHES = 100, MOST_INSTANT_EVENTS = 100 };

static const double METHOD_GAMMA = 0.21193756319429014;
static const double LARGEST_STEP = 0.1;     /* s */
static const double SHORTEST_STEP = 1e-11;  /* s */
static const double TIME_RESOLUTION = 1e-12; /* s */
static const double LANDING = 2e-12;        /* s; how far past an event a step may end */
/* How far past an event an indicator is zero, in its unit: an importer that finds it to be exactly
   zero, or stops a rounding error before, has reached the event, and none begins there. */
static const double PAST_EVENT = 1e-10;
static const double INSTANT_STEP = 1e-10;   /* s; events that are closer are at one instant */
static const double NODES[STAGES] = {
    0.0, 0.6358126895828704, 0.4095798393397535, 0.9769306725060716, 0.4288403609558664,
    1.0, 1.0, 1.0,
};
static const double BY_TIME[STAGES] = {
    0.21193756319429014, -0.42387512638858027, -0.3384627126235924, 1.8046452872882734,
    2.325825639765069, 0.0, 0.0, 0.0,
};
static const double EARLIER[6][5] = {
    {0.0},
    {3.0},
    {2.849394379747939, 0.45842242204463923},
    {-6.954028509809101, 2.489845061869568, -10.358996098473584},
    {2.8029986275628964, 0.5072464736228206, -0.3988312541770524, -0.04721187230404641},
    {-7.502846399306121, 2.561846144803919, -11.627539656261098, -0.18268767659942256,
     0.030198172008377946},
};
static const double COUPLING[STAGES][7] = {
    {0.0},
    {-14.155112264123755},
    {-17.97296035885952, -2.859693295451294},
    {147.12150275711716, -1.41221402718213, 71.68940251302358},
    {165.43517024871676, -0.4592823456491126, 42.90938336958603, -5.961986721573306},
    {24.854864614690072, -3.0009227002832186, 47.4931110020768, 5.5814197821558125,
     -0.6610691825249471},
    {30.91273214028599, -3.1208243349937974, 77.79954646070892, 34.28646028294783,
     -19.097331116725623, -28.087943162872662},
    {37.80277123390563, -3.2571969029072276, 112.26918849496327, 66.9347231244047,
     -40.06618937091002, -54.66780262877968, -9.48861652309627},
};
static const double DENSE[3][STAGES] = {
    {25.948786856663858, -2.5579724845846235, 10.433815404888879, -2.3679251022685204,
     0.524948541321073, 1.1241088310450404, 0.4272876194431874, -0.17202221070155493},
    {-9.91568850695171, -0.9689944594115154, 3.0438037242978453, -24.495224566215796,
     20.176138334709044, 15.98066361424651, -6.789040303419874, -6.710236069923372},
    {11.419903575922262, 2.8879645146136994, 72.92137995996029, 80.12511834622643,
     -52.072871366152654, -59.78993625266729, -0.15582684282751913, 4.883087185713722},
};

/* What an instance is at one moment: copied whole when its state is saved. */
typedef struct {
    model_machine machine;
    double t, tolerance, length; /* length: of the next step in co-simulation, s */
    double x[ROOM(STATES)], u[ROOM(INPUTS)], p[ROOM(PARAMETERS)];
    int begun; /* initialised: modes follow from events from here on */
    int stale; /* parameters, or before the beginning states and inputs, were set */
} Moment;

typedef struct {
    Moment now;
    int co_simulation, failed;
    char name[128], message[TEXT];
    double fx[ROOM(STATES * STATES)], fu[ROOM(STATES * INPUTS)], fp[ROOM(STATES * PARAMETERS)];
    double yx[ROOM(OUTPUTS * STATES)], yu[ROOM(OUTPUTS * INPUTS)], yp[ROOM(OUTPUTS * PARAMETERS)];
    double dx[ROOM(STATES)], y[ROOM(OUTPUTS)], z[ROOM(INDICATORS)], margin[ROOM(REQUIREMENTS)];
    double inverse[ROOM(STATES * STATES)], k[STAGES][ROOM(STATES)];
    double by_time[ROOM(STATES)], slope[ROOM(STATES)];
    double point[ROOM(STATES)], end[ROOM(STATES)], before[ROOM(STATES)];
    int order[ROOM(STATES)];
    void (*callback)(void); /* logger of whoever made the instance, and what it is to be given */
    void *environment;
} Instance;

/* Keep a message for the caller; always 0. */
static int fail(Instance *a, const char *form, ...)
{
    va_list given;
    va_start(given, form);
    vsnprintf(a->message, TEXT, form, given);
    va_end(given);
    for (char *c = a->message; *c; c++)
        if (*c == '%') /* messages are formats to some loggers */
            *c = ' ';
    return 0;
}

/* Whether a value reference belongs to the group that begins at `first` and ends before `next`. */
static int within(unsigned reference, unsigned first, unsigned next)
{
    return reference >= first && reference < next;
}

static void restore_start(Instance *a)
{
    Moment *now = &a->now;
    memset(now, 0, sizeof *now);
    for (int i = 0; i < STATES; i++)
        now->x[i] = model_initial_state[i];
    for (int i = 0; i < PARAMETERS; i++)
        now->p[i] = model_parameters[i];
    now->tolerance = 1e-8;
    now->length = 1e-4;
    now->stale = 1;
    a->failed = 0;
}

static Instance *make_instance(const char *name, const char *token, int co_simulation)
{
    if (token == NULL || strcmp(token, TOKEN) != 0)
        return NULL;
    Instance *a = calloc(1, sizeof *a);
    if (a == NULL)
        return NULL;
    if (name != NULL)
        strncpy(a->name, name, sizeof a->name - 1);
    a->co_simulation = co_simulation;
    restore_start(a);
    return a;
}

/* Name the parameters that break a rule, with their values. */
static int refuse_parameters(Instance *a, int rule)
{
    char said[TEXT] = "";
    for (int i = 0; RELATED[rule][i] >= 0; i++) {
        const int p = RELATED[rule][i];
        const size_t used = strlen(said);
        snprintf(said + used, sizeof said - used, "%s%s = %.9g %s", i > 0 ? ", " : "",
                 model_parameter_names[p], a->now.p[p], model_parameter_units[p]);
    }
    return fail(a, "Impossible %s: %s", said, RULES[rule]);
}

static int parameters_can_be(Instance *a)
{
    model_margins(a->now.p, a->margin);
    for (int i = 0; i < REQUIREMENTS; i++)
        if (STRICT[i] ? !(a->margin[i] > 0.0) : !(a->margin[i] >= 0.0))
            return refuse_parameters(a, i);
    return 1;
}

/* Prepare what depends on parameters, and before the beginning the modes that the state implies. */
static int refresh(Instance *a)
{
    Moment *now = &a->now;
    if (!now->stale)
        return 1;
    if (!parameters_can_be(a))
        return 0;
    model_prepare(now->p, now->machine.prepared);
#if MODES > 0
    if (!now->begun)
        model_initial_modes(now->t, now->x, now->u, now->p, now->machine.modes);
#endif
    now->stale = 0;
    return 1;
}

static double past_bound(Instance *a, int limit, const double *x)
{
#if LIMITS > 0
    const double value = x[LIMITED[limit]];
    model_domain(a->now.p, a->now.machine.bounds);
    const double *bounds = a->now.machine.bounds + 2 * limit;
    return MAX(bounds[0] - value, value - bounds[1]);
#else
    (void)a, (void)limit, (void)x;
    return 0.0;
#endif
}

/* Write the event functions at t and x into a->z (above zero: a mode, or the domain, has ended). */
static double fill_indicators(Instance *a, double t, const double *x)
{
    double worst = -LARGEST_STATE;
#if MODES > 0
    model_machine *s = &a->now.machine;
    fill_guards(s, t, x, a->now.u, a->now.p);
    for (int e = 0; e < ELEMENTS; e++) {
        a->z[e] = violation(s, e, x);
        worst = MAX(worst, a->z[e]);
    }
#else
    (void)t;
#endif
    for (int limit = 0; limit < LIMITS; limit++) {
        a->z[ELEMENTS + limit] = past_bound(a, limit, x);
        worst = MAX(worst, a->z[ELEMENTS + limit]);
    }
    return worst;
}

/* Write the event indicators into a->z: negative until a mode, or the domain, has ended. */
static void show_indicators(Instance *a)
{
    fill_indicators(a, a->now.t, a->now.x);
    for (int e = 0; e < INDICATORS; e++)
        a->z[e] -= PAST_EVENT;
}

static int is_inside(Instance *a)
{
    for (int limit = 0; limit < LIMITS; limit++)
        if (past_bound(a, limit, a->now.x) > 0.0)
            return fail(a, "At %.6g s: %s", a->now.t, DOMAIN_TEXTS[limit]);
    return 1;
}

/* Find the modes of the inputs and the state as they are; jumps act on the state. */
static int settle_modes(Instance *a)
{
    Moment *now = &a->now;
    if (!is_inside(a))
        return 0;
#if MODES > 0
    if (fill_indicators(a, now->t, now->x) > 0.0
        && !settle(&now->machine, now->t, now->x, now->u, now->p))
        return fail(a, "At %.6g s no set of modes is consistent: they chatter", now->t);
#else
    (void)now;
#endif
    return 1;
}

/* What happens at an instant: modes that have ended, samplers that are due. */
static int pass_events(Instance *a)
{
    if (!refresh(a) || !settle_modes(a))
        return 0;
#if SAMPLERS > 0
    model_sample_now(&a->now.machine, a->now.t, a->now.x, a->now.u, a->now.p);
    return settle_modes(a);
#else
    return 1;
#endif
}

static double next_sample(const Instance *a)
{
    double earliest = HUGE_VAL;
#if SAMPLERS > 0
    for (int i = 0; i < SAMPLERS; i++)
        earliest = fmin(earliest, a->now.machine.due[i]);
#else
    (void)a;
#endif
    return earliest;
}

/* Refuse rigid bodies that overlap, and a joint that moves where friction holds it in its gap. */
static int can_begin(Instance *a)
{
#if RIGID
    Moment *now = &a->now;
    model_machine *s = &now->machine;
    model_guards(now->t, now->x, now->u, now->p, s->modes, s->guards);
    for (int c = 0; c < CONTACTS; c++) {
        const double *g = s->guards + 3 * FRICTIONS + 4 * c;
        const int joint = CONTACT_RATES[c][1], rule = CONTACT_RATES[c][2];
        if (rule != 0 && fabs(g[0]) > g[1] + FACE_WIDTH)
            return fail(a, "The gear output starts %.6g ahead of the joint, beyond a rigid face at "
                        "%.6g; start it within the gap", g[0], g[1]);
        if (rule == 2 && s->modes[FRICTIONS + 2 * c + 1] == 0.0 && now->x[joint] != 0.0)
            return fail(a, "State '%s' starts at %.6g in the gap, where friction holds the joint; "
                        "start it at rest", model_state_names[joint], now->x[joint]);
    }
#else
    (void)a;
#endif
    return 1;
}

/* End the initialisation. */
static int start(Instance *a)
{
    Moment *now = &a->now;
    now->stale = 1;
    if (!refresh(a) || !is_inside(a) || !can_begin(a))
        return 0;
#if SAMPLERS > 0
    if (plan_samples(&now->machine, now->t, now->x, now->u, now->p) != MODEL_DONE)
        return fail(a, "A sampling time is not positive");
#endif
    now->begun = 1;
    return a->co_simulation ? settle_modes(a) : 1;
}

static int is_number(const double *values, int count)
{
    for (int i = 0; i < count; i++)
        if (!(fabs(values[i]) < LARGEST_STATE))
            return 0;
    return 1;
}

static int set_number(Instance *a, unsigned reference, double value)
{
    Moment *now = &a->now;
    if (within(reference, AT_PARAMETERS, AT_INDICATORS)) {
        const unsigned i = reference - AT_PARAMETERS;
        if (!(value >= LOWEST[i] && value <= HIGHEST[i]))
            return fail(a, "Parameter '%s': %.9g %s lies outside its bounds [%g, %g]",
                        model_parameter_names[i], value, model_parameter_units[i], LOWEST[i],
                        HIGHEST[i]);
        if (FIXED[i] && now->begun)
            return fail(a, "Parameter '%s' is fixed once the instance is initialised",
                        model_parameter_names[i]);
        now->p[i] = value;
        now->stale = 1;
        return 1;
    }
    if (!is_number(&value, 1))
        return fail(a, "Value reference %u: %g is not a finite number", reference, value);
    if (within(reference, AT_INPUTS, AT_OUTPUTS))
        now->u[reference - AT_INPUTS] = value;
    else if (within(reference, AT_STATES, AT_DERIVATIVES))
        now->x[reference - AT_STATES] = value;
    else
        return fail(a, "Value reference %u is no input, state or parameter", reference);
    if (!now->begun)
        now->stale = 1;
    return 1;
}

static void fill_derivatives(Instance *a)
{
    rates_of(&a->now.machine, a->now.t, a->now.x, a->now.u, a->now.p, a->dx);
}

/* Values of variables by their references. */
static int get_numbers(Instance *a, const unsigned *references, size_t count, double *values)
{
    Moment *now = &a->now;
    int have = 0;
    if (!refresh(a))
        return 0;
    for (size_t k = 0; k < count; k++) {
        const unsigned r = references[k];
        if (within(r, AT_DERIVATIVES, AT_INPUTS) && !(have & 1)) {
            fill_derivatives(a);
            have |= 1;
        } else if (within(r, AT_OUTPUTS, AT_PARAMETERS) && !(have & 2)) {
            model_outputs(now->t, now->x, now->u, now->p, a->y);
            have |= 2;
        } else if (within(r, AT_INDICATORS, AT_MODES) && !(have & 4)) {
            show_indicators(a);
            have |= 4;
        }
        if (r == AT_TIME)
            values[k] = now->t;
        else if (r < AT_DERIVATIVES)
            values[k] = now->x[r - AT_STATES];
        else if (r < AT_INPUTS)
            values[k] = a->dx[r - AT_DERIVATIVES];
        else if (r < AT_OUTPUTS)
            values[k] = now->u[r - AT_INPUTS];
        else if (r < AT_PARAMETERS)
            values[k] = a->y[r - AT_OUTPUTS];
        else if (r < AT_INDICATORS)
            values[k] = now->p[r - AT_PARAMETERS];
        else if (r < AT_MODES)
            values[k] = a->z[r - AT_INDICATORS];
        else
            return fail(a, "Value reference %u is no number of this model", r);
    }
    return 1;
}

static int get_mode(Instance *a, unsigned reference, int *value)
{
    if (!refresh(a))
        return 0;
#if MODES > 0
    if (within(reference, AT_MODES, AT_END)) {
        *value = (int)a->now.machine.modes[reference - AT_MODES];
        return 1;
    }
#else
    (void)value;
#endif
    return fail(a, "Value reference %u is no mode of this model", reference);
}

/* Write the Jacobians of dx/dt. */
static void fill_jacobian(Instance *a)
{
    Moment *now = &a->now;
    model_linearize(now->t, now->x, now->u, now->p, now->machine.modes, a->fx, a->fu, a->fp, 0, 0);
#if RIGID
    for (int c = 0; c < CONTACTS; c++)
        if (now->machine.pressed[c]) {
            const int row = CONTACT_RATES[c][0];
            memset(a->fx + row * STATES, 0, STATES * sizeof *a->fx);
            memset(a->fu + row * INPUTS, 0, INPUTS * sizeof *a->fu);
            memset(a->fp + row * PARAMETERS, 0, PARAMETERS * sizeof *a->fp);
        }
#endif
}

/* The derivative of one variable by another; 0 where there is none. */
static int partial(Instance *a, unsigned unknown, unsigned known, double *value)
{
    const double *by_x, *by_u, *by_p;
    if (within(unknown, AT_DERIVATIVES, AT_INPUTS)) {
        const unsigned row = unknown - AT_DERIVATIVES;
        by_x = a->fx + row * STATES, by_u = a->fu + row * INPUTS, by_p = a->fp + row * PARAMETERS;
    } else if (within(unknown, AT_OUTPUTS, AT_PARAMETERS)) {
        const unsigned row = unknown - AT_OUTPUTS;
        by_x = a->yx + row * STATES, by_u = a->yu + row * INPUTS, by_p = a->yp + row * PARAMETERS;
    } else if (within(unknown, AT_STATES, AT_DERIVATIVES)) {
        *value = unknown == known ? 1.0 : 0.0;
        return 1;
    } else {
        return fail(a, "Value reference %u is no derivative or output", unknown);
    }
    if (within(known, AT_STATES, AT_DERIVATIVES))
        *value = by_x[known - AT_STATES];
    else if (within(known, AT_INPUTS, AT_OUTPUTS))
        *value = by_u[known - AT_INPUTS];
    else if (within(known, AT_PARAMETERS, AT_INDICATORS))
        *value = by_p[known - AT_PARAMETERS];
    else
        return fail(a, "Value reference %u is no state, input or parameter", known);
    return 1;
}

static int directional_derivative(Instance *a, const unsigned *unknowns, size_t rows,
                                  const unsigned *knowns, size_t columns, const double *seed,
                                  double *out)
{
    Moment *now = &a->now;
    if (!refresh(a))
        return 0;
    fill_jacobian(a);
    model_output_jacobian(now->t, now->x, now->u, now->p, a->yx, a->yp);
    model_output_input_jacobian(now->t, now->x, now->u, now->p, a->yu);
    for (size_t i = 0; i < rows; i++) {
        out[i] = 0.0;
        for (size_t j = 0; j < columns; j++) {
            double slope;
            if (!partial(a, unknowns[i], knowns[j], &slope))
                return 0;
            out[i] += slope * seed[j];
        }
    }
    return 1;
}

/* Evaluate what a step begins with. */
static void begin_step(Instance *a)
{
    Moment *now = &a->now;
    fill_derivatives(a);
    memcpy(a->slope, a->dx, sizeof a->dx);
    fill_jacobian(a);
#if DEPENDS_ON_TIME
    const double apart = 1e-5; /* s */
    rates_of(&now->machine, now->t + apart, now->x, now->u, now->p, a->by_time);
    rates_of(&now->machine, now->t - apart, now->x, now->u, now->p, a->dx);
    for (int i = 0; i < STATES; i++)
        a->by_time[i] = (a->by_time[i] - a->dx[i]) / (2.0 * apart);
#else
    (void)now;
#endif
}

/* A step of h from the present moment: its stages, and its end in a->end. */
static void attempt(Instance *a, double h)
{
    Moment *now = &a->now;
    double *w = a->inverse;
    for (int i = 0; i < STATES * STATES; i++)
        w[i] = -a->fx[i];
    for (int i = 0; i < STATES; i++)
        w[i * STATES + i] += 1.0 / (h * METHOD_GAMMA);
    factor(w, a->order);
    for (int stage = 0; stage < STAGES; stage++) {
        double *own = a->k[stage];
        if (stage > 5) {
            for (int i = 0; i < STATES; i++)
                a->point[i] += a->k[stage - 1][i];
        } else {
            for (int i = 0; i < STATES; i++) {
                a->point[i] = now->x[i];
                for (int j = 0; j < stage; j++)
                    a->point[i] += EARLIER[stage][j] * a->k[j][i];
            }
        }
        if (stage == 0)
            memcpy(own, a->slope, sizeof a->slope);
        else
            rates_of(&now->machine, now->t + NODES[stage] * h, a->point, now->u, now->p, own);
        for (int i = 0; i < STATES; i++) {
            own[i] += h * BY_TIME[stage] * a->by_time[i];
            for (int j = 0; j < stage; j++)
                own[i] += COUPLING[stage][j] / h * a->k[j][i];
        }
        solve(w, a->order, own);
    }
    for (int i = 0; i < STATES; i++)
        a->end[i] = a->point[i] + a->k[STAGES - 1][i];
#if FRICTIONS > 0
    for (int f = 0; f < FRICTIONS; f++)
        if (now->machine.modes[f] == 0.0)
            a->end[FRICTION_RATES[f]] = now->x[FRICTION_RATES[f]];
#endif
#if RIGID
    for (int c = 0; c < CONTACTS; c++)
        if (now->machine.pressed[c])
            a->end[CONTACT_RATES[c][0]] = now->x[CONTACT_RATES[c][0]];
#endif
}

/* The estimated error of an attempt over its tolerance. */
static double error_of(const Instance *a)
{
    double worst = 0.0;
    for (int i = 0; i < STATES; i++) {
        const double size = MAX(fabs(a->now.x[i]), fabs(a->end[i]));
        const double own = fabs(a->k[STAGES - 1][i]) / (a->now.tolerance * (0.1 + size));
        if (!(own <= worst))
            worst = own;
    }
    return worst < 1e10 ? worst : 1e10;
}

#if INDICATORS > 0
/* The largest event function at a fraction of a step, on its dense output. */
static double on_curve(Instance *a, double h, double s)
{
    for (int i = 0; i < STATES; i++) {
        double d[3] = {0.0, 0.0, 0.0};
        for (int row = 0; row < 3; row++)
            for (int j = 0; j < STAGES; j++)
                d[row] += DENSE[row][j] * a->k[j][i];
        const double inner = a->end[i] + (1.0 - s) * (d[0] + s * (d[1] + s * d[2]));
        a->point[i] = (1.0 - s) * a->now.x[i] + s * inner;
    }
    return fill_indicators(a, a->now.t + s * h, a->point);
}

/* Shorten a step so that it ends just past its first event; the attempt is left at that length. */
static double locate_event(Instance *a, double h, double below, int *found)
{
    double low = 0.0, high = h, above = 0.0;
    *found = 0;
    for (int eighth = 1; eighth < 8; eighth++)
        if (on_curve(a, h, eighth / 8.0) > 0.0) {
            high = h * eighth / 8.0;
            break;
        }
    if (high < h)
        attempt(a, high);
    above = fill_indicators(a, a->now.t + high, a->end);
    if (above <= 0.0)
        return high; /* the dense output erred, or nothing happens */
    *found = 1;
    double last = high;
    for (int k = 0; k < MOST_SEARCHES && high - low > LANDING; k++) {
        double guess = 0.5 * (low + high);
        if (k % 3 != 2 && below < 0.0)
            guess = high - above * (high - low) / (above - below);
        if (guess - low < 0.25 * LANDING)
            guess = low + MAX(0.5 * LANDING, 1e-3 * (high - low));
        if (high - guess < 0.25 * LANDING)
            guess = high - MAX(0.5 * LANDING, 1e-3 * (high - low));
        attempt(a, guess);
        last = guess;
        const double value = fill_indicators(a, a->now.t + guess, a->end);
        if (value <= 0.0)
            low = guess, below = value;
        else
            high = guess, above = value;
    }
    if (last != high)
        attempt(a, high);
    return high;
}
#endif

/* Integrate to `stop` through all events. */
static int integrate(Instance *a, double stop)
{
    Moment *now = &a->now;
    int instants = 0, known = 0;
    while (stop - now->t > TIME_RESOLUTION) {
        const double left = stop - now->t, planned = fmin(now->length, LARGEST_STEP);
        double h = planned >= left ? left : left / ceil(left / planned);
        if (!known)
            begin_step(a);
        known = 1;
        attempt(a, h);
        const double error = error_of(a);
        const double grown = h * fmin(5.0, fmax(0.2, 0.9 * pow(MAX(error, 1e-10), -0.2)));
        if (error > 1.0) {
            now->length = grown;
            if (grown < SHORTEST_STEP)
                return fail(a, "At %.6g s the state changes too fast, or is no number", now->t);
            continue;
        }
        now->length = now->length <= h ? grown : fmax(now->length, grown);
        int found = 0;
#if INDICATORS > 0
        const double whole = h, at_start = fill_indicators(a, now->t, now->x);
        h = locate_event(a, h, at_start, &found);
        now->t = h == whole && h == left ? stop : now->t + h;
#else
        now->t = h == left ? stop : now->t + h;
#endif
        if (!is_number(a->end, STATES))
            return fail(a, "At %.6g s a state is larger than 1e12", now->t);
        memcpy(now->x, a->end, STATES * sizeof *now->x);
        known = 0;
        if (found) {
            instants = h < INSTANT_STEP ? instants + 1 : 0;
            if (instants > MOST_INSTANT_EVENTS)
                return fail(a, "At %.6g s modes chatter", now->t);
            if (!settle_modes(a))
                return 0;
        }
    }
    now->t = stop;
    return 1;
}

/* One communication step, inputs held; samplers run at its beginning and inside it. */
static int advance_to(Instance *a, double stop)
{
    while (a->now.t < stop) {
        if (!pass_events(a))
            return 0;
        const double sample = next_sample(a);
        if (!integrate(a, sample < stop - TIME_RESOLUTION ? sample : stop))
            return 0;
    }
    return 1;
}

/* Pass an event in model exchange; whether the state has jumped. */
static int update(Instance *a, int *jumped)
{
    memcpy(a->before, a->now.x, sizeof a->before);
    const int done = pass_events(a);
    *jumped = memcmp(a->before, a->now.x, CONTINUOUS * sizeof *a->before) != 0;
    return done;
}
