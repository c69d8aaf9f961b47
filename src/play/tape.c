#include "play/tape.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Trials of a line search that are walked through one by one. */
enum { TRIALS_WALKED = 12 };

static size_t array_bytes(const Tape *tape)
{
    return (size_t)tape->size * sizeof(double);
}

static void free_round(TapeRound *round)
{
    free(round->x);
    free(round->p);
    free(round->value);
    *round = (TapeRound){0};
}

void tape_clear(Tape *tape)
{
    for (int i = 0; i < tape->room; i++)
        free_round(&tape->round[i]);
    tape->count = tape->before = tape->places = 0;
    tape->bytes = 0;
    tape->ended = tape->tilde = tape->passed = tape->open = false;
}

void tape_free(Tape *tape)
{
    tape_clear(tape);
    free(tape->round);
    free(tape->record);
    free(tape->record_before);
    free(tape->x_tilde);
    free(tape->scratch);
    free(tape->place);
    *tape = (Tape){0};
}

/* The records of the last step become those before this one. */
static void turn_over(Tape *tape)
{
    NewtonRecord *record = tape->record_before;
    int room = tape->before_room, count = tape->count;
    if (!tape->record)
        return;
    tape->record_before = tape->record;
    tape->before_room = tape->room;
    tape->record = record;
    if (room < tape->room) {
        NewtonRecord *larger =
            realloc(record, (size_t)tape->room * sizeof *larger);
        if (!larger) { /* the old ones serve; nothing is drawn in grey */
            tape->record = tape->record_before;
            tape->record_before = record;
            tape->before_room = room;
            count = 0;
        } else {
            tape->record = larger;
        }
    }
    tape_clear(tape);
    tape->before = count;
}

Status tape_begin(Tape *tape, const Simulation *simulation)
{
    int size = 2 * simulation->system.nodes;
    long step = simulation->steps + 1;
    bool near = tape->step == step || tape->step + 1 == step;
    turn_over(tape);
    if (!near)
        tape->before = 0;
    tape->step = step;
    tape->h = simulation->options.timestep;
    tape->tolerance = simulation->options.tolerance;
    tape->open = true;
    if (tape->size == size && tape->scratch)
        return STATUS_OK;
    free(tape->x_tilde);
    free(tape->scratch);
    tape->size = size;
    tape->x_tilde = calloc((size_t)size, sizeof(double));
    tape->scratch = calloc(2 * (size_t)size, sizeof(double));
    if (tape->x_tilde && tape->scratch)
        return STATUS_OK;
    tape->size = 0;
    return STATUS_OUT_OF_MEMORY;
}

/* Room for a round more and for the last one. */
static bool make_room(Tape *tape)
{
    if (tape->count + 2 <= tape->room)
        return true;
    int room = tape->room ? 2 * tape->room : 16;
    TapeRound *round = realloc(tape->round, (size_t)room * sizeof *round);
    if (!round)
        return false;
    memset(round + tape->room, 0, (size_t)(room - tape->room) * sizeof *round);
    tape->round = round;
    NewtonRecord *record = realloc(tape->record, (size_t)room * sizeof *record);
    if (!record)
        return false;
    tape->record = record;
    tape->room = room;
    return true;
}

/* Copies x and p, if there is memory for them. */
static void keep_arrays(Tape *tape, TapeRound *round, const double *x,
                        const double *p)
{
    size_t bytes = array_bytes(tape);
    if (tape->bytes + 2 * bytes > TAPE_BYTES)
        return;
    round->x = malloc(bytes);
    round->p = malloc(bytes);
    if (!round->x || !round->p) {
        free_round(round);
        return;
    }
    tape->bytes += 2 * bytes;
    memcpy(round->x, x, bytes);
    memcpy(round->p, p, bytes);
}

/* E along p, from the place where `at` is; nothing where memory is missing. */
static void keep_line(Tape *tape, TapeRound *round, const Iterate *at)
{
    round->first = incremental_potential_reach(at);
    double pace = round->first / TAPE_PARTS;
    Along along = incremental_potential_along(at);
    round->along = along.smooth;
    round->slope = along.smooth.q[0];
    if (along.rough == 0 || !round->x)
        return;
    free(round->value);
    round->value = malloc(TAPE_VALUES * sizeof *round->value);
    if (!round->value) {
        free_round(round);
        return;
    }
    tape->bytes += TAPE_VALUES * sizeof *round->value;
    for (int i = 0; i < TAPE_VALUES; i++)
        round->value[i] = along_difference(&along, i * pace);
}

/* The polynomial, or the kept values, joined by straight lines. */
static double kept_difference(const void *function, double alpha)
{
    const TapeRound *round = function;
    if (!round->value)
        return quartic_value(&round->along, alpha);
    double place = alpha / round->first * TAPE_PARTS;
    if (!(place >= 0 && place <= TAPE_VALUES - 1))
        return NAN;
    int i = (int)place;
    double part = place - i;
    return part == 0 ? round->value[i]
                     : round->value[i] +
                           part * (round->value[i + 1] - round->value[i]);
}

/* E along p of a round, if it was kept. */
static void show_line(const TapeRound *round, Trace *trace)
{
    trace->first = round->first;
    if (!round->p)
        return;
    trace->difference = kept_difference;
    trace->function = round;
}

/* x and p of a round where p is known by what it led to, the present iterate:
 * the first one, where x is x_n, and those of multigrid. */
static void keep_way(Tape *tape, const Newton *newton,
                     const NewtonRecord *record)
{
    const IncrementalPotential *E = &newton->at.E;
    TapeRound *round = &tape->round[tape->count];
    double *u = tape->scratch, *p = tape->scratch + tape->size;
    bool first = record->iteration == 0;
    if (!first && !round->x)
        return;
    for (int i = 0; i < tape->size; i++) {
        u[i] = first ? 0 : round->x[i] - E->x_n[i];
        p[i] = record->alpha == 0 ? newton->at.p[i]
                                  : (newton->at.u[i] - u[i]) / record->alpha;
    }
    if (first) {
        free_round(round);
        keep_arrays(tape, round, E->x_n, p);
    }
    double *g = calloc((size_t)tape->size, sizeof *g);
    if (!round->x || !g) {
        free(g);
        return;
    }
    memcpy(round->p, p, array_bytes(tape));
    Iterate at = {.E = *E, .u = u, .x = round->x, .g = g, .p = round->p};
    incremental_potential_gradient(E, u, round->x, g);
    keep_line(tape, round, &at);
    free(g);
    /* Where walls or pins were moved first, the way of the update is another
     * one, which nobody knows any more. */
    Trace trace = {0};
    show_line(round, &trace);
    double limit = 1e-6 * (fabs(record->slope) + fabs(record->change));
    if (record->alpha > 0 && trace.difference &&
        !(fabs(trace.difference(trace.function, record->alpha) -
               record->change) <= limit)) {
        free(round->p);
        round->p = NULL;
    }
}

/* Multigrid goes no line that p alone gives; what it made is shown as one. */
static NewtonRecord as_line(const NewtonRecord *record)
{
    NewtonRecord line = *record;
    if (record->solver == SOLVER_MULTIGRID && record->alpha != 0)
        line.alpha = line.trials = 1;
    return line;
}

/* The round that comes next: where the solver is now.  A test that a bound
 * decides leaves no direction that belongs there. */
static void keep_next(Tape *tape, const Newton *newton)
{
    TapeRound *round = &tape->round[tape->count];
    free_round(round);
    keep_arrays(tape, round, newton->at.x, newton->at.p);
    keep_line(tape, round, &newton->at);
    round->residual = newton->residual;
    round->kind = newton->kind;
    round->projected = newton->record.projected;
}

void tape_add(Tape *tape, const Newton *newton, const NewtonRecord *made)
{
    bool at_rest = made->iteration < 0 && tape->count == 0;
    if (!tape->open)
        return;
    if (at_rest || made->status == STATUS_OK)
        tape->passed =
            newton->working == SOLVER_MULTIGRID || !newton->record.factorised;
    if (tape->size == 0 || !make_room(tape))
        return;
    if (at_rest && made->status == STATUS_OK) {
        keep_next(tape, newton);
        tape->ended = true;
    }
    if (made->iteration < 0)
        return;
    const NewtonRecord line = as_line(made), *record = &line;
    for (int i = 0; i < tape->size && !tape->tilde; i++)
        tape->x_tilde[i] = newton->at.E.x_n[i] + newton->u_tilde[i];
    tape->tilde = true;
    if (record->iteration == 0 || record->solver == SOLVER_MULTIGRID)
        keep_way(tape, newton, record);
    TapeRound *round = &tape->round[tape->count];
    round->residual = record->residual;
    round->kind = record->kind;
    if (record->solver == SOLVER_NEWTON)
        round->slope = record->slope;
    round->projected = record->projected;
    tape->record[tape->count++] = *record;
    tape->ended = record->alpha != 0 && (record->status == STATUS_RUNNING ||
                                         record->status == STATUS_OK);
    if (tape->ended)
        keep_next(tape, newton);
    else
        free_round(&tape->round[tape->count]);
}

/* One more place. */
static void add_place(Tape *tape, int round, Line line, int trials)
{
    tape->place[tape->places++] = (TapePlace){round, line, trials};
}

/* The lines of a round that made an update. */
static void add_round(Tape *tape, const Options *options, int i)
{
    const NewtonRecord *record = &tape->record[i];
    bool searches = options->line_search != LINE_SEARCH_NONE;
    int trials =
        searches && record->trials < TRIALS_WALKED ? record->trials : 1;
    add_place(tape, i, LINE_DO, 0);
    if (options->filter != FILTER_NONE)
        add_place(tape, i, LINE_PROJECT, 0);
    add_place(tape, i, LINE_SOLVE, 0);
    for (int t = 1; t < trials; t++)
        add_place(tape, i, LINE_SEARCH, t);
    if (searches || record->alpha == 0)
        add_place(tape, i, LINE_SEARCH, record->trials);
    if (record->alpha == 0)
        return;
    add_place(tape, i, LINE_UPDATE, record->trials);
    add_place(tape, i, LINE_TEST, record->trials);
}

Status tape_end(Tape *tape, const Options *options)
{
    int rounds = tape->count + 1;
    tape->open = false;
    TapePlace *place = realloc(
        tape->place, (size_t)rounds * (TRIALS_WALKED + 8) * sizeof *place);
    tape->places = 0;
    if (!place)
        return STATUS_OUT_OF_MEMORY;
    tape->place = place;
    add_place(tape, 0, LINE_START, 0);
    for (int i = 0; i < tape->count; i++)
        add_round(tape, options, i);
    if (tape->ended) {
        add_place(tape, tape->count, LINE_DO, 0);
        if (options->filter != FILTER_NONE && !tape->passed)
            add_place(tape, tape->count, LINE_PROJECT, 0);
        if (!tape->passed)
            add_place(tape, tape->count, LINE_SOLVE, 0);
        add_place(tape, tape->count, LINE_TEST, 0);
    }
    add_place(tape, tape->count, LINE_END, 0);
    return STATUS_OK;
}

/* Whether an update ends here. */
static bool is_milestone(const Tape *tape, int place)
{
    Line line = tape->place[place].line;
    return line == LINE_START || line == LINE_TEST || line == LINE_END;
}

int tape_next(const Tape *tape, int fine, int place)
{
    place++;
    while (fine < 2 && place < tape->places && !is_milestone(tape, place))
        place++;
    return place;
}

int tape_back(const Tape *tape, int fine, int place)
{
    place--;
    while (fine < 2 && place >= 0 && !is_milestone(tape, place))
        place--;
    return place;
}

/* The whole step is over: its last update, and the test that ended it. */
static void trace_last(const Tape *tape, Trace *trace)
{
    trace->iteration = tape->count - 1;
    trace->passed = tape->passed;
    if (tape->ended) {
        trace->residual = tape->round[tape->count].residual;
        trace->kind = tape->round[tape->count].kind;
    }
    if (tape->count == 0)
        return;
    const TapeRound *round = &tape->round[tape->count - 1];
    const NewtonRecord *record = &tape->record[tape->count - 1];
    trace->x = round->x;
    trace->p = round->p;
    trace->given_up = !tape->ended;
    if (trace->given_up) {
        trace->residual = round->residual;
        trace->kind = round->kind;
    }
    trace->slope = round->slope;
    trace->projected = round->projected;
    trace->trials = record->trials;
    trace->accepted = record->alpha > 0;
    show_line(round, trace);
}

/* The numbers of a round from the line on at which they are known. */
static void trace_round(const Tape *tape, const TapePlace *at, Trace *trace)
{
    const TapeRound *round = &tape->round[at->round];
    bool made = at->round < tape->count;
    bool passed = !made && tape->passed;
    const NewtonRecord *record = made ? &tape->record[at->round] : NULL;
    bool solved = at->line >= LINE_SOLVE;
    trace->x = round->x;
    trace->passed = passed && solved;
    trace->updates = at->round + (made && solved);
    trace->trials = at->trials;
    trace->accepted = made && at->trials == record->trials && record->alpha > 0;
    if (solved) {
        trace->residual = round->residual;
        trace->kind = round->kind;
    }
    if (passed)
        return;
    trace->projected = at->line >= LINE_PROJECT ? round->projected : -1;
    if (!solved)
        return;
    trace->p = round->p;
    trace->slope = round->slope;
    show_line(round, trace);
}

const double *tape_trace(const Tape *tape, int place, Trace *trace)
{
    *trace = (Trace){.h = tape->h,
                     .tolerance = tape->tolerance,
                     .updates = tape->count,
                     .record = tape->record,
                     .updates_before = tape->before,
                     .record_before = tape->record_before,
                     .projected = -1,
                     .x_tilde = tape->tilde ? tape->x_tilde : NULL};
    if (place < 0 || place >= tape->places) {
        trace_last(tape, trace);
        return NULL;
    }
    const TapePlace *at = &tape->place[place];
    trace->line = at->line;
    trace->iteration = trace->updates = at->round;
    if (tape->room == 0)
        return NULL;
    const TapeRound *round = &tape->round[at->round];
    if (at->line == LINE_START)
        return round->x;
    bool given_up = !tape->ended && tape->count > 0;
    if (at->line == LINE_END && given_up) { /* as the last round left it */
        const TapePlace last = {tape->count - 1, LINE_END,
                                tape->record[tape->count - 1].trials};
        trace_round(tape, &last, trace);
    } else if (at->line != LINE_END || tape->ended) {
        trace_round(tape, at, trace);
    }
    trace->given_up =
        given_up && (at->line == LINE_END ||
                     (at->round == tape->count - 1 && at->line == LINE_SEARCH &&
                      at->trials == tape->record[at->round].trials &&
                      tape->record[at->round].alpha == 0));
    bool moved = at->round < tape->count &&
                 (at->line == LINE_UPDATE || at->line == LINE_TEST);
    if (moved && (at->round + 1 < tape->count || tape->ended))
        return tape->round[at->round + 1].x;
    return moved || at->line == LINE_END ? NULL : round->x;
}
