/* program.c - begins with the command line, ends with summary and exit code. */
#include "play/player.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "model/contact.h"
#include "lesson/command_line.h"
#include "simulation/message.h"
#include "lesson/pages.h"
#include "scenes/scenes.h"

/* Prints a failure as one line.  The macro's value is the exit code. */
#define print_error(code, format, ...)                                         \
    (print_line(stderr, "elasto: " format, __VA_ARGS__), (int)(code))

/* Whether the reader of standard output has closed it, as head(1) does. */
static bool stdout_is_closed(void)
{
    struct pollfd out = {.fd = STDOUT_FILENO};
    return poll(&out, 1, 0) == 1 && out.revents & (POLLERR | POLLHUP);
}

/* Checks that all output was written; errno must have been 0 before.  Prints a
 * failure, unless the reader is gone.  Returns the exit code. */
static int check_standard_output(void)
{
    if (!ferror(stdout) && fflush(stdout) == 0)
        return EXIT_FINE;
    return stdout_is_closed() ? EXIT_FAILED
                              : print_error(EXIT_FAILED, "standard output: %s",
                                            output_reason(STATUS_FILE_FAILED));
}

/* Prints the answer to --help, --version, --lecture --list or --list.  Returns
 * the exit code, or EXIT_NONE without such an option. */
static int print_help_or_list(const Options *options)
{
    errno = 0;
    if (options->help)
        options_print_help(stdout);
    else if (options->version)
        puts("elasto " ELASTO_VERSION);
    else if (!options->list)
        return EXIT_NONE;
    else if (options->page)
        for (int i = 0; lecture_pages[i].name; i++)
            printf("%2d %-12s %s\n", i + 1, lecture_pages[i].name,
                   lecture_pages[i].topic);
    else
        for (const Scene *scene = scenes; scene->name; scene++)
            printf("%-12s %s\n", scene->name, scene->description);
    return check_standard_output();
}

static const char *find_remedy(const Player *player, Status status)
{
    bool time = player->setup.options[0].scene->traits & HAS_TIME;
    return status == STATUS_OUT_OF_MEMORY || status == STATUS_TOO_LARGE
               ? "; try fewer --segments"
           : status == STATUS_NOT_POSITIVE_DEFINITE ? "; try --projection clamp"
           : status == STATUS_INVALID_INPUT
               ? "; try numbers nearer to the defaults"
           : status != STATUS_NOT_FINITE ? ""
           : time                        ? "; try a smaller --timestep"
                                         : "; try a --start nearer to 0,0";
}

/* Prints why the run failed.  Returns the exit code. */
static int report_failure(const Player *player, Status status)
{
    int code = status == STATUS_INVALID_INPUT ? EXIT_MISUSED : EXIT_FAILED;
    const char *message = player->message;
    int panes = past_count_panes(&player->past), p = 0;
    char pane[32] = "";
    if (status == STATUS_FILE_FAILED && player->recording.uses_stdout &&
        stdout_is_closed())
        return code;
    if (!message[0])
        message = player->recording.message;
    while (p < panes && player->past.pane[p].simulation.status != status)
        p++;
    if (panes > 1)
        snprintf(pane, sizeof pane, "pane %d, ", p + 1);
    if (message[0])
        return print_error(code, "%s", message);
    if (status == STATUS_SCREEN_FAILED)
        return print_error(code, "%s: %s", status_text(status),
                           player->screen.window->get_failure_reason());
    if (p < panes)
        return print_error(code, "%sstep %ld failed: %s%s", pane,
                           player->past.pane[p].simulation.steps + 1,
                           status_text(status), find_remedy(player, status));
    return print_error(code, "%s%s", status_text(status),
                       find_remedy(player, status));
}

/* ---- summary ------------------------------------------------------------- */

/* Prints a quantity of the summary, with its name in the first column. */
#define print_quantity(file, name, format, ...)                                \
    print_line(file, "%-20s" format, name, __VA_ARGS__)

/* Prints the solver of the last step, why not multigrid, and counts of work. */
static void print_newton_counters(FILE *file, const Simulation *simulation)
{
    const Newton *newton = simulation->run[0].newton;
    NewtonCounters sum = simulation_sum_newton_counters(simulation);
    unsigned needs = simulation->scene->traits;
    const struct {
        const char *name;
        long long value; /* 0: the row is not printed */
    } rows[] = {
        {"Newton iterations",
         needs & HAS_TIME ? sum.updates : simulation->descent.record_count},
        {"factorisations", sum.factorisations},
        {"solves", sum.linear_solves},
        {"blocks projected", sum.projected_blocks},
        {"V-cycles", sum.v_cycles},
        {"not at a minimum", sum.indefinite_convergences},
    };
    if (newton && needs & HAS_SPRINGS)
        print_quantity(file, "solver", "%s%s%s",
                       get_solver_name(newton->active_solver),
                       newton->refusal_reason ? "; no multigrid: " : "",
                       newton->refusal_reason ? newton->refusal_reason : "");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (rows[i].value > 0)
            print_quantity(file, rows[i].name, "%lld", rows[i].value);
}

/* Prints by how much the total energy has risen in steps of backward Euler. */
static void print_energy_gain(FILE *file, const Simulation *simulation)
{
    long steps = 0;
    double gained = 0;
    for (int r = 0; r < simulation->runs; r++) {
        steps += simulation->ledger[r].gain_steps;
        gained += simulation->ledger[r].gained_energy;
    }
    if (steps > 0)
        print_quantity(
            file, "energy gained",
            "%.4g J without work, in %ld steps of backward Euler; a shorter "
            "timestep gains less",
            gained, steps);
}

/* Prints steps, solver and energies of each pane; then time, files, hash. */
static void print_summary(FILE *file, const Player *player)
{
    const Recording *recording = &player->recording;
    int panes = past_count_panes(&player->past);
    for (int p = 0; p < panes; p++) {
        const Simulation *simulation = &player->past.pane[p].simulation;
        bool in_time = simulation->scene->traits & HAS_TIME;
        char label[LABEL_SIZE];
        player_write_label(player, p, label);
        if (panes > 1)
            print_line(file, "pane %-14d %s", p + 1,
                       label[0] ? label : "same options as the others");
        print_quantity(file, "steps", "%ld", simulation->steps);
        if (in_time)
            print_quantity(file, "simulated time", "%g s",
                           simulation_get_time(simulation));
        print_newton_counters(file, simulation);
        if (in_time) {
            print_quantity(file, "energy at start", "%.9g J",
                           simulation->ledger[0].start_energy +
                               0.0); /* no -0 */
            print_quantity(file, "energy at end", "%.9g J",
                           simulation_get_energies(simulation, 0).total);
            print_energy_gain(file, simulation);
        }
        fprintf(file, "steps not converged %ld", simulation->unconverged_steps);
        for (int i = 0; i < STATUS_COUNT; i++)
            if (simulation->status_counts[i] > 0)
                fprintf(file, "\n  %-17s %d", status_name((Status)i),
                        simulation->status_counts[i]);
        fputs(panes > 1 ? "\n\n" : "\n", file);
    }
    print_quantity(file, "wall time", "%.3f s",
                   clock_now() - player->setup.start_time);
    if (recording->folder)
        print_quantity(file, "frames written", "%ld, in %s/",
                       recording->frame_count, recording->folder);
    if (recording->film.frame_count > 0)
        print_quantity(file, "film", "%ld frames, in %s",
                       recording->film.frame_count,
                       recording->film.output.name);
    print_quantity(file, "state hash", "%016llx",
                   (unsigned long long)player_compute_hash(player));
}

/* Reports frames of an earlier, longer run that are still in the folder. */
static void print_old_frames(const Recording *recording)
{
    long count = 0, first = 0, last = 0;
    for (long step = 0; recording->is_old_frame && step < MAX_FRAMES; step++)
        if (recording->is_old_frame[step]) {
            first = count++ == 0 ? step : first;
            last = step;
        }
    if (count > 0) /* 0: no old frame, or no --frames */
        print_line(stderr,
                   "%s/: frames of an earlier run stay: %ld, from "
                   "frame_%06ld.png to frame_%06ld.png",
                   recording->folder, count, first, last);
}

/* ---- the end ------------------------------------------------------------- */

int program_end(Player *player, Status status)
{
    /* The report comes first: player_close_files can change the simulations. */
    int failed = status ? report_failure(player, status) : EXIT_FINE;
    status = player_close_files(player, status);
    if (failed)
        return failed;
    if (status)
        return report_failure(player, status);
    errno = 0;
    if (!player->setup.options[0].quiet)
        print_summary(player->recording.uses_stdout ? stderr : stdout, player);
    print_old_frames(&player->recording);
    int code = check_standard_output();
    if (code == EXIT_FINE && player->commands.has_refused_line)
        return EXIT_MISUSED;
    for (int i = 0; i < past_count_panes(&player->past) && code == EXIT_FINE;
         i++) {
        const Simulation *simulation = &player->past.pane[i].simulation;
        if (simulation->unconverged_steps > 0 ||
            (simulation->is_over && simulation->status))
            return EXIT_UNCONVERGED;
    }
    return code;
}

/* Returns the file or folder that an option names, or NULL. */
static const char *find_option_file(const Options *options,
                                    const OptionRow *row)
{
    return row->kind == OPTION_TEXT && row->offset != offsetof(Options, pin)
               ? *(char *const *)((const char *)options + row->offset)
               : NULL;
}

/* Refuses two options with one file name: a file would replace the other. */
static Status check_file_names(const Options *options, Message message)
{
    for (const OptionRow *row = option_rows; row->name; row++)
        for (const OptionRow *other = option_rows; other < row; other++) {
            const char *one = find_option_file(options, other);
            const char *two = find_option_file(options, row);
            if (one && two && strcmp(one, two) == 0 &&
                strncmp(one, "/dev/", 5) != 0)
                return refuse(message,
                              "--%s and --%s are one file, '%.200s': "
                              "each needs a name of its own",
                              other->name, row->name, one);
        }
    return STATUS_OK;
}

/* Warns that --state alone restores neither broken springs nor the ceiling. */
static void warn_of_unrestored_state(const Options *options)
{
    const Scene *scene = options->scene;
    bool moves = options->ceiling[1] != 0 ||
                 (scene->body.make_obstacle &&
                  scene->body.make_obstacle(options).motion.phase_count > 0);
    bool springs =
        !options->state_springs && (options->tear > 0 || options->yield > 0);
    if (options->state && springs)
        fprintf(stderr, "--state: the springs begin whole and unbent; "
                        "--state-springs FILE has what became of them\n");
    if (options->state && moves)
        fprintf(stderr,
                "--state: the ceiling starts at its height Y again, not "
                "where it was at that step\n");
}

int program_begin(int argc, char **argv, const Window *window,
                  const volatile sig_atomic_t *stop, Player *player)
{
    Options options[OPTIONS_MAX_PANES] = {{.panes = 1}};
    char message[MESSAGE_BYTES] = "";
    memset(player, 0, sizeof *player);
    if (argc == 3 && strcmp(argv[1], "--help") == 0 &&
        strcmp(argv[2], "commands") == 0) {
        commands_print_help(stdout);
        return check_standard_output();
    }
    for (int i = 0; i < options->panes; i++) {
        Status status =
            options_parse(argc, argv, i, &options[i], MESSAGE(message));
        if (status == STATUS_INVALID_INPUT)
            return print_error(EXIT_MISUSED, "%s", message);
        if (status)
            return print_error(EXIT_FAILED, "%s; try fewer --segments",
                               status_text(status));
    }
    int code = print_help_or_list(options);
    if (code != EXIT_NONE)
        return code;
    if (check_file_names(options, MESSAGE(message)))
        return print_error(EXIT_MISUSED, "%s", message);
    warn_of_unrestored_state(options);
    Status status = player_create(options, argv, window, stop, player);
    return status ? program_end(player, status) : EXIT_NONE;
}
