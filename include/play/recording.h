/* recording.h - the files that a run writes: frames, films, tables.
 *
 * Frames are FOLDER/frame_000000.png, ..., numbered by their steps.
 * Tables (output.h) begin at step 0; README.md of play explains their columns.
 * Nodes and springs of run 1 are numbered after those of run 0, and runs of all
 * panes from 0.  If a user goes back and changes a step, its new rows follow
 * the old ones: the last rows of a step count.  A number that is changed after
 * a step also changes the energies of this step.
 *
 * The program ffmpeg makes films of frames from a pipe, 60 frames a second; in
 * .gif 50, since .gif counts hundredths of a second. */
#pragma once

#include "picture/canvas.h"
#include "play/output.h"
#include "simulation/simulation.h"

typedef struct Film {
    const struct FilmKind *kind;
    int width, height; /* pixels of the first frame */
    long frame_count;  /* number of frames so far */
    OutputFile output;
    FILE *pipe; /* input of ffmpeg; NULL: ffmpeg does not run */
} Film;

/* Begins a film; ffmpeg starts with the first frame.
 *   name     in, the end chooses the format
 *   message  as of output_open
 *   film     out; end it with film_close in any case
 * Returns OK, INVALID_INPUT (no such format, or no ffmpeg), FILE_FAILED. */
Status film_open(const char *name, char *message, Film *film);

/* Adds a frame `times` times.  A canvas larger than the first one is cut, a
 * smaller one filled with white.  Returns OK, FILE_FAILED. */
Status film_add_frame(Film *film, const Canvas *canvas, int times);

/* Ends a film, if any.  Returns OK; FILE_FAILED, also if it has no frame. */
Status film_close(Film *film, CloseAction keep);

/* Whether a film was begun and not ended. */
static inline bool film_is_open(const Film *film)
{
    return film->output.file != NULL;
}

typedef enum RecordingTable {
    STATES_TABLE,
    LOG_TABLE,
    ENERGIES_TABLE,
    SPRINGS_TABLE,
    RECORDING_TABLE_COUNT
} RecordingTable;

enum { MAX_FRAMES = 1000000 }; /* frames have numbers of six digits */

typedef struct Recording {
    const char *folder;          /* folder of the frames, or NULL */
    long frame_count;            /* number of frames written */
    unsigned char *is_old_frame; /* [step] 1: left by an earlier run */
    Film film;
    int pane_count; /* number of panes at the start of the run */
    CsvTable table[RECORDING_TABLE_COUNT];
    bool has_tables;             /* a table is open */
    bool uses_stdout;            /* a table goes to standard output */
    char message[MESSAGE_BYTES]; /* the first failure, or "" */
} Recording;

/* Opens the frames, film and tables that the options ask for; makes the folder.
 *   recording  out; free it in any case
 * Returns OK, FILE_FAILED, OUT_OF_MEMORY, or INVALID_INPUT with a message; the
 * other functions here return the first three. */
Status recording_open(const Options *options, Recording *recording);

/* Writes the frame of a step to the folder, and `times` times to the film. */
Status recording_write_frame(Recording *recording, const Canvas *canvas,
                             long step, int times);

/* Writes the states, springs and energies of all panes at a step.
 *   energies_only  in, only the energies are written
 *   simulation     [count] in, simulation of each pane */
Status recording_write_states(Recording *recording, bool energies_only,
                              const Simulation *const *simulation, int count,
                              long step);

/* Writes a Newton iteration to the log; panes are numbered from 1. */
Status recording_write_iteration(Recording *recording,
                                 const NewtonRecord *record, int pane);

/* Closes all files.  If one has failed, all keep their ".part". */
Status recording_close(Recording *recording, CloseAction keep);

/* Writes a picture as a PNG file, whole or not at all (output.h).
 *   message  as of output_open
 * Returns OK, OUT_OF_MEMORY, FILE_FAILED (errno says why). */
Status png_file_write(const char *name, char *message, const Canvas *canvas);
