/* Two threads on one loop: every item is done once. */
#include "test.h"

#include <stdatomic.h>

#include "base/crew.h"

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

TEST(every_item_is_done_once)
{
    static Job job;
    for (int threads = 1; threads <= 2; threads++) {
        Crew *crew = crew_create(threads);
        CHECK((crew != NULL) == (threads == 2));
        for (int loop = 0; loop < 20000; loop++) {
            int count = 1 + loop % ITEMS;
            if (loop % 1000 == 0)
                crew_begin(crew);
            crew_run(crew, work_on, &job, count, loop % 2 ? 1e9 : 1);
            for (int i = 0; i < ITEMS; i++) {
                int times = atomic_exchange(&job.done[i], 0);
                if (times != (i < count))
                    CHECK_NEAR(times, i < count, 0);
            }
        }
        crew_free(crew);
    }
}

TEST(a_crew_can_end_at_once)
{
    for (int i = 0; i < 50; i++)
        crew_free(crew_create(2));
    crew_free(NULL);
}

TESTS(NULL, NULL)
