#include "play/rounds.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Trials of a line search that are walked through one by one. */
enum { TRIALS_WALKED = 12 };

bool records_fit(Records *records, int count)
{
    if (count <= records->room)
        return true;
    int room = count < 16 ? 16 : 2 * count;
    NewtonRecord *row = realloc(records->row, (size_t)room * sizeof *row);
    if (!row)
        return false;
    records->row = row;
    records->room = room;
    return true;
}

static void free_round(Round *round)
{
    free(round->x);
    *round = (Round){0};
}

void rounds_clear(Rounds *rounds)
{
    for (int i = 0; i < rounds->room; i++)
        free_round(&rounds->round[i]);
    free(rounds->x_tilde);
    rounds->x_tilde = NULL;
    rounds->made.count = rounds->places = 0;
    rounds->bytes = 0;
    rounds->ended = rounds->passed = false;
}

void rounds_free(Rounds *rounds)
{
    rounds_clear(rounds);
    free(rounds->round);
    free(rounds->made.row);
    free(rounds->place);
    *rounds = (Rounds){0};
}

void rounds_begin(Rounds *rounds, const Simulation *simulation, bool all)
{
    rounds_clear(rounds);
    rounds->all = all;
    rounds->h = simulation->options.timestep;
    rounds->tolerance = simulation->options.tolerance;
    rounds->size = 2 * simulation->system.nodes;
}

/* Room for a round more and for the last one. */
static bool make_room(Rounds *rounds)
{
    int count = rounds->made.count + 2;
    if (count > rounds->room) {
        Round *round =
            realloc(rounds->round, 2 * (size_t)count * sizeof *round);
        if (!round)
            return false;
        memset(round + rounds->room, 0,
               (size_t)(2 * count - rounds->room) * sizeof *round);
        rounds->round = round;
        rounds->room = 2 * count;
    }
    return records_fit(&rounds->made, count);
}

/* ---- what is kept -------------------------------------------------------- */

/* Where E along p is no polynomial. */
static void sample(Round *round, const Iterate *at)
{
    const Along along = {.smooth = round->along, .at = at, .rough = true};
    round->sampled = round->rough && round->x;
    for (int i = 0; i < ROUND_VALUES && round->sampled; i++)
        round->value[i] =
            along_difference(&along, i * round->first / ROUND_PARTS);
}

/* E along p of the round that is due, from the place where `at` is. */
static void keep_line(Rounds *rounds, const Iterate *at)
{
    Round *round = &rounds->round[rounds->made.count];
    Along along = incremental_potential_along(at);
    round->first = incremental_potential_reach(at);
    round->along = along.smooth;
    rounds->made.row[rounds->made.count].slope = along.smooth.q[0];
    round->rough = along.rough != 0;
    round->rounds = rounds;
    if (rounds->all)
        sample(round, at);
}

/* The polynomial, or the kept values, joined by straight lines; without them
 * only what the update has told. */
static double kept_difference(const void *function, double alpha)
{
    const Round *round = function;
    if (!round->rough)
        return quartic_value(&round->along, alpha);
    if (!round->sampled && alpha == round->alpha)
        return round->change;
    round->rounds->asked = round->rounds->asked || !round->sampled;
    double place = alpha / round->first * ROUND_PARTS;
    if (!round->sampled || !(place >= 0 && place <= ROUND_VALUES - 1))
        return NAN;
    const double *value = round->value + (int)place;
    double part = place - (int)place;
    return part == 0 ? value[0] : value[0] + part * (value[1] - value[0]);
}

/* The direction of multigrid is the way that it went from x, and E along it. */
static void keep_way(Rounds *rounds, const Newton *newton)
{
    const IncrementalPotential *E = &newton->at.E;
    Round *round = &rounds->round[rounds->made.count];
    double *u = calloc(2 * (size_t)rounds->size, sizeof *u);
    if (u && round->x) {
        double *g = u + rounds->size;
        Iterate at = {.E = *E, .u = u, .x = round->x, .g = g, .p = round->p};
        for (int i = 0; i < rounds->size; i++) {
            u[i] = round->x[i] - E->x_n[i];
            round->p[i] = newton->at.u[i] - u[i];
        }
        incremental_potential_gradient(E, u, round->x, g);
        keep_line(rounds, &at);
    }
    free(u);
}

/* The round that is due: where the solver is now, if there is memory.  Where a
 * bound decided the test, no direction was computed, and p is still that of the
 * round before. */
static void keep_round(Rounds *rounds, const Newton *newton)
{
    Round *round = &rounds->round[rounds->made.count];
    NewtonRecord *record = &rounds->made.row[rounds->made.count];
    size_t size = (size_t)rounds->size;
    size_t bytes = (3 * size + ROUND_VALUES) * sizeof *round->x;
    free_round(round);
    *record = newton->record;
    record->residual = newton->residual;
    record->kind = newton->kind;
    if (rounds->bytes + bytes <= ROUNDS_BYTES)
        round->x = malloc(bytes);
    if (round->x) {
        round->p = round->x + size;
        round->u = round->p + size;
        round->value = round->u + size;
        rounds->bytes += bytes;
        memcpy(round->x, newton->at.x, size * sizeof *round->x);
        memcpy(round->p, newton->at.p, size * sizeof *round->p);
        memcpy(round->u, newton->at.u, size * sizeof *round->u);
    }
    keep_line(rounds, &newton->at);
}

void rounds_look(Rounds *rounds, const Newton *newton)
{
    if (newton->record.iteration >= 0 || !make_room(rounds))
        return;
    keep_round(rounds, newton);
    if (rounds->x_tilde) /* of the first stage of a method with several */
        return;
    rounds->x_tilde = malloc((size_t)rounds->size * sizeof(double));
    for (int i = 0; i < rounds->size && rounds->x_tilde; i++)
        rounds->x_tilde[i] = newton->at.E.x_n[i] + newton->u_tilde[i];
}

void rounds_add(Rounds *rounds, const Newton *newton,
                const NewtonRecord *record)
{
    int i = rounds->made.count;
    bool first = record->iteration < 0, passes = record->status == STATUS_OK;
    if (passes || (first && i == 0))
        rounds->passed =
            newton->working == SOLVER_MULTIGRID || !newton->record.factorised;
    if (!make_room(rounds) || (first && (i > 0 || !passes)))
        return;
    if (!first) {
        NewtonRecord *made = &rounds->made.row[i];
        bool multigrid = record->solver == SOLVER_MULTIGRID;
        if (multigrid)
            keep_way(rounds, newton);
        double slope = multigrid ? made->slope : record->slope;
        *made = *record;
        made->slope = slope;
        if (multigrid && made->alpha != 0)  /* it goes no line that p alone */
            made->alpha = made->trials = 1; /* gives; it is shown as one */
        Round *round = &rounds->round[i];
        round->alpha = record->alpha;
        round->change = record->change;
        if (record->status != STATUS_RUNNING && rounds->last && !rounds->all)
            sample(round, &(Iterate){.E = newton->at.E,
                                     .u = round->u,
                                     .x = round->x,
                                     .p = round->p});
        rounds->made.count++;
    }
    rounds->ended = first || (record->alpha != 0 &&
                              (passes || record->status == STATUS_RUNNING));
    if (rounds->ended)
        keep_round(rounds, newton);
    else
        free_round(&rounds->round[i + 1]);
}

/* ---- the listing --------------------------------------------------------- */

/* One more place. */
static void add_place(Rounds *rounds, int round, Line line, int trials)
{
    rounds->place[rounds->places++] = (Station){round, line, trials};
}

/* The lines of each round; the last one may have the test alone. */
void rounds_end(Rounds *rounds, const Options *options)
{
    int count = rounds->made.count;
    Station *place =
        realloc(rounds->place,
                ((size_t)count + 1) * (TRIALS_WALKED + 8) * sizeof *place);
    rounds->places = 0;
    if (!place)
        return;
    rounds->place = place;
    add_place(rounds, 0, LINE_START, 0);
    for (int i = 0; i < count + rounds->ended; i++) {
        const NewtonRecord *record = &rounds->made.row[i];
        bool made = i < count, solves = made || !rounds->passed;
        bool searches = made && options->line_search != LINE_SEARCH_NONE;
        bool fails = made && record->alpha == 0;
        int trials = made ? record->trials : 0;
        add_place(rounds, i, LINE_DO, 0);
        if (solves && options->filter != FILTER_NONE)
            add_place(rounds, i, LINE_PROJECT, 0);
        if (solves)
            add_place(rounds, i, LINE_SOLVE, 0);
        for (int t = 1; searches && t < trials && trials < TRIALS_WALKED; t++)
            add_place(rounds, i, LINE_SEARCH, t);
        if (searches || fails)
            add_place(rounds, i, LINE_SEARCH, trials);
        if (made && !fails)
            add_place(rounds, i, LINE_UPDATE, trials);
        if (!fails)
            add_place(rounds, i, LINE_TEST, trials);
    }
    add_place(rounds, count, LINE_END, 0);
}

int rounds_walk(const Rounds *rounds, int fine, int place, int way)
{
    for (int i = place + way; 0 <= i && i < rounds->places; i += way) {
        Line line = rounds->place[i].line;
        if (fine == 2 || line == LINE_START || line == LINE_TEST ||
            line == LINE_END)
            return i;
    }
    return place;
}

int rounds_find(const Rounds *rounds, int round, Line line)
{
    for (int i = rounds->places - 1; i >= 0; i--)
        if (rounds->place[i].round == round && rounds->place[i].line <= line)
            return i;
    return rounds->places - 1;
}

/* The sum of the changes may be off by some units in the last place of the
 * highest E; only whether it is a tenth of that is asked. */
int rounds_peak(const Rounds *rounds)
{
    enum { FAR = 10 };
    double sum = 0, rise = 0;
    int round = -1;
    for (int i = 0; i < rounds->made.count; i++) {
        sum += rounds->made.row[i].change;
        if (sum > rise) {
            rise = sum;
            round = i;
        }
    }
    bool far = round >= 0 && rise > FAR * fabs(sum);
    return far ? rounds_find(rounds, round, LINE_UPDATE) : -1;
}

/* The numbers of a round from the line on at which they are known. */
static void trace_round(const Rounds *rounds, const Station *at, Trace *trace)
{
    const Round *round = &rounds->round[at->round];
    const NewtonRecord *record = &rounds->made.row[at->round];
    bool made = at->round < rounds->made.count;
    bool solved = at->line >= LINE_SOLVE, passed = !made && rounds->passed;
    trace->x = round->x;
    trace->passed = passed && solved;
    trace->updates = at->round + (made && solved);
    trace->trials = at->trials;
    trace->accepted = made && at->trials == record->trials && record->alpha > 0;
    if (solved) {
        trace->residual = record->residual;
        trace->kind = record->kind;
    }
    if (!passed && at->line >= LINE_PROJECT)
        trace->projected = record->projected;
    if (passed || !solved)
        return;
    trace->p = round->p;
    trace->slope = record->slope;
    trace->first = round->first;
    if (!round->p)
        return;
    trace->difference = kept_difference;
    trace->function = round;
}

const double *rounds_trace(const Rounds *rounds, int place, Trace *trace)
{
    int count = rounds->made.count;
    const NewtonRecord *row = rounds->made.row, *last = row + count - 1;
    bool over = place < 0 || place >= rounds->places;
    bool given_up = !rounds->ended && count > 0;
    const Station at =
        over ? (Station){count, LINE_END, 0} : rounds->place[place];
    bool end = at.line == LINE_END, made = at.round < count;
    Station told = at;
    if (end && count > 0 && (over || given_up)) /* what has led there */
        told = (Station){count - 1, LINE_END, last->trials};
    *trace = (Trace){.line = over ? LINE_NONE : at.line,
                     .h = rounds->h,
                     .tolerance = rounds->tolerance,
                     .iteration = over ? count - 1 : at.round,
                     .updates = at.round,
                     .record = row,
                     .projected = -1,
                     .x_tilde = rounds->x_tilde};
    if (rounds->room == 0)
        return NULL;
    if (at.line != LINE_START &&
        (told.round < count || (rounds->ended && !over)))
        trace_round(rounds, &told, trace);
    if (over)
        trace->passed = rounds->passed;
    if (over && rounds->ended) { /* the test that ended it */
        trace->residual = row[count].residual;
        trace->kind = row[count].kind;
    }
    trace->given_up =
        given_up && (end || (at.line == LINE_SEARCH && at.round == count - 1 &&
                             at.trials == last->trials && last->alpha == 0));
    const Round *round = &rounds->round[at.round];
    if (end)
        return NULL;
    if (!made || (at.line != LINE_UPDATE && at.line != LINE_TEST))
        return round->x;
    return at.round + 1 < count || rounds->ended ? round[1].x : NULL;
}
