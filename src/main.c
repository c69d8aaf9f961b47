/* main.c - main() of elasto on a computer: streams, signals, window. */
#include <signal.h>

#include "base/clock.h"
#include "play/player.h"

static volatile sig_atomic_t main_stop = 0;
static Player main_player; /* static: too large for some stacks */

/* After SIGINT, SIGTERM or SIGHUP the program ends when the present Newton
 * iteration is done; after a second signal, at once.  timeout(1) sends each
 * signal twice, so a second one within 0.1 s does not count. */
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

/* Installs on_signal.  Ignores the signals of pipes without a reader and of
 * files at their size limit, so that the write fails instead. */
static void install_signal_handlers(void)
{
    struct sigaction action = {.sa_handler = on_signal, .sa_flags = SA_RESTART};
    struct sigaction old;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    if (sigaction(SIGHUP, NULL, &old) == 0 && old.sa_handler != SIG_IGN)
        sigaction(SIGHUP, &action, NULL); /* under nohup SIGHUP stays ignored */
    action.sa_handler = SIG_IGN;
    sigaction(SIGPIPE, &action, NULL);
    sigaction(SIGXFSZ, &action, NULL);
}

int main(int argc, char **argv)
{
    install_signal_handlers();
    int code = program_begin(argc, argv, &window_sdl, &main_stop, &main_player);
    if (code == EXIT_NONE)
        code = program_end(&main_player, player_run(&main_player));
    player_free(&main_player);
    return code;
}
