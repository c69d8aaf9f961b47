/* film.h - frames as one moving picture.
 *
 * The program ffmpeg makes it: frames go to it through a pipe, and the end of
 * the name says what it makes of them: .mp4, .webm, .gif or .apng.  All of them
 * have as many frames as were added, 60 a second; a .gif has 50, for it counts
 * time in hundredths of a second.  The file appears under its name when the
 * film is whole.
 */
#ifndef ELASTO_FILM_H
#define ELASTO_FILM_H

#include "picture/canvas.h"
#include "play/output.h"

typedef struct Film {
    const struct FilmKind *kind;
    int width, height; /* pixels; those of the first frame */
    long frames;       /* so far */
    Output output;
    FILE *pipe;         /* to ffmpeg; NULL: it does not run */
    const char *reason; /* why it failed, if errno does not say it; or NULL */
} Film;

/* Begins a film; nothing is written before the first frame.
 *   name  in, its end says the kind
 *   film  out; end it with film_close in any case
 * Returns OK, INVALID_INPUT (no such kind, or no ffmpeg: film->reason),
 * OUT_OF_MEMORY, FILE_FAILED (errno tells why). */
Status film_open(const char *name, Film *film);

/* The next frame; what is beyond the size of the first one is cut off, what is
 * missing is white.  shown: so many times, at least 1.
 * Returns OK, OUT_OF_MEMORY, FILE_FAILED (film->reason or errno). */
Status film_add(Film *film, const Canvas *canvas, int shown);

/* Ends it; OK too if it was not begun.  A film without a frame is a failure,
 * and leaves nothing.  film->reason is then still there.  Returns OK,
 * FILE_FAILED. */
Status film_close(Film *film);

/* Whether it was begun. */
static inline bool film_runs(const Film *film)
{
    return film->output.name != NULL;
}

#endif
