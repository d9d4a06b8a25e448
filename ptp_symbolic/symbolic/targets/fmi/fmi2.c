/* Functional Mock-up Interface 2.0: model exchange and co-simulation. */

#include "instance.c"

#include "fmi2Functions.h"

static fmi2Status told(Instance *a, int done)
{
    if (done)
        return fmi2OK;
    a->failed = 1;
    if (a->callback != NULL)
        ((fmi2CallbackLogger)a->callback)(a->environment, a->name, fmi2Error, "logStatusError",
                                          a->message);
    return fmi2Error;
}

#define NEEDS_INSTANCE \
    Instance *a = c; \
    if (a == NULL) \
        return fmi2Error

static fmi2Status impossible(void *c, const char *what)
{
    NEEDS_INSTANCE;
    return told(a, fail(a, "%s is not possible", what));
}

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }
const char *fmi2GetVersion(void) { return fmi2Version; }

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String given[])
{
    (void)on, (void)n, (void)given; /* errors alone are logged, always */
    NEEDS_INSTANCE;
    return fmi2OK;
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible,
                              fmi2Boolean logging)
{
    (void)resources, (void)visible, (void)logging;
    Instance *a = make_instance(name, guid, type == fmi2CoSimulation);
    if (a == NULL) {
        if (functions != NULL && functions->logger != NULL)
            functions->logger(functions->componentEnvironment, name, fmi2Error, "logStatusError",
                              "The GUID is not that of this model, or memory is short");
        return NULL;
    }
    if (functions != NULL) {
        a->callback = (void (*)(void))functions->logger;
        a->environment = functions->componentEnvironment;
    }
    return a;
}

void fmi2FreeInstance(fmi2Component c) { free(c); }

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean with_tolerance, fmi2Real tolerance,
                               fmi2Real start_time, fmi2Boolean with_stop, fmi2Real stop)
{
    (void)with_stop, (void)stop;
    NEEDS_INSTANCE;
    if (with_tolerance && tolerance > 0.0)
        a->now.tolerance = tolerance;
    a->now.t = start_time;
    a->now.stale = 1;
    return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    NEEDS_INSTANCE;
    return fmi2OK;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    NEEDS_INSTANCE;
    return told(a, start(a));
}

fmi2Status fmi2Terminate(fmi2Component c)
{
    NEEDS_INSTANCE;
    return fmi2OK;
}

fmi2Status fmi2Reset(fmi2Component c)
{
    NEEDS_INSTANCE;
    restore_start(a);
    return fmi2OK;
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2Real value[])
{
    NEEDS_INSTANCE;
    return told(a, get_numbers(a, vr, n, value));
}

fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                          fmi2Integer value[])
{
    NEEDS_INSTANCE;
    for (size_t k = 0; k < n; k++)
        if (!get_mode(a, vr[k], value + k))
            return told(a, 0);
    return fmi2OK;
}

fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                          fmi2Boolean value[])
{
    (void)vr, (void)value;
    return n == 0 ? fmi2OK : impossible(c, "To get a Boolean");
}

fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                         fmi2String value[])
{
    (void)vr, (void)value;
    return n == 0 ? fmi2OK : impossible(c, "To get a String");
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                       const fmi2Real value[])
{
    NEEDS_INSTANCE;
    for (size_t k = 0; k < n; k++)
        if (!set_number(a, vr[k], value[k]))
            return told(a, 0);
    return fmi2OK;
}

fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                          const fmi2Integer value[])
{
    (void)vr, (void)value;
    return n == 0 ? fmi2OK : impossible(c, "To set a mode");
}

fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                          const fmi2Boolean value[])
{
    (void)vr, (void)value;
    return n == 0 ? fmi2OK : impossible(c, "To set a Boolean");
}

fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                         const fmi2String value[])
{
    (void)vr, (void)value;
    return n == 0 ? fmi2OK : impossible(c, "To set a String");
}

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    NEEDS_INSTANCE;
    if (*state == NULL)
        *state = malloc(sizeof(Moment));
    if (*state == NULL)
        return told(a, fail(a, "Memory is short"));
    memcpy(*state, &a->now, sizeof(Moment));
    return fmi2OK;
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state)
{
    NEEDS_INSTANCE;
    memcpy(&a->now, state, sizeof(Moment));
    a->failed = 0;
    return fmi2OK;
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state)
{
    NEEDS_INSTANCE;
    if (state != NULL) {
        free(*state);
        *state = NULL;
    }
    return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size)
{
    (void)state;
    NEEDS_INSTANCE;
    *size = sizeof(Moment);
    return fmi2OK;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size)
{
    NEEDS_INSTANCE;
    if (size < sizeof(Moment))
        return told(a, fail(a, "A state takes %u bytes", (unsigned)sizeof(Moment)));
    memcpy(bytes, state, sizeof(Moment));
    return fmi2OK;
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size,
                                   fmi2FMUstate *state)
{
    NEEDS_INSTANCE;
    if (size != sizeof(Moment))
        return told(a, fail(a, "A state takes %u bytes", (unsigned)sizeof(Moment)));
    if (*state == NULL)
        *state = malloc(sizeof(Moment));
    if (*state == NULL)
        return told(a, fail(a, "Memory is short"));
    memcpy(*state, bytes, sizeof(Moment));
    return fmi2OK;
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknowns[],
                                        size_t rows, const fmi2ValueReference knowns[],
                                        size_t columns, const fmi2Real seed[], fmi2Real out[])
{
    NEEDS_INSTANCE;
    return told(a, directional_derivative(a, unknowns, rows, knowns, columns, seed, out));
}

fmi2Status fmi2EnterEventMode(fmi2Component c)
{
    NEEDS_INSTANCE;
    return fmi2OK;
}

fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *info)
{
    NEEDS_INSTANCE;
    int jumped = 0;
    if (!update(a, &jumped))
        return told(a, 0);
    const double sample = next_sample(a);
    info->newDiscreteStatesNeeded = fmi2False;
    info->terminateSimulation = fmi2False;
    info->nominalsOfContinuousStatesChanged = fmi2False;
    info->valuesOfContinuousStatesChanged = jumped;
    info->nextEventTimeDefined = sample < HUGE_VAL;
    info->nextEventTime = sample < HUGE_VAL ? sample : 0.0;
    return fmi2OK;
}

fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c)
{
    NEEDS_INSTANCE;
    return fmi2OK;
}

fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean no_set_state,
                                       fmi2Boolean *enter_event_mode, fmi2Boolean *terminate)
{
    (void)no_set_state;
    NEEDS_INSTANCE;
    *enter_event_mode = fmi2False;
    *terminate = fmi2False;
    return fmi2OK;
}

fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time)
{
    NEEDS_INSTANCE;
    a->now.t = time;
    return fmi2OK;
}

fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t n)
{
    NEEDS_INSTANCE;
    if (n != CONTINUOUS)
        return told(a, fail(a, "There are %d continuous states", CONTINUOUS));
    memcpy(a->now.x, x, n * sizeof *x);
    return fmi2OK;
}

fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real derivatives[], size_t n)
{
    NEEDS_INSTANCE;
    if (n != CONTINUOUS)
        return told(a, fail(a, "There are %d continuous states", CONTINUOUS));
    if (!refresh(a))
        return told(a, 0);
    fill_derivatives(a);
    memcpy(derivatives, a->dx, n * sizeof *derivatives);
    return is_number(derivatives, CONTINUOUS) ? fmi2OK : fmi2Discard;
}

fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real indicators[], size_t n)
{
    NEEDS_INSTANCE;
    if (n != INDICATORS)
        return told(a, fail(a, "There are %d event indicators", INDICATORS));
    if (!refresh(a))
        return told(a, 0);
    show_indicators(a);
    memcpy(indicators, a->z, n * sizeof *indicators);
    return fmi2OK;
}

fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t n)
{
    NEEDS_INSTANCE;
    if (n != CONTINUOUS)
        return told(a, fail(a, "There are %d continuous states", CONTINUOUS));
    memcpy(x, a->now.x, n * sizeof *x);
    return fmi2OK;
}

fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real nominals[], size_t n)
{
    NEEDS_INSTANCE;
    for (size_t k = 0; k < n; k++)
        nominals[k] = NOMINALS[k];
    return fmi2OK;
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                       const fmi2Integer order[], const fmi2Real value[])
{
    (void)vr, (void)order, (void)value;
    return n == 0 ? fmi2OK : impossible(c, "To interpolate inputs");
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                        const fmi2Integer order[], fmi2Real value[])
{
    (void)vr, (void)order, (void)value;
    return n == 0 ? fmi2OK : impossible(c, "To get derivatives of outputs");
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real now, fmi2Real length, fmi2Boolean no_set_state)
{
    (void)no_set_state;
    NEEDS_INSTANCE;
    if (a->failed || !(length >= 0.0))
        return impossible(c, "A step after an error, or backwards");
    a->now.t = now;
    return told(a, advance_to(a, now + length));
}

fmi2Status fmi2CancelStep(fmi2Component c) { return impossible(c, "To cancel a step"); }

fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Status *value)
{
    (void)kind;
    *value = fmi2OK;
    return c == NULL ? fmi2Error : fmi2Discard;
}

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value)
{
    NEEDS_INSTANCE;
    *value = a->now.t;
    return kind == fmi2LastSuccessfulTime ? fmi2OK : fmi2Discard;
}

fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Integer *value)
{
    (void)kind, (void)value;
    return c == NULL ? fmi2Error : fmi2Discard;
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value)
{
    NEEDS_INSTANCE;
    *value = a->failed;
    return kind == fmi2Terminated ? fmi2OK : fmi2Discard;
}

fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind kind, fmi2String *value)
{
    (void)kind, (void)value;
    return c == NULL ? fmi2Error : fmi2Discard;
}
