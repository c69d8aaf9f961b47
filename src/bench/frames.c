#include "bench/bench.h"
#include "picture/picture.h"

enum { FRAMES = 31 };

/* Median processor time of a frame of this size, in ms. */
static Status time_frames(const Show *show, int width, int height, double *ms)
{
    double spent[FRAMES];
    Paper paper;
    Status status = paper_create(width, height, &paper);
    for (int i = 0; i < FRAMES && !status; i++) {
        double start = bench_cpu();
        show_draw(&paper, show);
        spent[i] = 1e3 * (bench_cpu() - start);
    }
    if (!status)
        *ms = bench_median(spent, FRAMES);
    paper_free(&paper);
    return status;
}

Status bench_frames(bool quick)
{
    static Show show;
    static History history;
    Status status = STATUS_OK;
    double bare = 0, full = 0;
    for (int n = 4; n <= (quick ? 8 : 256) && !status; n *= 2) {
        Simulation simulation;
        Options options = slides_options(n);
        options.integrator = integrator_method("verlet") - integrator_methods;
        status = simulation_create(&options, NULL, NULL, &simulation);
        if (!status) {
            history.series = history.count = 0;
            Energy row[HISTORY_SERIES];
            history_add(&history, 0, show_sample(&simulation, row), row);
            show_create(&simulation, &show);
            show.pane[0].history = &history;
            show_describe(&show);
            status = time_frames(&show, 1280, 800, &full);
            show.bare = true;
        }
        if (!status)
            status = time_frames(&show, 900, 900, &bare);
        simulation_free(&simulation);
        if (!status)
            printf("%d,%.6g,%.6g\n", n, bare, full);
        if (n == 128)
            bench_claim("ms to draw a bare frame of 128 segments", bare, 4);
    }
    return status;
}
