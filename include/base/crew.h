/* crew.h - a second thread for short loops.
 *
 * Work is cut into chunks that both threads take from one counter, so a second
 * thread that the system does not run is never waited for, only a chunk that
 * it has begun.  Where the machine is busy, that still costs: after a long wait
 * the caller works alone for a while.
 *
 * What a loop computes must not depend on who did which chunk.
 */
#ifndef ELASTO_CREW_H
#define ELASTO_CREW_H

#include <stdbool.h>

typedef struct Crew Crew;

/* Does items first ... end - 1 of a loop. */
typedef void CrewWork(const void *job, int first, int end);

/* Starts the second thread.
 *   threads  1 or 2; 0: as many as there are processors, but at most what the
 *            environment variable ELASTO_THREADS says
 * NULL: the caller works alone, which every function here accepts. */
Crew *crew_create(int threads);
void crew_free(Crew *crew);

/* Calls work for all of 0 ... count - 1, on both threads where cost, in
 * nanoseconds of one thread, makes it worth the while. */
void crew_run(Crew *crew, CrewWork *work, const void *job, int count,
              double cost);

#endif
