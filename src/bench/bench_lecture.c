/* lecture.c as it stands.  Its calls of CHOLMOD are led past a clock, and where
 * it would end the program it comes back here. */
#include "bench/bench_lecture.h"

#include <SDL.h>
#include <cholmod.h>
#include <setjmp.h>
#include <stdlib.h>

#include "bench/bench_report.h"

static struct {
    LectureCounters *counters;
    double since; /* when what runs now began */
    jmp_buf failed;
} bench;

/* Books the time since the last call of this. */
static void book(double *seconds)
{
    double now = clock_now();
    *seconds += now - bench.since;
    bench.since = now;
}

static int timed_start(cholmod_common *common)
{
    book(&bench.counters->seconds_search);
    return cholmod_start(common);
}

static cholmod_factor *timed_analyze(cholmod_sparse *H, cholmod_common *common)
{
    book(&bench.counters->seconds_assembly);
    cholmod_factor *L = cholmod_analyze(H, common);
    book(&bench.counters->seconds_analysis);
    return L;
}

static int timed_factorize(cholmod_sparse *H, cholmod_factor *L,
                           cholmod_common *common)
{
    bench.counters->factorisations++;
    int result = cholmod_factorize(H, L, common);
    book(&bench.counters->seconds_factor);
    return result;
}

static cholmod_dense *timed_solve(int system, cholmod_factor *L,
                                  cholmod_dense *b, cholmod_common *common)
{
    cholmod_dense *x = cholmod_solve(system, L, b, common);
    book(&bench.counters->seconds_solve);
    return x;
}

#define cholmod_start     timed_start
#define cholmod_analyze   timed_analyze
#define cholmod_factorize timed_factorize
#define cholmod_solve     timed_solve
#define exit(code)        longjmp(bench.failed, code)
#define make_psd          lecture_make_psd /* psd.h has one too */
#define main              lecture_main
int main(int argc, char **argv);
#include "lecture.c"

/* The system as lecture.c has it; x and v are copies. */
static Solid solid_of(const System *system, const double *x, const double *v)
{
    int n = system->nodes;
    size_t bytes = (size_t)n * sizeof(Vec2);
    Solid solid = {n,
                   system->springs,
                   malloc(bytes),
                   malloc(bytes),
                   system->m,
                   malloc((size_t)system->springs * sizeof(Spring))};
    if (!solid.x || !solid.v || !solid.e)
        return solid;
    memcpy(solid.x, x, bytes);
    memcpy(solid.v, v, bytes);
    for (int s = 0; s < system->springs; s++)
        solid.e[s] = (Spring){system->e[2 * s], system->e[2 * s + 1],
                              system->l2[s], system->k[s]};
    return solid;
}

Status lecture_step(const System *system, double h, double tol, double *x,
                    double *v, LectureCounters *counters)
{
    Solid solid = solid_of(system, x, v);
    volatile Status status = STATUS_OUT_OF_MEMORY;
    bench.counters = counters;
    bench.since = clock_now();
    if (solid.x && solid.v && solid.e) {
        status = STATUS_LINE_SEARCH_LIMIT;
        if (!setjmp(bench.failed)) {
            step_forward(&solid, h, tol, 0, NULL);
            status = STATUS_OK;
        }
        const double *end = &solid.x->x;
        for (int i = 0; i < 2 * system->nodes; i++) {
            v[i] = (end[i] - x[i]) / h;
            x[i] = end[i];
        }
    }
    free(solid.x);
    free(solid.v);
    free(solid.e);
    return status;
}
