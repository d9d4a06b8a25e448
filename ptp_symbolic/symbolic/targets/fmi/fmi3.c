/* Functional Mock-up Interface 3.0: model exchange and co-simulation. */

#include "instance.c"

#include "fmi3Functions.h"

static fmi3Status told(Instance *a, int done)
{
    if (done)
        return fmi3OK;
    a->failed = 1;
    if (a->callback != NULL)
        ((fmi3LogMessageCallback)a->callback)(a->environment, fmi3Error, "logStatusError",
                                              a->message);
    return fmi3Error;
}

#define NEEDS_INSTANCE \
    Instance *a = instance; \
    if (a == NULL) \
        return fmi3Error

static fmi3Status impossible(void *instance, const char *what)
{
    NEEDS_INSTANCE;
    return told(a, fail(a, "%s is not possible", what));
}

const char *fmi3GetVersion(void) { return fmi3Version; }

fmi3Status fmi3SetDebugLogging(fmi3Instance instance, fmi3Boolean on, size_t n,
                               const fmi3String given[])
{
    (void)on, (void)n, (void)given; /* errors alone are logged, always */
    NEEDS_INSTANCE;
    return fmi3OK;
}

static fmi3Instance made(fmi3String name, fmi3String token, int co_simulation,
                         fmi3InstanceEnvironment environment, fmi3LogMessageCallback log)
{
    Instance *a = make_instance(name, token, co_simulation);
    if (a == NULL) {
        if (log != NULL)
            log(environment, fmi3Error, "logStatusError",
                "The instantiation token is not that of this model, or memory is short");
        return NULL;
    }
    a->callback = (void (*)(void))log;
    a->environment = environment;
    return a;
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources,
                                          fmi3Boolean visible, fmi3Boolean logging,
                                          fmi3InstanceEnvironment environment,
                                          fmi3LogMessageCallback log)
{
    (void)resources, (void)visible, (void)logging;
    return made(name, token, 0, environment, log);
}

fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
    fmi3Boolean logging, fmi3Boolean event_mode, fmi3Boolean early_return,
    const fmi3ValueReference intermediate[], size_t n, fmi3InstanceEnvironment environment,
    fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback update_between)
{
    (void)resources, (void)visible, (void)logging, (void)event_mode, (void)early_return;
    (void)intermediate, (void)n, (void)update_between;
    return made(name, token, 1, environment, log);
}

fmi3Instance fmi3InstantiateScheduledExecution(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
    fmi3Boolean logging, fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
    fmi3ClockUpdateCallback clock, fmi3LockPreemptionCallback lock,
    fmi3UnlockPreemptionCallback unlock)
{
    (void)name, (void)token, (void)resources, (void)visible, (void)logging, (void)environment;
    (void)log, (void)clock, (void)lock, (void)unlock;
    return NULL;
}

void fmi3FreeInstance(fmi3Instance instance) { free(instance); }

fmi3Status fmi3EnterInitializationMode(fmi3Instance instance, fmi3Boolean with_tolerance,
                                       fmi3Float64 tolerance, fmi3Float64 start_time,
                                       fmi3Boolean with_stop, fmi3Float64 stop)
{
    (void)with_stop, (void)stop;
    NEEDS_INSTANCE;
    if (with_tolerance && tolerance > 0.0)
        a->now.tolerance = tolerance;
    a->now.t = start_time;
    a->now.stale = 1;
    return fmi3OK;
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance instance)
{
    NEEDS_INSTANCE;
    return told(a, start(a));
}

fmi3Status fmi3EnterEventMode(fmi3Instance instance)
{
    NEEDS_INSTANCE;
    return fmi3OK;
}

fmi3Status fmi3Terminate(fmi3Instance instance)
{
    NEEDS_INSTANCE;
    return fmi3OK;
}

fmi3Status fmi3Reset(fmi3Instance instance)
{
    NEEDS_INSTANCE;
    restore_start(a);
    return fmi3OK;
}

fmi3Status fmi3GetFloat64(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                          fmi3Float64 values[], size_t count)
{
    NEEDS_INSTANCE;
    if (count != n)
        return told(a, fail(a, "All variables are scalars"));
    return told(a, get_numbers(a, vr, n, values));
}

fmi3Status fmi3SetFloat64(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                          const fmi3Float64 values[], size_t count)
{
    NEEDS_INSTANCE;
    if (count != n)
        return told(a, fail(a, "All variables are scalars"));
    for (size_t k = 0; k < n; k++)
        if (!set_number(a, vr[k], values[k]))
            return told(a, 0);
    return fmi3OK;
}

fmi3Status fmi3GetInt64(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                        fmi3Int64 values[], size_t count)
{
    NEEDS_INSTANCE;
    if (count != n)
        return told(a, fail(a, "All variables are scalars"));
    for (size_t k = 0; k < n; k++) {
        int mode = 0;
        if (!get_mode(a, vr[k], &mode))
            return told(a, 0);
        values[k] = mode;
    }
    return fmi3OK;
}

/* Types of which this model has no variables. */
#define NO_VARIABLES(Type) \
    fmi3Status fmi3Get##Type(fmi3Instance instance, const fmi3ValueReference vr[], size_t n, \
                             fmi3##Type values[], size_t count) \
    { \
        (void)vr, (void)values, (void)count; \
        return n == 0 ? fmi3OK : impossible(instance, "To get a " #Type); \
    } \
    NOT_SET(Type)
#define NOT_SET(Type) \
    fmi3Status fmi3Set##Type(fmi3Instance instance, const fmi3ValueReference vr[], size_t n, \
                             const fmi3##Type values[], size_t count) \
    { \
        (void)vr, (void)values, (void)count; \
        return n == 0 ? fmi3OK : impossible(instance, "To set a " #Type); \
    }

NO_VARIABLES(Float32)
NO_VARIABLES(Int8)
NO_VARIABLES(UInt8)
NO_VARIABLES(Int16)
NO_VARIABLES(UInt16)
NO_VARIABLES(Int32)
NO_VARIABLES(UInt32)
NO_VARIABLES(UInt64)
NO_VARIABLES(Boolean)
NO_VARIABLES(String)
NOT_SET(Int64)

fmi3Status fmi3GetBinary(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                         size_t sizes[], fmi3Binary values[], size_t count)
{
    (void)vr, (void)sizes, (void)values, (void)count;
    return n == 0 ? fmi3OK : impossible(instance, "To get a Binary");
}

fmi3Status fmi3SetBinary(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                         const size_t sizes[], const fmi3Binary values[], size_t count)
{
    (void)vr, (void)sizes, (void)values, (void)count;
    return n == 0 ? fmi3OK : impossible(instance, "To set a Binary");
}

fmi3Status fmi3GetClock(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                        fmi3Clock values[])
{
    (void)vr, (void)values;
    return n == 0 ? fmi3OK : impossible(instance, "To get a Clock");
}

fmi3Status fmi3SetClock(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                        const fmi3Clock values[])
{
    (void)vr, (void)values;
    return n == 0 ? fmi3OK : impossible(instance, "To set a Clock");
}

fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance instance, fmi3ValueReference vr,
                                               size_t *count)
{
    (void)vr, (void)count;
    return impossible(instance, "To ask for dependencies");
}

fmi3Status fmi3GetVariableDependencies(fmi3Instance instance, fmi3ValueReference dependent,
                                       size_t dependent_elements[], fmi3ValueReference independents[],
                                       size_t independent_elements[], fmi3DependencyKind kinds[],
                                       size_t count)
{
    (void)dependent, (void)dependent_elements, (void)independents, (void)independent_elements;
    (void)kinds, (void)count;
    return impossible(instance, "To ask for dependencies");
}

fmi3Status fmi3GetFMUState(fmi3Instance instance, fmi3FMUState *state)
{
    NEEDS_INSTANCE;
    if (*state == NULL)
        *state = malloc(sizeof(Moment));
    if (*state == NULL)
        return told(a, fail(a, "Memory is short"));
    memcpy(*state, &a->now, sizeof(Moment));
    return fmi3OK;
}

fmi3Status fmi3SetFMUState(fmi3Instance instance, fmi3FMUState state)
{
    NEEDS_INSTANCE;
    memcpy(&a->now, state, sizeof(Moment));
    a->failed = 0;
    return fmi3OK;
}

fmi3Status fmi3FreeFMUState(fmi3Instance instance, fmi3FMUState *state)
{
    NEEDS_INSTANCE;
    if (state != NULL) {
        free(*state);
        *state = NULL;
    }
    return fmi3OK;
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance instance, fmi3FMUState state, size_t *size)
{
    (void)state;
    NEEDS_INSTANCE;
    *size = sizeof(Moment);
    return fmi3OK;
}

fmi3Status fmi3SerializeFMUState(fmi3Instance instance, fmi3FMUState state, fmi3Byte bytes[],
                                 size_t size)
{
    NEEDS_INSTANCE;
    if (size < sizeof(Moment))
        return told(a, fail(a, "A state takes %u bytes", (unsigned)sizeof(Moment)));
    memcpy(bytes, state, sizeof(Moment));
    return fmi3OK;
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance instance, const fmi3Byte bytes[], size_t size,
                                   fmi3FMUState *state)
{
    NEEDS_INSTANCE;
    if (size != sizeof(Moment))
        return told(a, fail(a, "A state takes %u bytes", (unsigned)sizeof(Moment)));
    if (*state == NULL)
        *state = malloc(sizeof(Moment));
    if (*state == NULL)
        return told(a, fail(a, "Memory is short"));
    memcpy(*state, bytes, sizeof(Moment));
    return fmi3OK;
}

fmi3Status fmi3GetDirectionalDerivative(fmi3Instance instance, const fmi3ValueReference unknowns[],
                                        size_t rows, const fmi3ValueReference knowns[],
                                        size_t columns, const fmi3Float64 seed[], size_t seeds,
                                        fmi3Float64 out[], size_t count)
{
    NEEDS_INSTANCE;
    if (seeds != columns || count != rows)
        return told(a, fail(a, "All variables are scalars"));
    return told(a, directional_derivative(a, unknowns, rows, knowns, columns, seed, out));
}

fmi3Status fmi3GetAdjointDerivative(fmi3Instance instance, const fmi3ValueReference unknowns[],
                                    size_t rows, const fmi3ValueReference knowns[], size_t columns,
                                    const fmi3Float64 seed[], size_t seeds, fmi3Float64 out[],
                                    size_t count)
{
    NEEDS_INSTANCE;
    if (seeds != rows || count != columns)
        return told(a, fail(a, "All variables are scalars"));
    for (size_t j = 0; j < columns; j++) {
        out[j] = 0.0;
        for (size_t i = 0; i < rows; i++) {
            const double one = 1.0;
            double slope = 0.0;
            if (!directional_derivative(a, unknowns + i, 1, knowns + j, 1, &one, &slope))
                return told(a, 0);
            out[j] += seed[i] * slope;
        }
    }
    return fmi3OK;
}

fmi3Status fmi3EnterConfigurationMode(fmi3Instance instance)
{
    return impossible(instance, "To configure structural parameters");
}

fmi3Status fmi3ExitConfigurationMode(fmi3Instance instance)
{
    return impossible(instance, "To configure structural parameters");
}

/* Samples are time events of the model: it has no clocks. */
fmi3Status fmi3GetIntervalDecimal(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                                  fmi3Float64 intervals[], fmi3IntervalQualifier qualifiers[])
{
    (void)vr, (void)intervals, (void)qualifiers;
    return n == 0 ? fmi3OK : impossible(instance, "To get a clock");
}

fmi3Status fmi3GetIntervalFraction(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                                   fmi3UInt64 counters[], fmi3UInt64 resolutions[],
                                   fmi3IntervalQualifier qualifiers[])
{
    (void)vr, (void)counters, (void)resolutions, (void)qualifiers;
    return n == 0 ? fmi3OK : impossible(instance, "To get a clock");
}

fmi3Status fmi3GetShiftDecimal(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                               fmi3Float64 shifts[])
{
    (void)vr, (void)shifts;
    return n == 0 ? fmi3OK : impossible(instance, "To get a clock");
}

fmi3Status fmi3GetShiftFraction(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                                fmi3UInt64 counters[], fmi3UInt64 resolutions[])
{
    (void)vr, (void)counters, (void)resolutions;
    return n == 0 ? fmi3OK : impossible(instance, "To get a clock");
}

fmi3Status fmi3SetIntervalDecimal(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                                  const fmi3Float64 intervals[])
{
    (void)vr, (void)intervals;
    return n == 0 ? fmi3OK : impossible(instance, "To set a clock");
}

fmi3Status fmi3SetIntervalFraction(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                                   const fmi3UInt64 counters[], const fmi3UInt64 resolutions[])
{
    (void)vr, (void)counters, (void)resolutions;
    return n == 0 ? fmi3OK : impossible(instance, "To set a clock");
}

fmi3Status fmi3SetShiftDecimal(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                               const fmi3Float64 shifts[])
{
    (void)vr, (void)shifts;
    return n == 0 ? fmi3OK : impossible(instance, "To set a clock");
}

fmi3Status fmi3SetShiftFraction(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                                const fmi3UInt64 counters[], const fmi3UInt64 resolutions[])
{
    (void)vr, (void)counters, (void)resolutions;
    return n == 0 ? fmi3OK : impossible(instance, "To set a clock");
}

fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance instance)
{
    NEEDS_INSTANCE;
    return fmi3OK;
}

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance instance, fmi3Boolean *again,
                                    fmi3Boolean *terminate, fmi3Boolean *nominals_changed,
                                    fmi3Boolean *values_changed, fmi3Boolean *next_defined,
                                    fmi3Float64 *next)
{
    NEEDS_INSTANCE;
    int jumped = 0;
    if (!update(a, &jumped))
        return told(a, 0);
    const double sample = next_sample(a);
    *again = fmi3False;
    *terminate = fmi3False;
    *nominals_changed = fmi3False;
    *values_changed = jumped != 0;
    *next_defined = sample < HUGE_VAL;
    *next = sample < HUGE_VAL ? sample : 0.0;
    return fmi3OK;
}

fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance instance)
{
    NEEDS_INSTANCE;
    return fmi3OK;
}

fmi3Status fmi3CompletedIntegratorStep(fmi3Instance instance, fmi3Boolean no_set_state,
                                       fmi3Boolean *enter_event_mode, fmi3Boolean *terminate)
{
    (void)no_set_state;
    NEEDS_INSTANCE;
    *enter_event_mode = fmi3False;
    *terminate = fmi3False;
    return fmi3OK;
}

fmi3Status fmi3SetTime(fmi3Instance instance, fmi3Float64 time)
{
    NEEDS_INSTANCE;
    a->now.t = time;
    return fmi3OK;
}

fmi3Status fmi3SetContinuousStates(fmi3Instance instance, const fmi3Float64 x[], size_t n)
{
    NEEDS_INSTANCE;
    if (n != CONTINUOUS)
        return told(a, fail(a, "There are %d continuous states", CONTINUOUS));
    memcpy(a->now.x, x, n * sizeof *x);
    return fmi3OK;
}

fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance instance, fmi3Float64 derivatives[],
                                             size_t n)
{
    NEEDS_INSTANCE;
    if (n != CONTINUOUS)
        return told(a, fail(a, "There are %d continuous states", CONTINUOUS));
    if (!refresh(a))
        return told(a, 0);
    fill_derivatives(a);
    memcpy(derivatives, a->dx, n * sizeof *derivatives);
    return is_number(derivatives, CONTINUOUS) ? fmi3OK : fmi3Discard;
}

fmi3Status fmi3GetEventIndicators(fmi3Instance instance, fmi3Float64 indicators[], size_t n)
{
    NEEDS_INSTANCE;
    if (n != INDICATORS)
        return told(a, fail(a, "There are %d event indicators", INDICATORS));
    if (!refresh(a))
        return told(a, 0);
    show_indicators(a);
    memcpy(indicators, a->z, n * sizeof *indicators);
    return fmi3OK;
}

fmi3Status fmi3GetContinuousStates(fmi3Instance instance, fmi3Float64 x[], size_t n)
{
    NEEDS_INSTANCE;
    if (n != CONTINUOUS)
        return told(a, fail(a, "There are %d continuous states", CONTINUOUS));
    memcpy(x, a->now.x, n * sizeof *x);
    return fmi3OK;
}

fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance instance, fmi3Float64 nominals[],
                                             size_t n)
{
    NEEDS_INSTANCE;
    for (size_t k = 0; k < n; k++)
        nominals[k] = NOMINALS[k];
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance instance, size_t *count)
{
    NEEDS_INSTANCE;
    *count = INDICATORS;
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance instance, size_t *count)
{
    NEEDS_INSTANCE;
    *count = CONTINUOUS;
    return fmi3OK;
}

fmi3Status fmi3EnterStepMode(fmi3Instance instance)
{
    NEEDS_INSTANCE;
    return fmi3OK;
}

fmi3Status fmi3GetOutputDerivatives(fmi3Instance instance, const fmi3ValueReference vr[], size_t n,
                                    const fmi3Int32 orders[], fmi3Float64 values[], size_t count)
{
    (void)vr, (void)orders, (void)values, (void)count;
    return n == 0 ? fmi3OK : impossible(instance, "To get derivatives of outputs");
}

fmi3Status fmi3DoStep(fmi3Instance instance, fmi3Float64 now, fmi3Float64 length,
                      fmi3Boolean no_set_state, fmi3Boolean *event_needed, fmi3Boolean *terminate,
                      fmi3Boolean *early_return, fmi3Float64 *last)
{
    (void)no_set_state;
    NEEDS_INSTANCE;
    *event_needed = fmi3False;
    *terminate = fmi3False;
    *early_return = fmi3False;
    if (a->failed || !(length >= 0.0))
        return impossible(instance, "A step after an error, or backwards");
    a->now.t = now;
    const fmi3Status status = told(a, advance_to(a, now + length));
    *last = a->now.t;
    return status;
}

fmi3Status fmi3ActivateModelPartition(fmi3Instance instance, fmi3ValueReference clock,
                                      fmi3Float64 time)
{
    (void)clock, (void)time;
    return impossible(instance, "Scheduled execution");
}
