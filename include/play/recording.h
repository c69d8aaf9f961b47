/* recording.h - what a run leaves in files: frames, films, tables.
 *
 *   frames  FOLDER/frame_000000.png, ...: the number is that of the step;
 *           frames of an earlier run that this one does not reach stay there
 * Tables (output.h) begin at step 0:
 *   states    step,time,node,x,y,vx,vy of every node at every step; nodes of
 *             run 0 first, those of run 1 numbered on
 *   log       a row a Newton update, see newton.h
 *   energies  the ledger (simulation.h) of every run at every step; runs of
 *             all panes are counted from 0
 *   springs   step,time,spring,i,j,whole,rest,strain,plastic,flowed: its nodes,
 *             as in the states; 1 where it is not broken; rest length, m;
 *             Green's strain |d|^2/rest^2 - 1; ep and kappa of plasticity.h
 * Of several panes states, log and springs have a column that says which, from
 * 1, and steps are those that they have together.  Where somebody goes back and
 * changes something, the rows of the new steps follow those that were written
 * before: the last rows of a step count.  A number that changes after a step
 * changes the energies of this step: their row follows, too.
 *
 * Films are made by the program ffmpeg: frames go to it through a pipe, and the
 * end of the name says what it makes of them: .mp4, .webm, .gif or .apng.  All
 * of them have as many frames as were added, 60 a second; a .gif has 50, for it
 * counts time in hundredths of a second.
 */
#ifndef ELASTO_RECORDING_H
#define ELASTO_RECORDING_H

#include "picture/canvas.h"
#include "play/output.h"
#include "run/simulation.h"

typedef struct Film {
    const struct FilmKind *kind;
    int width, height; /* pixels; those of the first frame */
    long frames;       /* number of frames so far */
    Output output;
    FILE *pipe; /* to ffmpeg; NULL: it does not run */
} Film;

/* Begins a film; the file begins with the first frame.
 *   name  in, its end says the kind
 *   message  as of output_open
 *   film  out; end it with film_close in any case
 * Returns OK, INVALID_INPUT (no such kind, or no ffmpeg), FILE_FAILED. */
Status film_open(const char *name, char *message, Film *film);

/* Adds a frame `shown` times.  Pixels beyond the size of the first frame are
 * cut off, missing ones are white.  Returns OK, FILE_FAILED. */
Status film_add(Film *film, const Canvas *canvas, int shown);

/* Ends a film; OK also if it does not run.  A film without frames is a failure
 * and leaves no file.  Returns OK, FILE_FAILED. */
Status film_close(Film *film, Keep keep);

static inline bool film_runs(const Film *film)
{
    return film->output.file != NULL;
}

typedef enum RecordingTable {
    RECORDING_STATES,
    RECORDING_LOG,
    RECORDING_ENERGIES,
    RECORDING_SPRINGS,
    RECORDING_TABLES
} RecordingTable;

enum { FRAMES_MOST = 1000000 }; /* numbers of six digits */

typedef struct Recording {
    const char *folder;   /* folder of the frames, or NULL */
    long frames;          /* number of frames written */
    unsigned char *older; /* [FRAMES_MOST] 1: the frame of this step is
                             that of an earlier run; or NULL */
    long stayed[3];       /* at the end: number of those that are left,
                             the first, the last */
    Film film;
    int panes;                     /* number of panes at the start */
    Table table[RECORDING_TABLES]; /* the open ones are written */
    bool tables;                   /* a table is open */
    bool standard;                 /* a table goes to standard output */
    char message[OUTPUT_MESSAGE];  /* the first failure, or "" */
} Recording;

/* Opens what options->frames, film and the tables ask for; makes the folders.
 *   recording  out; close it in any case
 * Returns OK, FILE_FAILED, OUT_OF_MEMORY, as all functions here do, or
 * INVALID_INPUT; the message says why. */
Status recording_open(const Options *options, int panes, Recording *recording);

/* Writes a frame, if the options ask for frames; it stands `shown` times in a
 * film. */
Status recording_frame(Recording *recording, const Canvas *canvas, long step,
                       int shown);

/* States and energies of `count` simulations now, if they are asked for; nodes
 * and runs of the second follow those of the first.
 *   ledger  in, whether the energies alone are written */
Status recording_states(Recording *recording, bool ledger,
                        const Simulation *const *simulation, int count,
                        long step);

/* Adds a row to the log, if the options ask for a log. */
Status recording_update(Recording *recording, const NewtonRecord *record,
                        int pane);

/* Closes everything, whatever happened before.  Where one of the files fails,
 * or has failed, none gets its name. */
Status recording_close(Recording *recording, Keep keep);

/* One picture as a PNG file, whole or not at all (output.h).
 * Returns OK, OUT_OF_MEMORY, FILE_FAILED (errno tells why). */
Status png_file_write(const char *name, char *message, const Canvas *canvas);

#endif
