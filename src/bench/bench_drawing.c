#include "bench/bench_drawing.h"

#include <stdio.h>

#include "bench/bench_problem.h"
#include "picture/draw.h"
#include "play/view.h"

enum { DRAWING_PIXELS = 900, DRAWING_FRAMES = 31 };

/* Time of each frame, from an empty paper until it is shown. */
static Status time_frames(View *view, const Simulation *simulation,
                          const Hud *hud, int frames, double *seconds,
                          SpringCount *springs)
{
    Status status = STATUS_OK;
    for (int i = 0; i < frames && !status; i++) {
        double start = bench_clock();
        Paper *paper = view_paper(view);
        if (!paper)
            return STATUS_OUT_OF_MEMORY;
        *springs = draw_frame(paper, simulation, hud);
        status = view_show(view);
        seconds[i] = bench_clock() - start;
    }
    return status;
}

static Status draw_size(Bench *bench, int segments, int frames)
{
    static Hud hud;
    double seconds[DRAWING_FRAMES];
    Simulation simulation;
    SpringCount springs = {0};
    View *view = NULL;
    Options options = slides_options(segments);
    bench_progress(bench, "drawing: %d segments", segments);
    options.integrator = integrator_method("verlet");
    Status status = simulation_create(&options, NULL, NULL, &simulation);
    if (!status)
        status = view_create_surface(DRAWING_PIXELS, DRAWING_PIXELS, &view);
    if (!status) {
        hud_create(&hud);
        hud_sample(&hud, &simulation);
        status =
            time_frames(view, &simulation, &hud, frames, seconds, &springs);
    }
    if (!status) {
        double ms = 1e3 * bench_median(seconds, frames);
        bench_progress(bench, NULL);
        printf("  %8d %9ld %9ld %9.2f\n", segments, springs.drawn,
               springs.skipped, ms);
        bench_csv_row(bench, "%d,%ld,%ld,%d,%.6g", segments, springs.drawn,
                      springs.skipped, frames, ms);
    }
    view_free(view);
    simulation_free(&simulation);
    return status;
}

Status bench_drawing(Bench *bench)
{
    int largest = bench->quick ? 32 : 256;
    Status status = bench_csv_open(bench, "drawing",
                                   "segments,springs_drawn,springs_left_out,"
                                   "frames,frame_ms");
    if (status)
        return status;
    printf("  %d x %d pixels, springs below 2 pixels are not all drawn\n"
           "  segments     drawn  left out  ms/frame\n",
           DRAWING_PIXELS, DRAWING_PIXELS);
    for (int segments = 4; segments <= largest && !status; segments *= 2)
        status = draw_size(bench, segments, bench->quick ? 5 : DRAWING_FRAMES);
    return bench_csv_close(bench, status);
}
