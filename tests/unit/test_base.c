/* Functions whose last digit is promised, and two threads on one loop. */
#include "test.h"

#include <float.h>
#include <math.h>
#include <stdatomic.h>

#include "base/crew.h"
#include "base/mathematics.h"

/* Units in the last place between a double and the same in extended precision.
 */
static double ulps(double got, long double exact)
{
    double nearest = (double)exact;
    if (!isfinite(nearest))
        return got == nearest || (isnan(got) && isnan(nearest)) ? 0 : INFINITY;
    double unit = nextafter(fabs(nearest), INFINITY) - fabs(nearest);
    return (double)(fabsl(got - exact) / unit);
}

/* 1.5 units: what mathematics.h promises. */
static void check_digits(double x, double z)
{
    CHECK_AT_MOST(ulps(math_log(x), logl(x)), 1.5);
    CHECK_AT_MOST(ulps(math_log1p(z), log1pl(z)), 1.5);
    CHECK_AT_MOST(ulps(math_hypot(x, z), hypotl(x, z)), 1.5);
}

TEST(functions_are_right_to_the_last_place)
{
    static const double edges[] = {
        0,       1,       -1,       0.70710678118654752, INFINITY,        NAN,
        DBL_MIN, DBL_MAX, 4.9e-324, 1 - DBL_EPSILON,     1 + DBL_EPSILON, -3,
        1e-200,  1e200};
    const int count = sizeof edges / sizeof *edges;
    Random random = {81};
    for (int i = 0; i < count * count; i++)
        check_digits(edges[i / count], edges[i % count]);
    for (int i = 0; i < 300000; i++) {
        double x = i % 3 == 0   ? random_logarithmic(&random, 1e-300, 1e300)
                   : i % 3 == 1 ? random_uniform(&random, 0.5, 2)
                                : 1 + random_uniform(&random, -1e-6, 1e-6);
        double z = i % 2 ? random_uniform(&random, -0.999, 3)
                         : random_logarithmic(&random, 1e-20, 1e20);
        check_digits(x, i % 4 == 2 && z < 0.5 ? -z : z);
        if (i % 5 == 0)
            check_digits(x, x * random_uniform(&random, -2, 2));
    }
}

enum { ITEMS = 97 };

typedef struct Job {
    _Atomic int done[ITEMS];
} Job;

static void work_on(const void *job, int first, int end)
{
    Job *mine = (Job *)(uintptr_t)job;
    for (int i = first; i < end; i++)
        atomic_fetch_add(&mine->done[i], 1);
}

TEST(a_crew_does_every_item_once)
{
    static Job job;
    for (int threads = 1; threads <= 2; threads++) {
        Crew *crew = crew_create(threads);
        CHECK((crew != NULL) == (threads == 2));
        for (int loop = 0; loop < 20000; loop++) {
            int count = 1 + loop % ITEMS;
            crew_run(crew, work_on, &job, count, loop % 2 ? 1e9 : 1);
            for (int i = 0; i < ITEMS; i++)
                CHECK(atomic_exchange(&job.done[i], 0) == (i < count));
        }
        crew_free(crew);
    }
    for (int i = 0; i < 50; i++)
        crew_free(crew_create(2)); /* it can end at once */
    crew_free(NULL);
}

TESTS(NULL, NULL)
