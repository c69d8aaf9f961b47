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
    free(round->value);
    *round = (Round){0};
}

void rounds_clear(Rounds *rounds)
{
    for (int i = 0; i < rounds->room; i++)
        free_round(&rounds->round[i]);
    free(rounds->x_tilde);
    rounds->x_tilde = NULL;
    rounds->made.count = rounds->before.count = rounds->places = 0;
    rounds->bytes = 0;
    rounds->ended = rounds->passed = false;
}

void rounds_free(Rounds *rounds)
{
    rounds_clear(rounds);
    free(rounds->round);
    free(rounds->made.row);
    free(rounds->before.row);
    free(rounds->place);
    *rounds = (Rounds){0};
}

void rounds_begin(Rounds *rounds, const Simulation *simulation)
{
    long step = simulation->steps + 1;
    bool near = rounds->step == step || rounds->step + 1 == step;
    const Records last = rounds->made;
    rounds_clear(rounds);
    rounds->made = rounds->before;
    rounds->before = last;
    rounds->before.count = near ? last.count : 0;
    rounds->step = step;
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

/* Copies x and p, if there is memory for them. */
static void keep_arrays(Rounds *rounds, Round *round, const double *x,
                        const double *p)
{
    size_t size = (size_t)rounds->size, bytes = 2 * size * sizeof *x;
    if (rounds->bytes + bytes > ROUNDS_BYTES)
        return;
    round->x = malloc(bytes);
    if (!round->x)
        return;
    round->p = round->x + size;
    rounds->bytes += bytes;
    memcpy(round->x, x, bytes / 2);
    memcpy(round->p, p, bytes / 2);
}

/* E along p of the round that is due, from the place where `at` is; nothing
 * where memory is missing. */
static void keep_line(Rounds *rounds, const Iterate *at)
{
    Round *round = &rounds->round[rounds->made.count];
    round->first = incremental_potential_reach(at);
    double pace = round->first / ROUND_PARTS;
    Along along = incremental_potential_along(at);
    round->along = along.smooth;
    rounds->made.row[rounds->made.count].slope = along.smooth.q[0];
    if (along.rough == 0 || !round->x)
        return;
    free(round->value);
    round->value = malloc(ROUND_VALUES * sizeof *round->value);
    if (!round->value) {
        free_round(round);
        return;
    }
    rounds->bytes += ROUND_VALUES * sizeof *round->value;
    for (int i = 0; i < ROUND_VALUES; i++)
        round->value[i] = along_difference(&along, i * pace);
}

/* The polynomial, or the kept values, joined by straight lines. */
static double kept_difference(const void *function, double alpha)
{
    const Round *round = function;
    if (!round->value)
        return quartic_value(&round->along, alpha);
    double place = alpha / round->first * ROUND_PARTS;
    if (!(place >= 0 && place <= ROUND_VALUES - 1))
        return NAN;
    int i = (int)place;
    double part = place - i;
    return part == 0 ? round->value[i]
                     : round->value[i] +
                           part * (round->value[i + 1] - round->value[i]);
}

/* The direction of multigrid is the way that it went from x, and E along it. */
static void keep_way(Rounds *rounds, const Newton *newton)
{
    const IncrementalPotential *E = &newton->at.E;
    Round *round = &rounds->round[rounds->made.count];
    double *u = calloc(2 * (size_t)rounds->size, sizeof *u);
    for (int i = 0; u && round->x && i < rounds->size; i++) {
        u[i] = round->x[i] - E->x_n[i];
        round->p[i] = newton->at.u[i] - u[i];
    }
    if (u && round->x) {
        double *g = u + rounds->size;
        Iterate at = {.E = *E, .u = u, .x = round->x, .g = g, .p = round->p};
        incremental_potential_gradient(E, u, round->x, g);
        keep_line(rounds, &at);
    }
    free(u);
}

/* The round that is due: where the solver is now.  Where a bound decided the
 * test, no direction was computed, and p is still that of the round before. */
static void keep_next(Rounds *rounds, const Newton *newton)
{
    int i = rounds->made.count;
    free_round(&rounds->round[i]);
    rounds->made.row[i] = newton->record;
    rounds->made.row[i].residual = newton->residual;
    rounds->made.row[i].kind = newton->kind;
    keep_arrays(rounds, &rounds->round[i], newton->at.x, newton->at.p);
    keep_line(rounds, &newton->at);
}

void rounds_look(Rounds *rounds, const Newton *newton)
{
    if (newton->record.iteration >= 0 || !make_room(rounds))
        return;
    keep_next(rounds, newton);
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
    bool at_rest = record->iteration < 0 && i == 0;
    if (at_rest || record->status == STATUS_OK)
        rounds->passed =
            newton->working == SOLVER_MULTIGRID || !newton->record.factorised;
    if (!make_room(rounds))
        return;
    if (at_rest && record->status == STATUS_OK) {
        keep_next(rounds, newton);
        rounds->ended = true;
    }
    if (record->iteration < 0)
        return;
    NewtonRecord *made = &rounds->made.row[i];
    if (record->solver == SOLVER_MULTIGRID)
        keep_way(rounds, newton);
    double slope = made->slope;
    *made = *record;
    if (record->solver == SOLVER_MULTIGRID) {
        /* It goes no line that p alone gives; what it made is shown as one. */
        made->slope = slope;
        if (record->alpha != 0)
            made->alpha = made->trials = 1;
    }
    rounds->made.count++;
    rounds->ended = record->alpha != 0 && (record->status == STATUS_RUNNING ||
                                           record->status == STATUS_OK);
    if (rounds->ended)
        keep_next(rounds, newton);
    else
        free_round(&rounds->round[i + 1]);
}

/* One more place. */
static void add_place(Rounds *rounds, int round, Line line, int trials)
{
    rounds->place[rounds->places++] = (Station){round, line, trials};
}

/* The lines of a round that has a record. */
static void add_round(Rounds *rounds, const Options *options, int i)
{
    const NewtonRecord *record = &rounds->made.row[i];
    bool searches = options->line_search != LINE_SEARCH_NONE;
    int trials =
        searches && record->trials < TRIALS_WALKED ? record->trials : 1;
    add_place(rounds, i, LINE_DO, 0);
    if (options->filter != FILTER_NONE)
        add_place(rounds, i, LINE_PROJECT, 0);
    add_place(rounds, i, LINE_SOLVE, 0);
    for (int t = 1; t < trials; t++)
        add_place(rounds, i, LINE_SEARCH, t);
    if (searches || record->alpha == 0)
        add_place(rounds, i, LINE_SEARCH, record->trials);
    if (record->alpha == 0)
        return;
    add_place(rounds, i, LINE_UPDATE, record->trials);
    add_place(rounds, i, LINE_TEST, record->trials);
}

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
    for (int i = 0; i < count; i++)
        add_round(rounds, options, i);
    if (rounds->ended) {
        add_place(rounds, count, LINE_DO, 0);
        if (options->filter != FILTER_NONE && !rounds->passed)
            add_place(rounds, count, LINE_PROJECT, 0);
        if (!rounds->passed)
            add_place(rounds, count, LINE_SOLVE, 0);
        add_place(rounds, count, LINE_TEST, 0);
    }
    add_place(rounds, count, LINE_END, 0);
}

/* Whether an update ends here. */
static bool is_milestone(const Rounds *rounds, int place)
{
    Line line = rounds->place[place].line;
    return line == LINE_START || line == LINE_TEST || line == LINE_END;
}

int rounds_walk(const Rounds *rounds, int fine, int place, int way)
{
    place += way;
    while (fine < 2 && place >= 0 && place < rounds->places &&
           !is_milestone(rounds, place))
        place += way;
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
int rounds_peak(const Rounds *rounds, double *rise)
{
    enum { FAR = 10 };
    double sum = 0;
    int round = -1;
    *rise = 0;
    for (int i = 0; i < rounds->made.count; i++) {
        sum += rounds->made.row[i].change;
        if (sum > *rise) {
            *rise = sum;
            round = i;
        }
    }
    bool far = round >= 0 && *rise > FAR * fabs(sum);
    return far ? rounds_find(rounds, round, LINE_UPDATE) : -1;
}

double rounds_extent(const Rounds *rounds)
{
    double extent = 0;
    for (int i = 0; i <= rounds->made.count && i < rounds->room; i++)
        for (int k = 0; rounds->round[i].x && k < rounds->size; k++)
            extent = fmax(extent, fabs(rounds->round[i].x[k]));
    return extent;
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
    const NewtonRecord *row = rounds->made.row;
    bool over = place < 0 || place >= rounds->places;
    const Station *at = over ? NULL : &rounds->place[place];
    const Station last = {count - 1, LINE_END,
                          count ? row[count - 1].trials : 0};
    bool given_up = !rounds->ended && count > 0;
    *trace = (Trace){.h = rounds->h,
                     .tolerance = rounds->tolerance,
                     .updates = count,
                     .record = row,
                     .updates_before = rounds->before.count,
                     .record_before = rounds->before.row,
                     .projected = -1,
                     .x_tilde = rounds->x_tilde};
    if (over) { /* its last update, and the test that ended it */
        if (count > 0)
            trace_round(rounds, &last, trace);
        trace->iteration = count - 1;
        trace->passed = rounds->passed;
        trace->given_up = given_up;
        if (rounds->ended) {
            trace->residual = row[count].residual;
            trace->kind = row[count].kind;
        }
        return NULL;
    }
    trace->line = at->line;
    trace->iteration = trace->updates = at->round;
    if (rounds->room == 0)
        return NULL;
    const Round *round = &rounds->round[at->round];
    bool end = at->line == LINE_END;
    if (at->line == LINE_START)
        return round->x;
    if (end && given_up) /* as the last round left it */
        trace_round(rounds, &last, trace);
    else if (!end || rounds->ended)
        trace_round(rounds, at, trace);
    trace->given_up =
        given_up &&
        (end || (at->round == count - 1 && at->line == LINE_SEARCH &&
                 at->trials == last.trials && row[count - 1].alpha == 0));
    bool moved =
        at->round < count && (at->line == LINE_UPDATE || at->line == LINE_TEST);
    if (moved && (at->round + 1 < count || rounds->ended))
        return round[1].x;
    return moved || end ? NULL : round->x;
}
