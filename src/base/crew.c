#include "base/crew.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/clock.h"

/* Chunks of a loop; more of them share it more evenly and cost more claims. */
enum { CHUNKS = 8 };

/* Looks of a thread that waits before it lets others run, and how often it does
 * so before it sleeps. */
enum { LOOKS = 200, YIELDS = 50 };

/* ns: loops shorter than this are not shared; a sleeper is woken for this. */
static const double WORTH_SHARING = 6e3, WORTH_WAKING = 3e4;

/* s: who is waited for so much longer than the whole loop takes is a thread
 * that the system does not run.  Then the caller works alone for so many times
 * as long as it has waited. */
static const double LATE = 5e-5, ALONE_FOR = 100;

struct Crew {
    pthread_t thread;
    pthread_mutex_t mutex;
    pthread_cond_t wake;
    atomic_bool asleep, leave;
    atomic_int left; /* chunks that nobody has taken; below 0 is none, too */
    atomic_int done; /* that the second thread has finished */
    CrewWork *work; /* of the loop that they belong to, written before `left` */
    const void *job;
    int count, chunks;
    double alone_until; /* s */
};

static void pause_shortly(void)
{
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
}

/* Does chunks until none is left; returns how many.  Who has one may read the
 * loop, for that cannot end before. */
static int take_chunks(Crew *crew)
{
    int chunks = 0;
    for (int c; (c = atomic_fetch_sub(&crew->left, 1) - 1) >= 0; chunks++) {
        long first = (long)c * crew->count / crew->chunks;
        long end = (long)(c + 1) * crew->count / crew->chunks;
        crew->work(crew->job, (int)first, (int)end);
    }
    return chunks;
}

/* Awake for a while, then asleep. */
static void wait_for_chunks(Crew *crew)
{
    for (int i = 0; i < YIELDS * LOOKS; i++) {
        if (atomic_load(&crew->left) > 0 || atomic_load(&crew->leave))
            return;
        pause_shortly();
        if (i % LOOKS == LOOKS - 1)
            sched_yield();
    }
    pthread_mutex_lock(&crew->mutex);
    atomic_store(&crew->asleep, true);
    while (atomic_load(&crew->asleep) && !atomic_load(&crew->leave))
        pthread_cond_wait(&crew->wake, &crew->mutex);
    pthread_mutex_unlock(&crew->mutex);
}

static void *second_thread(void *argument)
{
    Crew *crew = argument;
    while (!atomic_load(&crew->leave)) {
        wait_for_chunks(crew);
        atomic_fetch_add(&crew->done, take_chunks(crew));
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
    if (pthread_create(&crew->thread, NULL, second_thread, crew) == 0)
        return crew;
    pthread_cond_destroy(&crew->wake);
    pthread_mutex_destroy(&crew->mutex);
    free(crew);
    return NULL;
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

/* Until the second thread has done its chunks, which takes some ns at most
 * where it is run. */
static void wait_for_others(Crew *crew, int chunks, double most)
{
    double start = clock_now();
    for (int i = 0; atomic_load(&crew->done) != chunks; i++) {
        pause_shortly();
        if (i % LOOKS == LOOKS - 1)
            sched_yield();
    }
    double now = clock_now();
    if (now - start > LATE + 1e-9 * most)
        crew->alone_until = now + ALONE_FOR * (now - start);
}

void crew_run(Crew *crew, CrewWork *work, const void *job, int count,
              double cost)
{
    if (!crew || cost < WORTH_SHARING || count < 2 ||
        (crew->alone_until > 0 && clock_now() < crew->alone_until)) {
        work(job, 0, count);
        return;
    }
    crew->alone_until = 0;
    crew->work = work;
    crew->job = job;
    crew->count = count;
    crew->chunks = count < CHUNKS ? count : CHUNKS;
    atomic_store(&crew->done, 0);
    atomic_store(&crew->left, crew->chunks);
    if (cost > WORTH_WAKING && atomic_load(&crew->asleep))
        wake_crew(crew);
    wait_for_others(crew, crew->chunks - take_chunks(crew), cost);
}
