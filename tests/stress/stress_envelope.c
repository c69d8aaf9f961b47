/* Where the default square converges: time step by stiffness by stretch, and
 * a picture of that.
 */
#include "stress.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "picture/canvas.h"
#include "picture/text.h"
#include "play/recording.h"

double envelope_h(int i)
{
    return pow(10, 0.5 * i - 9);
}

double envelope_k(int i)
{
    return pow(10, i - 6);
}

double envelope_stretch(int i)
{
    static const double stretch[ENVELOPE_STRETCH] = {1e-6, 1e-3, 0.1, 0.5,
                                                     1.4,  10,   1e3, 1e6};
    return stretch[i];
}

char envelope_cell(Solver solver, int stretch, int k, int h, Tally *tally,
                   char *reason)
{
    char line[160];
    Case c = {.tally = tally, .reason = reason};
    Status status = STATUS_OK;
    snprintf(line, sizeof line,
             "--solver %s --stretch %g --stiffness %g --timestep %.17g",
             solver_name(solver), envelope_stretch(stretch), envelope_k(k),
             envelope_h(h));
    if (case_open(&c, line))
        for (int step = 0; step < 3 && case_steps(&c, 1); step++)
            status = c.watch.status ? c.watch.status : status;
    bool undone = c.run && c.run->newton->counters.iterations == 0;
    if (case_close(&c))
        return status ? 'r' : undone ? 'n' : 'c';
    size_t used = strlen(reason);
    snprintf(reason + used, 512 - used, " (%s)", line);
    return 'w';
}

double envelope_share(const Envelope *envelope, Solver solver)
{
    int cells = 0, converged = 0;
    for (int s = 0; s < ENVELOPE_STRETCH; s++)
        for (int k = 0; k < ENVELOPE_K && envelope_stretch(s) >= 0.1; k++)
            for (int h = 0; h < ENVELOPE_H; h++) {
                cells += envelope->verdict[solver][s][k][h] != 'n';
                converged += envelope->verdict[solver][s][k][h] == 'c';
            }
    return (double)converged / cells;
}

/* A row for each stretch and stiffness: the verdicts of all time steps. */
bool envelope_write(const char *name, const Envelope *envelope)
{
    FILE *file = fopen(name, "w");
    if (!file)
        return false;
    fputs("solver,stretch,stiffness,verdicts from h = 1e-9 to 1e3\n", file);
    for (int solver = 0; solver < SOLVER_COUNT; solver++)
        for (int s = 0; s < ENVELOPE_STRETCH; s++)
            for (int k = 0; k < ENVELOPE_K; k++)
                fprintf(file, "%s,%g,%g,%.*s\n", solver_name((Solver)solver),
                        envelope_stretch(s), envelope_k(k), ENVELOPE_H,
                        envelope->verdict[solver][s][k]);
    return fclose(file) == 0;
}

bool envelope_read(const char *name, Envelope *envelope)
{
    char line[128];
    FILE *file = fopen(name, "r");
    bool good = file && fgets(line, sizeof line, file);
    for (int i = 0; good && i < SOLVER_COUNT * ENVELOPE_STRETCH * ENVELOPE_K;
         i++) {
        good = fgets(line, sizeof line, file) && strrchr(line, ',');
        const char *verdicts = good ? strrchr(line, ',') + 1 : "";
        good = good && strlen(verdicts) == ENVELOPE_H + 1;
        if (good)
            memcpy(envelope->verdict[0][0][0] + (ptrdiff_t)i * ENVELOPE_H,
                   verdicts, ENVELOPE_H);
    }
    if (file)
        fclose(file);
    return good;
}

/* Pixels: cells, and around each panel room for its numbers. */
enum {
    LETTERS = 20, /* pixels an em */
    CELL = 12,
    PANELS_ACROSS = 4,
    LEFT = 90,
    TOP = 120,
    GAP_X = 34,
    GAP_Y = 84,
    WIDTH = CELL * ENVELOPE_H,
    HEIGHT = CELL * ENVELOPE_K
};

static const Colour white = 0xffffffff, ink = 0xff222222;

/* Also told apart without colours: from light to dark. */
static Colour verdict_colour(char verdict)
{
    return verdict == 'c'   ? 0xffb4dfc0
           : verdict == 'n' ? 0xff9c92c4
           : verdict == 'r' ? 0xffe08a1e
                            : 0xff7a0019;
}

/* The worse of both solvers. */
static char worse(const Envelope *envelope, int s, int k, int h)
{
    static const char order[] = "cnrw";
    const char *worst = order;
    for (int solver = 0; solver < SOLVER_COUNT; solver++) {
        const char *verdict = strchr(order, envelope->verdict[solver][s][k][h]);
        worst = verdict > worst ? verdict : worst;
    }
    return *worst;
}

/* One line of words; y is its upper edge. */
static void write_words(Text *words, Canvas *canvas, double x, double y,
                        Align align, const char *text)
{
    const TextStyle style = {FACE_REGULAR, LETTERS, ink, false};
    text_draw(words, canvas, &style, x, y, align, text);
}

static void draw_panel(const Envelope *envelope, int s, Text *words,
                       Canvas *canvas)
{
    char text[40];
    int x = LEFT + s % PANELS_ACROSS * (WIDTH + GAP_X);
    int y = TOP + s / PANELS_ACROSS * (HEIGHT + GAP_Y);
    for (int k = 0; k < ENVELOPE_K; k++)
        for (int h = 0; h < ENVELOPE_H; h++)
            canvas_rectangle(
                canvas, x + CELL * h, y + CELL * (ENVELOPE_K - 1 - k), CELL - 1,
                CELL - 1, verdict_colour(worse(envelope, s, k, h)));
    snprintf(text, sizeof text, "stretch %g", envelope_stretch(s));
    write_words(words, canvas, x + WIDTH / 2, y - LETTERS - 10, ALIGN_CENTRE,
                text);
    for (int h = 0; h < ENVELOPE_H; h += 12) {
        snprintf(text, sizeof text, "%.0e", envelope_h(h));
        write_words(words, canvas, x + CELL * h + CELL / 2, y + HEIGHT + 4,
                    h == 0                 ? ALIGN_LEFT
                    : h + 12 >= ENVELOPE_H ? ALIGN_RIGHT
                                           : ALIGN_CENTRE,
                    text);
    }
    for (int k = 0; k < ENVELOPE_K && s % PANELS_ACROSS == 0; k += 7) {
        snprintf(text, sizeof text, "%.0e", envelope_k(k));
        write_words(words, canvas, x - 8,
                    y + CELL * (ENVELOPE_K - 1 - k) + (CELL - LETTERS) / 2 - 2,
                    ALIGN_RIGHT, text);
    }
}

static void draw_legend(Text *words, Canvas *canvas)
{
    const char *texts[] = {"converged", "too loose a tolerance: nothing done",
                           "reported", "wrong"};
    int x = LEFT;
    const TextStyle style = {FACE_REGULAR, LETTERS, ink, false};
    write_words(words, canvas, x, 12, ALIGN_LEFT,
                "Three steps of the default square, the worse of both solvers: "
                "time step (s, across) by stiffness (J/m^2, up)");
    for (int i = 0; i < 4; i++) {
        canvas_rectangle(canvas, x, 50, 24, 24, verdict_colour("cnrw"[i]));
        write_words(words, canvas, x + 34, 62 - LETTERS / 2 - 3, ALIGN_LEFT,
                    texts[i]);
        x += 34 + text_width(words, &style, texts[i]) + 40;
    }
}

bool envelope_draw(const char *name, const Envelope *envelope)
{
    Canvas canvas;
    Text *words = NULL;
    int rows = ENVELOPE_STRETCH / PANELS_ACROSS;
    bool good = canvas_create(LEFT + PANELS_ACROSS * (WIDTH + GAP_X),
                              TOP + rows * (HEIGHT + GAP_Y) - GAP_Y / 2,
                              &canvas) == STATUS_OK;
    good = text_create(&words) == STATUS_OK && good;
    if (good) {
        canvas_clear(&canvas, white);
        draw_legend(words, &canvas);
        for (int s = 0; s < ENVELOPE_STRETCH; s++)
            draw_panel(envelope, s, words, &canvas);
        good = png_file_write(name, &canvas) == STATUS_OK;
    }
    text_free(words);
    canvas_free(&canvas);
    return good;
}
