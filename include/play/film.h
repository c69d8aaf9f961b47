/* film.h - frames as one moving picture.
 *
 *   .apng  an animated PNG, written with libpng alone; every browser plays it
 *   .mp4, .gif  frames are piped to the program ffmpeg, if it is there
 * The file appears under its name when the film is whole.
 */
#ifndef ELASTO_FILM_H
#define ELASTO_FILM_H

#include <stddef.h>

#include "picture/canvas.h"
#include "play/output.h"

typedef enum FilmKind { FILM_APNG, FILM_FFMPEG } FilmKind;

typedef struct Film {
    FilmKind kind;
    int width, height; /* pixels; those of the first frame */
    long frames;       /* so far */
    double rate;       /* frames a second */
    Output output;
    long header;       /* where the acTL chunk of an animated PNG is */
    unsigned sequence; /* of its next chunk */
    uint8_t *last;     /* [3 width height] the frame before, RGB */
    uint8_t *next;     /* the same, to compare with */
    bool gif;          /* ffmpeg is to write that */
    int process, pipe; /* of ffmpeg; 0, -1: none */
} Film;

/* Begins a film; nothing is written before the first frame.
 *   name     in, its end says the kind
 *   rate     frames a second
 *   film     out; end it with film_close in any case
 *   message  [size] out, what to do, after INVALID_INPUT
 * Returns OK, INVALID_INPUT (no such kind, or no ffmpeg), OUT_OF_MEMORY,
 * FILE_FAILED (errno tells why). */
Status film_open(const char *name, double rate, Film *film, char *message,
                 size_t size);

/* One more frame; what is beyond the size of the first one is cut off, what is
 * missing is white.  shown: for how many frames' time, at least 1.
 * Returns OK, OUT_OF_MEMORY, FILE_FAILED. */
Status film_add(Film *film, const Canvas *canvas, int shown);

/* Ends it; without any frame there is no file.  Returns OK, FILE_FAILED. */
Status film_close(Film *film);

/* Throws it away. */
void film_discard(Film *film);

/* Whether it was begun. */
bool film_runs(const Film *film);

#endif
