/* saves.c - saves pictures, films and scripts under new names. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "play/playing.h"

enum { MAX_NOTE_BYTES = 100 }; /* longest command line that a note shows */

/* Finds a name that no file has: elasto_SCENE_000012.png, ..._2.png, ... */
static void find_unused_file_name(const Player *player, const char *end,
                                  char *name, size_t size)
{
    char number[16] = "";
    for (int i = 2; i < 100000; i++) {
        snprintf(name, size, "elasto_%s_%06ld%s%s", player->screen.scene->name,
                 player->past.shown_step, number, end);
        if (access(name, F_OK) != 0)
            return;
        snprintf(number, sizeof number, "_%d", i);
    }
}

Status obey_save_picture(Player *player, const Command *command)
{
    char name[80];
    const bool draws = player->screen.draws_frames;
    player->screen.draws_frames = true;
    Paper *paper = player_prepare_paper(player);
    Status status = paper ? STATUS_OK : STATUS_OUT_OF_MEMORY;
    player->screen.draws_frames = draws;
    find_unused_file_name(player, ".png", name, sizeof name);
    if (paper) {
        player_paint_frame(player, paper);
        status = png_file_write(name, NULL, &paper->canvas);
    }
    if (status)
        player_notify(player, "not saved: %s", output_reason(status));
    else
        player_notify(player, "saved %s", name);
    return STATUS_OK;
}

Status obey_toggle_film(Player *player, const Command *command)
{
    char name[80], message[MESSAGE_BYTES] = "";
    Film *film = &player->recording.film;
    bool ends = film_is_open(film);
    if (!player->screen.draws_frames)
        return player_refuse(player, "nothing is drawn that could be filmed");
    find_unused_file_name(player, ".mp4", name, sizeof name);
    film->output.message = message;
    Status status =
        ends ? film_close(film, KEEP_FILE) : film_open(name, message, film);
    film->output.message = player->recording.message;
    player->screen.drawn_step = -1; /* the film begins with the present frame */
    if (status)
        player_notify(player, "no film: %s", message);
    else if (ends)
        player_notify(player, "film ends: %ld frames, in %s", film->frame_count,
                      film->output.name);
    else
        player_notify(player, "filming %s", name);
    return STATUS_OK;
}

int player_find_first_scene_word(const Player *player, int i)
{
    char *const *words = player->setup.arguments;
    const OptionRow *first = option_find("steps");
    for (; words && words[0] && words[i]; i++) {
        char name[32];
        size_t length = strcspn(words[i], "=");
        snprintf(name, sizeof name, "%.*s", (int)length, words[i]);
        const OptionRow *row =
            strncmp(name, "--", 2) == 0 ? option_find(name + 2) : NULL;
        if (!row || row < first || row == option_find("lecture") ||
            row == option_find("headless"))
            return i;
        if (row->kind != OPTION_SWITCH && words[i][length] == '\0' &&
            words[i + 1])
            i++; /* skips the option's value */
    }
    return 0;
}

/* Writes a word for a shell, in quotes if it needs them. */
static void write_shell_word(FILE *file, const char *word)
{
    static const char plain[] = "%+,-./0123456789:=@_"
                                "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                "abcdefghijklmnopqrstuvwxyz";
    bool bare = word[0] && word[strspn(word, plain)] == '\0';
    fputs(bare ? " " : " '", file);
    for (; *word; word++)
        if (*word == '\'')
            fputs("'\\''", file);
        else
            fputc(*word, file);
    fputs(bare ? "" : "'", file);
}

/* Returns the command line of the present step, to be freed; NULL: no memory.
 *   script  in, name of the session's script; NULL: no commands yet */
static char *write_command_line(const Player *player, const char *script)
{
    char *line = NULL;
    size_t size;
    FILE *file = open_memstream(&line, &size);
    if (!file)
        return NULL;
    fputs("elasto", file);
    for (int i = 0; (i = player_find_first_scene_word(player, i + 1));)
        write_shell_word(file, player->setup.arguments[i]);
    if (script)
        fprintf(file, " --script %s", script);
    else
        fprintf(file, " --steps %ld", player->past.shown_step);
    if (fclose(file)) {
        free(line);
        return NULL;
    }
    replace_control_characters(line);
    return line;
}

/* Saves the journal as a script, with a pause at its end.
 *   line  in, command line that plays the script */
static Status save_journal(Player *player, const char *name, const char *line)
{
    const Command pause = {.kind = COMMAND_PAUSE};
    Script *journal = &player->commands.journal;
    size_t count = journal->lines;
    Status status = STATUS_OK;
    if (!player_is_stopped(player))
        status = script_add(journal, player->past.shown_step, &pause, 0);
    if (!status)
        status = script_write(name, line, journal);
    journal->lines = count;
    return status;
}

/* Reports the hash of the state and a command line that leads to the state;
 * after commands also saves the script that the line plays.  The command waits
 * for the end of a step being made, during which panes are at two steps. */
Status obey_report_hash(Player *player, const Command *command)
{
    if (past_is_working(&player->past)) {
        player_enqueue(player, command);
        return STATUS_OK;
    }
    char name[80], hash[64];
    bool commands = player->commands.journal.lines > 0;
    find_unused_file_name(player, ".script", name, sizeof name);
    char *line = write_command_line(player, commands ? name : NULL);
    Status status = line ? STATUS_OK : STATUS_OUT_OF_MEMORY;
    if (!status && commands)
        status = save_journal(player, name, line);
    snprintf(hash, sizeof hash, "state %016llx at step %ld",
             (unsigned long long)player_compute_hash(player),
             player->past.shown_step);
    if (status) {
        player_notify(player, "%s: no script: %s", hash, output_reason(status));
    } else {
        bool fits = strlen(line) <= MAX_NOTE_BYTES;
        const char *where = commands ? name : "the terminal";
        player_notify(player, "%s: %s%s", hash, fits ? "" : "its line is in ",
                      fits ? line : where);
        fprintf(stderr, "%s: %s\n", hash, line);
    }
    free(line);
    return STATUS_OK;
}
