#include "bench/bench_drawing.h"

#include <stdio.h>
#include <time.h>

#include "bench/bench_problem.h"
#include "picture/picture.h"
#include "play/view.h"

enum { DRAWING_PIXELS = 900, DRAWING_FRAMES = 31 };

static const int drawing_full[2] = {1280, 800};

/* Processor time of all threads, s: two of them draw many springs. */
static double cpu_of_all(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Median processor time of a frame of this size, from an empty paper until it
 * is shown, in ms. */
static Status time_frames(const Show *show, int width, int height, int frames,
                          double *ms, SpringCount *springs)
{
    double seconds[DRAWING_FRAMES];
    View *view = NULL;
    Status status = view_create_surface(width, height, &view);
    for (int i = 0; i < frames && !status; i++) {
        double start = cpu_of_all();
        Paper *paper = view_paper(view);
        if (!paper) {
            status = STATUS_OUT_OF_MEMORY;
            break;
        }
        *springs = show_draw(paper, show);
        status = view_show(view);
        seconds[i] = cpu_of_all() - start;
    }
    if (!status)
        *ms = 1e3 * bench_median(seconds, frames);
    view_free(view);
    return status;
}

static Status draw_size(Bench *bench, int segments, int frames)
{
    static Show show;
    static History history;
    Simulation simulation;
    SpringCount springs = {0};
    double bare = 0, full = 0;
    Options options = slides_options(segments);
    bench_progress(bench, "drawing: %d segments", segments);
    options.integrator = integrator_method("verlet");
    Status status = simulation_create(&options, NULL, NULL, &simulation);
    if (!status) {
        history_clear(&history);
        show_sample(&simulation, &history, NULL);
        show_create(&simulation, &show);
        show.pane[0].history = &history;
        show_describe(&show);
        status = time_frames(&show, drawing_full[0], drawing_full[1], frames,
                             &full, &springs);
        show.bare = true;
    }
    if (!status)
        status = time_frames(&show, DRAWING_PIXELS, DRAWING_PIXELS, frames,
                             &bare, &springs);
    if (!status) {
        bench_progress(bench, NULL);
        printf("  %8d %9ld %9ld %9.2f %9.2f\n", segments, springs.drawn,
               springs.skipped, bare, full);
        bench_csv_row(bench, "%d,%ld,%ld,%d,%.6g,%.6g", segments, springs.drawn,
                      springs.skipped, frames, bare, full);
    }
    simulation_free(&simulation);
    return status;
}

Status bench_drawing(Bench *bench)
{
    int largest = bench->quick ? 32 : 256;
    Status status = bench_csv_open(bench, "drawing",
                                   "segments,springs_drawn,springs_left_out,"
                                   "frames,bare_ms,full_ms");
    if (status)
        return status;
    printf("  the bare picture of %d x %d pixels, all of the window at "
           "%d x %d;\n"
           "  milliseconds of processor time, all threads\n"
           "  segments     drawn  left out   bare ms   full ms\n",
           DRAWING_PIXELS, DRAWING_PIXELS, drawing_full[0], drawing_full[1]);
    for (int segments = 4; segments <= largest && !status; segments *= 2)
        status = draw_size(bench, segments, bench->quick ? 5 : DRAWING_FRAMES);
    return bench_csv_close(bench, status);
}
