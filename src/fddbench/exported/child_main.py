"""The main around exported code that steps many flights at a request, in C."""

__all__ = ["ANSWER", "MAGIC", "SHORT_OF_MEMORY", "main_text"]

MAGIC = 0x0FDDBE4C
"""First word that it says: in which order it has its bytes, and that nobody else spoke before it."""

ANSWER = 0x0FDDA25
"""First word of every answer; its number follows."""
SHORT_OF_MEMORY = 201
"""Exit code where it ended after memory had been refused."""

_MAIN = """\
/* Steps many flights of {name} at a request: a count, then state and inputs of each; back come state and outputs.
 * What the code itself prints goes nowhere, and what it reads is empty. It ends with who began it, whose number is its first
 * argument, and where a system limits memory it takes no more than its second says in megabytes. */
#define _POSIX_C_SOURCE 200809L
#define _XOPEN_SOURCE 700

#include "{name}.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#if defined(__linux__)
#include <sys/prctl.h>
#endif
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#if defined(__SANITIZE_ADDRESS__)
#define SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SANITIZED
#endif
#endif

static pid_t parent;

/* With all that the code began. */
static void end_with_parent(int number)
{{
    (void)number;
    if (getppid() != parent) {{ (void)kill(0, SIGKILL); }}
}}

static void watch_parent(pid_t who)
{{
    static const struct itimerval half_second = {{{{0, 500000}}, {{0, 500000}}}};
    struct sigaction action;
    parent = who;
    end_with_parent(0);
#if defined(__linux__)
    if (prctl(PR_SET_PDEATHSIG, SIGKILL) == 0) {{ return; }}
#endif
    (void)memset(&action, 0, sizeof(action));
    action.sa_handler = end_with_parent;
    action.sa_flags = SA_RESTART;
    (void)sigaction(SIGALRM, &action, NULL);
    (void)setitimer(ITIMER_REAL, &half_second, NULL);
}}

/* Pages that are mapped now; 0: nobody says. */
static unsigned long mapped(void)
{{
    char text[24] = "";
    unsigned long pages = 0UL;
    int own = open("/proc/self/statm", O_RDONLY);
    ssize_t n = (own < 0) ? 0 : read(own, text, sizeof(text) - 1U);
    ssize_t k;
    for (k = 0; (k < n) && (text[k] >= '0') && (text[k] <= '9'); k++)
    {{
        pages = (pages * 10UL) + (unsigned long)(text[k] - '0');
    }}
    if (own >= 0) {{ (void)close(own); }}
    return pages;
}}

/* Who ends after memory was refused in this step had too little. */
static void end_for_memory(void)
{{
    if (errno == ENOMEM) {{ _exit({short_of_memory}); }}
}}

static void end_by(int number)
{{
    end_for_memory();
    (void)signal(number, SIG_DFL);
    (void)raise(number);
}}

/* As much more as it is told; sanitizers map more than there is, and are not limited. */
static void limit_memory(const char *more_mb)
{{
    static char stack[65536];
    static const stack_t aside = {{.ss_sp = stack, .ss_size = sizeof(stack)}};
    struct rlimit limit;
    struct sigaction action;
    unsigned long page = (unsigned long)sysconf(_SC_PAGESIZE);
    unsigned long more = (strtoul(more_mb, NULL, 10) * 1048576UL) / page;
    unsigned long now = mapped();
    if ((more == 0UL) || (now == 0UL)) {{ return; }}
    limit.rlim_cur = (rlim_t)(now + more) * page;
    limit.rlim_max = limit.rlim_cur;
    (void)setrlimit(RLIMIT_AS, &limit);
    (void)memset(&action, 0, sizeof(action));
    action.sa_handler = end_by;
    action.sa_flags = SA_ONSTACK;
    (void)sigaltstack(&aside, NULL);
    (void)sigaction(SIGSEGV, &action, NULL);
    (void)sigaction(SIGBUS, &action, NULL);
    (void)sigaction(SIGABRT, &action, NULL);
    (void)atexit(end_for_memory);
}}

int main(int argc, char **argv)
{{
    static {name}_state_t start;
    uint32_t sizes[4] = {{
        {magic}U, (uint32_t)sizeof({name}_state_t), (uint32_t)sizeof({name}_inputs_t), (uint32_t)sizeof({name}_outputs_t)
    }};
    unsigned char *taken = NULL;
    unsigned char *given = NULL;
    uint32_t room = 0U;
    uint32_t n = 0U;
    size_t in = sizeof({name}_state_t) + sizeof({name}_inputs_t);
    size_t out = sizeof({name}_state_t) + sizeof({name}_outputs_t);
    uint32_t head[2] = {{{answer}U, 0U}}; /* before each answer, with its number: what else was written is found out */
    FILE *from = fdopen(fcntl(0, F_DUPFD, 200), "rb"); /* numbers that nobody guesses */
    FILE *to = fdopen(fcntl(1, F_DUPFD, 200), "wb");
    if ((from == NULL) || (to == NULL) || (freopen("/dev/null", "r", stdin) == NULL)
        || (freopen("/dev/null", "w", stdout) == NULL))
    {{
        return 5;
    }}
    if (argc > 1) {{ watch_parent((pid_t)strtol(argv[1], NULL, 10)); }}
#if !defined(SANITIZED)
    if (argc > 2) {{ limit_memory(argv[2]); }}
#endif
    (void)memset(&start, 0, sizeof(start));
    errno = 0;
    {name}_init(&start);
    (void)fwrite(sizes, sizeof(sizes), 1, to);
    (void)fwrite(&start, sizeof(start), 1, to);
    (void)fflush(to);
    while (fread(&n, sizeof(n), 1, from) == 1U)
    {{
        uint32_t k;
        if (n > room)
        {{
            free(taken);
            free(given);
            room = n;
            taken = malloc(room * in);
            given = malloc(room * out);
            if ((taken == NULL) || (given == NULL)) {{ return 3; }}
        }}
        if ((n > 0U) && (fread(taken, in, n, from) != n)) {{ return 4; }}
        for (k = 0U; k < n; k++)
        {{
            {name}_state_t state;
            {name}_inputs_t inputs;
            {name}_outputs_t outputs;
            (void)memcpy(&state, taken + (k * in), sizeof(state));
            (void)memcpy(&inputs, taken + (k * in) + sizeof(state), sizeof(inputs));
            (void)memset(&outputs, 0, sizeof(outputs));
            errno = 0;
            {name}_step(&inputs, &state, &outputs);
            (void)memcpy(given + (k * out), &state, sizeof(state));
            (void)memcpy(given + (k * out) + sizeof(state), &outputs, sizeof(outputs));
        }}
        head[1]++;
        (void)fwrite(head, sizeof(head), 1, to);
        (void)fwrite(given, out, n, to);
        (void)fflush(to);
    }}
    return 0;
}}
"""


def main_text(name: str) -> str:
    """Text of the main around a detector."""
    return _MAIN.format(name=name, magic=MAGIC, answer=ANSWER, short_of_memory=SHORT_OF_MEMORY)
