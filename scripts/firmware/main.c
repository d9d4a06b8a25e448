/* Counts the instructions of an exported model on an emulated Cortex-M, and what its stack takes.

   SysTick counts virtual time, of which QEMU gives every instruction the same amount. Numbers leave
   by semihosting. MODEL, VOLTS and STEP come from the command line of the compiler. */

#include <stdint.h>
#include <string.h>

#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)
#define OF(name) JOIN(MODEL, name)
#define QUOTE_(text) #text
#define QUOTE(text) QUOTE_(text)
#include HEADER

extern uint32_t _stack_top[];
extern uint32_t _bss_begin[], _bss_end[], _data_begin[], _data_end[], _data_load[];
int main(void);

static volatile uint32_t *const CPACR = (uint32_t *)0xE000ED88;
static volatile uint32_t *const SYSTICK = (uint32_t *)0xE000E010;
enum { PAINTED = 12288, CALLS = 32, STEPS = 2000 };

static void semihost(int operation, const void *argument)
{
    register int r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
}

static void print_number(uint32_t number)
{
    char text[12];
    int at = 11;
    text[at] = 0;
    do
        text[--at] = (char)('0' + number % 10);
    while (number /= 10);
    semihost(4, text + at);
    semihost(4, " ");
}

static uint32_t now(void) { return 0xFFFFFF - SYSTICK[2]; }
static uint32_t since(uint32_t begin) { return (now() - begin) & 0xFFFFFF; }

void reset(void)
{
    memcpy(_data_begin, _data_load, (size_t)((char *)_data_end - (char *)_data_begin));
    memset(_bss_begin, 0, (size_t)((char *)_bss_end - (char *)_bss_begin));
    *CPACR |= 0xFu << 20;
    __asm__ volatile("dsb; isb");
    SYSTICK[1] = 0xFFFFFF;
    SYSTICK[2] = 0;
    SYSTICK[0] = 5;
    main();
    const struct { uint32_t reason, code; } stop = {0x20026, 0};
    semihost(0x18, (const void *)(uintptr_t)stop.reason);
    for (;;)
        ;
}

__attribute__((section(".vectors"), used)) static const void *const vectors[] = {_stack_top, reset};

static OF(_machine) machine;
static OF(_real) x[16], u[8], y[32], dx[16], p[256], fx[256];

static void drive(int k)
{
    for (int i = 0; i < INPUTS; i++)
        u[i] = (OF(_real))((k / 500) % 2 ? -VOLTS : VOLTS);
}

int main(void)
{
    for (int i = 0; i < PARAMETERS; i++)
        p[i] = OF(_parameters)[i];
    memcpy(x, OF(_initial_state), sizeof(OF(_real)) * STATES);
    uint32_t stack;
    __asm__ volatile("mov %0, sp" : "=r"(stack));
    volatile uint32_t *const low = (uint32_t *)(uintptr_t)(stack - PAINTED);
    for (int i = 0; i < PAINTED / 4; i++)
        low[i] = 0xA5A5A5A5;
    drive(0);
    if (OF(_begin)(&machine, 0, x, u, p))
        return 1;
    uint32_t total = 0, worst = 0;
    int failed = 0;
    for (int k = 0; k < STEPS && !failed; k++) {
        drive(k);
        const uint32_t begin = now();
        failed = OF(_step)(&machine, (OF(_real))(k * STEP), (OF(_real))STEP, x, u, u, p);
        const uint32_t took = since(begin);
        total += took;
        worst = took > worst ? took : worst;
    }
    int untouched = 0;
    while (untouched < PAINTED / 4 && low[untouched] == 0xA5A5A5A5)
        untouched++;
    uint32_t begin = now();
    for (int k = 0; k < CALLS; k++)
        OF(_prepared_derivative)(0, x, u, p, machine.modes, machine.prepared, dx);
    const uint32_t field = since(begin) / CALLS;
    begin = now();
    for (int k = 0; k < CALLS; k++)
        OF(_state_jacobian)(0, x, u, p, machine.modes, fx);
    const uint32_t jacobian = since(begin) / CALLS;
    begin = now();
    for (int k = 0; k < CALLS; k++)
        OF(_outputs)(0, x, u, p, y);
    const uint32_t outputs = since(begin) / CALLS;
    print_number((uint32_t)failed);
    print_number(field);
    print_number(jacobian);
    print_number(outputs);
    print_number(total / STEPS);
    print_number(worst);
    print_number((uint32_t)(PAINTED - 4 * untouched));
    print_number(sizeof machine);
    semihost(4, "\n");
    return 0;
}
