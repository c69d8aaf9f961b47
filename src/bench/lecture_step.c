/* lecture_step.c - a step of lecture.c, which is included without a change.  A
 * call of exit in lecture.c becomes a jump out of the step. */
#include <SDL.h>
#include <cholmod.h>
#include <setjmp.h>
#include <stdlib.h>

#include "bench/bench.h"

static jmp_buf program_ended;

#define exit(code) longjmp(program_ended, code)
#define main       lecture_main
int main(int argc, char **argv);
#include "lecture.c"

Status lecture_step(const System *system, double h, double tol, double *x,
                    double *v)
{
    Spring *e = malloc((size_t)system->springs * sizeof *e);
    if (!e)
        return STATUS_OUT_OF_MEMORY;
    for (int s = 0; s < system->springs; s++)
        e[s] = (Spring){system->e[2 * s], system->e[2 * s + 1], system->l2[s],
                        system->k[s]};
    Solid solid = {system->nodes, system->springs, (Vec2 *)x,
                   (Vec2 *)v,     system->m,       e};
    volatile Status status = STATUS_LINE_SEARCH_LIMIT;
    if (!setjmp(program_ended)) {
        step_forward(&solid, h, tol, 0, NULL);
        status = STATUS_OK;
    }
    free(e);
    return status;
}
