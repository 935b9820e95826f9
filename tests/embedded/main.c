/* Runs one generated function on a Cortex-M under an emulator: instructions of a call, and the result for a check.
   FUNCTION, NQ, NV, NUMBERS and ARGUMENTS are given on the command line of the compiler. */
#include HEADER

#define SYST_CSR (*(volatile unsigned *)0xE000E010u)
#define SYST_RVR (*(volatile unsigned *)0xE000E014u)
#define SYST_CVR (*(volatile unsigned *)0xE000E018u)
#define CPACR (*(volatile unsigned *)0xE000ED88u)
#define CALLS 200

extern unsigned char stack_top[], data_start[], data_end[], data_from[], bss_start[], bss_end[];

static float q[NQ], v[NV], a[NV], out[NUMBERS];
static volatile float sink;

/* One line on the console of the debugger. */
static void say(const char *text) {
    register unsigned operation __asm__("r0") = 4; /* SYS_WRITE0 */
    register const char *argument __asm__("r1") = text;
    __asm__ volatile("bkpt 0xab" : "+r"(operation) : "r"(argument) : "memory");
}

static void end(void) {
    register unsigned operation __asm__("r0") = 0x18; /* SYS_EXIT */
    register unsigned argument __asm__("r1") = 0x20026; /* ADP_Stopped_ApplicationExit */
    __asm__ volatile("bkpt 0xab" : "+r"(operation) : "r"(argument) : "memory");
    for (;;) {
    }
}

static void number(unsigned x) {
    char text[12];
    char *at = text + 11;
    *at = 0;
    do {
        *--at = (char)('0' + x % 10);
        x /= 10;
    } while (x);
    say(at);
    say("\n");
}

static unsigned ticks(void) {
    return 0xFFFFFFu - SYST_CVR;
}

void start(void);
void start(void) {
    CPACR |= 0xFu << 20; /* the floating-point unit */
    __asm__ volatile("dsb\n isb");
    for (unsigned char *to = data_start, *from = data_from; to < data_end; *to++ = *from++) {
    }
    for (unsigned char *to = bss_start; to < bss_end; *to++ = 0) {
    }
    for (int k = 0; k < NQ; k++) {
        q[k] = 0.1f * (float)(k + 1);
    }
#ifdef FLOATING
    q[3] = 0.0f, q[4] = 0.0f, q[5] = 0.0f, q[6] = 1.0f;
#endif
    for (int k = 0; k < NV; k++) {
        v[k] = 0.2f - 0.1f * (float)k;
        a[k] = 0.3f * (float)k - 0.5f;
    }
    SYST_RVR = 0xFFFFFF;
    SYST_CVR = 0;
    SYST_CSR = 5; /* by the processor's clock */
    const unsigned before = ticks();
    for (int k = 0; k < CALLS; k++) {
        FUNCTION(ARGUMENTS, out);
        sink = out[0];
    }
    const unsigned with = ticks();
    for (int k = 0; k < CALLS; k++) {
        sink = out[0];
    }
    number(((with - before) & 0xFFFFFFu) - ((ticks() - with) & 0xFFFFFFu));
    for (int k = 0; k < NUMBERS; k++) {
        union { float number; unsigned bits; } x;
        x.number = out[k];
        number(x.bits);
    }
    end();
}

__attribute__((section(".vectors"), used)) static const struct {
    unsigned char *stack;
    void (*reset)(void);
} vectors = {stack_top, start};
