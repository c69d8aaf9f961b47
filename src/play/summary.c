#include "play/player.h"

#include <math.h>

#include "base/clock.h"
#include "scenes/one_line.h"
#include "scenes/scene.h"

/* Who made the first run's last step, and why it was not multigrid. */
static void print_solver(FILE *file, const Simulation *simulation)
{
    const Newton *newton = simulation->run[0].newton;
    if (!newton || !(simulation->scene->needs & NEEDS_SPRINGS))
        return;
    fprintf(file, "solver              %s", solver_name(newton->working));
    if (newton->refusal)
        fprintf(file, "; no multigrid: %s", newton->refusal);
    if (newton->counters.taken_back > 0)
        fprintf(file, "; newton ended %ld minimisations of multigrid",
                newton->counters.taken_back);
    fputc('\n', file);
}

/* Where contact and friction need a smaller tolerance. */
static void print_tolerance(FILE *file, const Simulation *simulation)
{
    double needed;
    if (simulation_is_loose(simulation, &needed))
        fprintf(file,
                "tolerance           %g m/s is loose: bodies may hang or "
                "freeze; %.3g is not\n",
                simulation->options.tolerance, needed);
}

/* A count, where there is something to count. */
static void print_count(FILE *file, const char *name, long long count)
{
    if (count > 0)
        fprintf(file, "%-20s%lld\n", name, count);
}

/* What the minimisations took; nothing with explicit methods, which have
 * none. */
static void print_newton(FILE *file, const Simulation *simulation)
{
    NewtonCounters sum = simulation_counters(simulation);
    bool in_time = simulation->scene->needs & NEEDS_TIME;
    bool minimises = !in_time && (simulation->scene->needs & NEEDS_START);
    long iterations = in_time ? sum.iterations : simulation->descent.count;
    for (int i = 0; i < simulation->runs && in_time; i++)
        minimises = minimises || simulation->run[i].newton;
    print_solver(file, simulation);
    print_tolerance(file, simulation);
    if (!minimises)
        return;
    fprintf(file, "Newton iterations   %ld\n", iterations);
    print_count(file, "factorisations", sum.factorisations);
    print_count(file, "solves", sum.solves);
    print_count(file,
                simulation_projects_springs(simulation) ? "springs projected"
                                                        : "blocks projected",
                sum.projected);
    print_count(file, "matrix entries", simulation_matrix_entries(simulation));
    print_count(file, "V-cycles", sum.cycles);
    print_count(file, "saddles left", sum.saddles);
}

/* A number with its unit, where it is one. */
static void print_energy(FILE *file, double energy)
{
    if (isfinite(energy))
        fprintf(file, "%.9g J", energy);
    else
        fprintf(file, "too large for a number");
}

/* Of the first run; where there are several, with its name. */
static void print_energies(FILE *file, const Player *player, int pane)
{
    const Simulation *simulation = &player->past.machine[pane].simulation;
    const Energies end = simulation_energies(simulation, 0);
    const char *name = "", *of = "";
    if (simulation->runs > 1) {
        of = ", ";
        name = simulation->run[0].method->name;
    }
    fprintf(file, "energy at start     ");
    print_energy(file, player->past.machine[pane].start);
    fprintf(file, "%s%s\nenergy at end       ", of, name);
    print_energy(file, end.total);
    fprintf(file, "%s%s\n", of, name);
}

/* The folder of the frames and the last film. */
static void print_frames(FILE *file, const Recording *recording)
{
    char name[256];
    one_line(recording->folder, name, sizeof name);
    if (recording->folder)
        fprintf(file, "frames written      %ld, in %s/\n", recording->frames,
                name);
    else if (recording->films == 0)
        fprintf(file, "frames written      0\n");
    if (recording->films > 0)
        fprintf(file, "film                %s", recording->film_told);
    if (recording->films > 1)
        fprintf(file, "; the last of %ld films", recording->films);
    if (recording->films > 0)
        fputc('\n', file);
}

/* How far it came. */
static void print_steps(FILE *file, const Simulation *simulation)
{
    fprintf(file, "steps               %ld\n", simulation->steps);
    if (simulation->scene->needs & NEEDS_TIME)
        fprintf(file, "simulated time      %g s\n",
                simulation_time(simulation));
}

/* What it took, and where that led. */
static void print_work(FILE *file, const Player *player, int pane)
{
    const Simulation *simulation = &player->past.machine[pane].simulation;
    print_newton(file, simulation);
    if (simulation->scene->needs & NEEDS_TIME)
        print_energies(file, player, pane);
}

static void print_unconverged(FILE *file, const Simulation *simulation)
{
    fprintf(file, "steps not converged %ld", simulation->unconverged);
    if (simulation->unconverged > 0)
        fprintf(file, ", the first: %s", status_name(simulation->first));
    for (int i = 0; i < STATUS_COUNT; i++)
        if (simulation->reasons[i] > 0)
            fprintf(file, "\n  %-17s %d", status_name((Status)i),
                    simulation->reasons[i]);
    fputc('\n', file);
}

/* One quantity a line; of several panes those of each, one after the other. */
void summary_print(FILE *file, const Player *player)
{
    int panes = past_panes(&player->past);
    for (int i = 0; i < panes && panes > 1; i++) {
        const Machine *machine = &player->past.machine[i];
        fprintf(file, "pane %-14d %s\n", i + 1, player->side[i].label);
        print_steps(file, &machine->simulation);
        print_work(file, player, i);
        print_unconverged(file, &machine->simulation);
        fputc('\n', file);
    }
    const Simulation *simulation = &player->past.machine[0].simulation;
    bool one = panes == 1;
    if (one)
        print_steps(file, simulation);
    fprintf(file, "wall time           %.3f s\n",
            clock_now() - player->started);
    if (one)
        print_work(file, player, 0);
    print_frames(file, &player->recording);
    if (one)
        print_unconverged(file, simulation);
    fprintf(file, "state hash          %016llx\n",
            (unsigned long long)player_hash(player));
}
