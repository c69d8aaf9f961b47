/* main.c - the program on a computer: its streams, signals and window. */
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/clock.h"
#include "play/player.h"

static volatile sig_atomic_t main_stop = 0;
static Player main_player; /* too large for some stacks */

/* SIGINT, SIGTERM, SIGHUP: end after the present Newton iteration.  A second
 * one ends at once, whatever the program waits for: a library, a screen.
 * timeout(1) sends each signal twice, to the program and to its group: what
 * follows within a tenth of a second is still the first. */
static void on_signal(int number)
{
    static double first; /* s */
    double now = clock_now();
    if (!main_stop)
        first = now;
    else if (now - first > 0.1) {
        signal(number, SIG_DFL);
        raise(number);
    }
    main_stop = 1;
}

/* Signals that end the run; and those of pipes without a reader and of files
 * at their limit, which then are failed writes. */
static void handle_signals(void)
{
    struct sigaction action = {.sa_handler = on_signal, .sa_flags = SA_RESTART};
    struct sigaction old;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    if (sigaction(SIGHUP, NULL, &old) == 0 && old.sa_handler != SIG_IGN)
        sigaction(SIGHUP, &action, NULL); /* not so under nohup */
    action.sa_handler = SIG_IGN;
    sigaction(SIGPIPE, &action, NULL);
    sigaction(SIGXFSZ, &action, NULL);
}

/* Standard streams that are closed must not become those of other files: they
 * are open for reading only, so that writing to them still fails. */
int main(int argc, char **argv)
{
    int file = 0;
    while (file >= 0 && file <= STDERR_FILENO)
        file = open("/dev/null", O_RDONLY);
    if (file > STDERR_FILENO)
        close(file);
    handle_signals();
    int code = program_begin(argc, argv, &main_stop, &main_player);
    if (code == PROGRAM_PLAYS)
        code = program_end(&main_player, player_run(&main_player));
    player_free(&main_player);
    return code;
}
