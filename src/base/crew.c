#include "base/crew.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

/* Chunks of a loop; more of them share it more evenly and cost more claims. */
enum { CHUNKS = 8 };

/* Pauses before a thread that waits lets others run, and before it sleeps. */
enum { PAUSES = 2000, YIELDS = 50 };

/* ns: loops shorter than this are not shared; a sleeper is woken for this. */
static const double WORTH_SHARING = 6e3, WORTH_WAKING = 3e4;

/* What was lost is looked at every millisecond.  Where it is more than this
 * share, the crew works alone for so many times as long. */
static const double LOOK_EVERY = 1e-3, LOST_SHARE = 0.1, ALONE_FOR = 32;

struct Crew {
    pthread_t thread;
    pthread_mutex_t mutex;
    pthread_cond_t wake;
    atomic_bool asleep, leave;
    atomic_uint_least64_t ticket; /* number of the loop, then the next item */
    _Atomic(CrewWork *) work;
    _Atomic(const void *) job;
    atomic_int count, chunk;
    atomic_int done;    /* items that the second thread has finished */
    double looked, cpu; /* s, clocks at the last look */
    double waited;      /* s, since then, for a chunk of the second thread */
    double alone_until; /* s */
};

static double clock_seconds(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void pause_shortly(void)
{
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
}

/* Does chunks of this loop until none is left, or another one has begun;
 * returns how many items. */
static int take_chunks(Crew *crew, uint32_t loop, bool second)
{
    int items = 0;
    for (;;) {
        CrewWork *work = atomic_load(&crew->work);
        const void *job = atomic_load(&crew->job);
        int count = atomic_load(&crew->count), size = atomic_load(&crew->chunk);
        uint_least64_t ticket = atomic_load(&crew->ticket);
        if ((uint32_t)(ticket >> 32) != loop ||
            (uint32_t)ticket >= (uint32_t)count)
            return items;
        int first = (int)(uint32_t)ticket;
        uint_least64_t next = ticket + (uint32_t)size;
        if (!atomic_compare_exchange_strong(&crew->ticket, &ticket, next))
            continue;
        int end = first + size < count ? first + size : count;
        work(job, first, end);
        items += end - first;
        if (second)
            atomic_fetch_add(&crew->done, end - first);
    }
}

static uint32_t current_loop(Crew *crew)
{
    return (uint32_t)(atomic_load(&crew->ticket) >> 32);
}

/* Waits for another loop than this one: awake for a while, then asleep. */
static uint32_t wait_for_loop(Crew *crew, uint32_t loop)
{
    for (int i = 0; i < YIELDS; i++) {
        for (int j = 0; j < PAUSES / 10; j++) {
            if (current_loop(crew) != loop || atomic_load(&crew->leave))
                return current_loop(crew);
            pause_shortly();
        }
        sched_yield();
    }
    pthread_mutex_lock(&crew->mutex);
    atomic_store(&crew->asleep, true);
    while (atomic_load(&crew->asleep) && !atomic_load(&crew->leave))
        pthread_cond_wait(&crew->wake, &crew->mutex);
    atomic_store(&crew->asleep, false);
    pthread_mutex_unlock(&crew->mutex);
    return current_loop(crew);
}

static void *second_thread(void *argument)
{
    Crew *crew = argument;
    uint32_t loop = 0;
    while (!atomic_load(&crew->leave)) {
        loop = wait_for_loop(crew, loop);
        take_chunks(crew, loop, true);
    }
    return NULL;
}

/* Processors that this process may use. */
static int crew_processors(void)
{
#if defined(__linux__)
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) == 0)
        return CPU_COUNT(&set);
#endif
    return (int)sysconf(_SC_NPROCESSORS_ONLN);
}

Crew *crew_create(int threads)
{
    const char *limit = getenv("ELASTO_THREADS");
    if (threads == 0)
        threads = limit ? atoi(limit) : crew_processors();
    Crew *crew = threads > 1 ? calloc(1, sizeof *crew) : NULL;
    if (!crew)
        return NULL;
    pthread_mutex_init(&crew->mutex, NULL);
    pthread_cond_init(&crew->wake, NULL);
    if (pthread_create(&crew->thread, NULL, second_thread, crew)) {
        pthread_cond_destroy(&crew->wake);
        pthread_mutex_destroy(&crew->mutex);
        free(crew);
        return NULL;
    }
    return crew;
}

static void wake_crew(Crew *crew)
{
    pthread_mutex_lock(&crew->mutex);
    atomic_store(&crew->asleep, false);
    pthread_cond_signal(&crew->wake);
    pthread_mutex_unlock(&crew->mutex);
}

void crew_free(Crew *crew)
{
    if (!crew)
        return;
    atomic_store(&crew->leave, true);
    wake_crew(crew);
    pthread_join(crew->thread, NULL);
    pthread_cond_destroy(&crew->wake);
    pthread_mutex_destroy(&crew->mutex);
    free(crew);
}

/* Time that neither thread has worked: the caller was not run, or waited for a
 * chunk that the second thread had begun. */
static void crew_look(Crew *crew)
{
    double now = clock_seconds(CLOCK_MONOTONIC), since = now - crew->looked;
    if (since < LOOK_EVERY)
        return;
    double cpu = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
    double lost = since - (cpu - crew->cpu) + crew->waited;
    if (lost > LOST_SHARE * since)
        crew->alone_until = now + ALONE_FOR * since;
    crew->looked = now;
    crew->cpu = cpu;
    crew->waited = 0;
}

void crew_begin(Crew *crew)
{
    if (!crew)
        return;
    crew->looked = clock_seconds(CLOCK_MONOTONIC);
    crew->cpu = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
    crew->waited = 0;
}

/* Until the second thread has done all that it took.  Returns for how long that
 * has been waited, in seconds. */
static double wait_for_items(Crew *crew, int items)
{
    for (int i = 0; i < PAUSES; i++) {
        if (atomic_load(&crew->done) == items)
            return 0;
        pause_shortly();
    }
    double start = clock_seconds(CLOCK_MONOTONIC);
    while (atomic_load(&crew->done) != items)
        sched_yield();
    return clock_seconds(CLOCK_MONOTONIC) - start;
}

void crew_run(Crew *crew, CrewWork *work, const void *job, int count,
              double cost)
{
    if (!crew || cost < WORTH_SHARING || count < 2 ||
        (crew->alone_until > 0 &&
         clock_seconds(CLOCK_MONOTONIC) < crew->alone_until)) {
        work(job, 0, count);
        return;
    }
    if (crew->alone_until > 0) {
        crew->alone_until = 0;
        crew_begin(crew);
    }
    uint32_t loop = current_loop(crew) + 1;
    atomic_store(&crew->ticket, (uint_least64_t)loop << 32 | 0xffffffff);
    atomic_store(&crew->work, work);
    atomic_store(&crew->job, job);
    atomic_store(&crew->count, count);
    atomic_store(&crew->chunk, (count + CHUNKS - 1) / CHUNKS);
    atomic_store(&crew->done, 0);
    loop++;
    atomic_store(&crew->ticket, (uint_least64_t)loop << 32);
    if (cost > WORTH_WAKING && atomic_load(&crew->asleep))
        wake_crew(crew);
    int mine = take_chunks(crew, loop, false);
    crew->waited += wait_for_items(crew, count - mine);
    crew_look(crew);
}
