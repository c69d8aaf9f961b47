/* screen.c - what only the screen shows: speed, camera, cards, lists; all
 * scenes at once; and what is kept of a session, where nothing is overwritten:
 * pictures, films, the way to a state.
 */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "picture/picture.h"
#include "play/playing.h"
#include "lesson/pages.h"
#include "scenes/scenes.h"

enum {
    WATCHED_SPEED = -5, /* of iterations that are watched one by one */
    NOTE_LINE = 100 /* letters of a command line that the window has room for */
};

int player_first_speed(const Player *player, const Options *options)
{
    double speed = options->speed;
    if (speed == 0 && !options->page && player->attended)
        speed = options->scene->speed;
    if (speed > 0)
        return (int)lrint(fmin(fmax(log2(speed), SPEED_LEAST), SPEED_MOST));
    return options->scene->needs & NEEDS_TIME ? 0 : WATCHED_SPEED;
}

/* Whether the session has something to lose: changes, or a run of a minute. */
static bool has_work(const Player *player)
{
    static const double LONG = 60; /* s */
    const Past *past = &player->past;
    return past->now > 0 ||
           (past_newest(past) > 0 && clock_now() - player->started > LONG);
}

/* Speed, which doubles or halves; what is on or off; which pane's numbers are
 * shown. */
Status obey_screen(Player *player, const Command *command)
{
    switch (command->kind) {
    case COMMAND_FASTER:
        player->speed += player->speed < SPEED_MOST;
        break;
    case COMMAND_SLOWER:
        player->speed -= player->speed > SPEED_LEAST;
        break;
    case COMMAND_COLOURS:
        player->strain = !player->strain;
        break;
    case COMMAND_BARE:
        player->bare = !player->bare;
        break;
    case COMMAND_BLANK:
        player->blank = !player->blank;
        break;
    case COMMAND_FULL:
        if (player->window)
            window_set_full(!window_is_full());
        break;
    case COMMAND_PANE:
        player->active = (int)command->number;
        break;
    case COMMAND_CLOSE:
        player_deselect(player);
        break;
    default:
        break;
    }
    return STATUS_OK;
}

/* The list of keys or of pages, or a page's code, or the cards again. */
Status obey_column(Player *player, const Command *command)
{
    Column column = command->kind == COMMAND_KEYS      ? COLUMN_KEYS
                    : command->kind == COMMAND_PAGES   ? COLUMN_PAGES
                    : command->kind == COMMAND_OPTIONS ? COLUMN_OPTIONS
                                                       : COLUMN_CODE;
    if (column == COLUMN_CODE && !player_settings(player)->page)
        return player_refuse(player, "only pages of the lecture have code: "
                                     "Page Down opens them");
    player->column = player->column == column ? COLUMN_CARDS : column;
    player_close_sheet(player);
    player_deselect(player);
    return STATUS_OK;
}

/* Ends the program; the key asks first where there is something to lose. */
Status obey_quit(Player *player, const Command *command)
{
    bool key = command->text[0] != '\0', asked = player->leaving;
    player->quit = !key || asked || !has_work(player);
    player->leaving = COMMAND_QUIT;
    if (!player->quit)
        player_note(player, "Q once more ends the program; Y writes down first "
                            "what leads here");
    return STATUS_OK;
}

/* What is open ends first; then, asked twice, the program, unless there is
 * something to lose. */
Status obey_escape(Player *player, const Command *command)
{
    bool asked = player->leaving == COMMAND_ESCAPE;
    player->leaving = COMMAND_NONE;
    if (player->blank)
        player->blank = false;
    else if (player->sheet)
        player_close_sheet(player);
    else if (player->column == COLUMN_KEYS)
        player->column = COLUMN_CARDS;
    else if (player->lit)
        player_deselect(player);
    else if (player->column)
        player->column = COLUMN_CARDS;
    else if (player->window && window_is_full())
        window_set_full(false);
    else if (has_work(player))
        player_note(player, "nothing is open; Q ends the program");
    else if (asked)
        player->quit = true;
    else
        player->leaving = COMMAND_ESCAPE;
    if (player->leaving)
        player_note(player, "Esc once more, or Q, ends the program");
    return STATUS_OK;
}

/* Zooms at a point in metres, moves the picture by some of them, or all fits
 * again. */
Status obey_camera(Player *player, const Command *command)
{
    const Paper *paper = player_paper(player);
    Show *show = &player->show;
    if (command->kind == COMMAND_FIT)
        show->lens = LENS_FITS;
    if (command->kind == COMMAND_FIT || !paper)
        return STATUS_OK;
    player_fill(player);
    Layout layout =
        show_layout(show, paper->canvas.width, paper->canvas.height);
    Camera camera = show_camera(show, &layout, player->active);
    Box pane = layout.pane[player->active];
    double at[2] = {command->x, command->y}, pixel[2];
    camera_pixel(&camera, at, pixel);
    if (command->kind == COMMAND_ZOOM)
        lens_zoom(&show->lens, pane, pixel[0], pixel[1],
                  fmin(fmax((double)command->number, 1), 1e6) / 100);
    else
        lens_move(&show->lens, pane, camera.scale[0] * command->x,
                  -camera.scale[1] * command->y);
    return STATUS_OK;
}

/* A card is closed or opened; one that is open is enlarged, or as the others.
 */
Status obey_card(Player *player, const Command *command)
{
    int card = (int)command->number;
    player_fill(player);
    bool closed = player->show.closed >> card & 1;
    if (command->kind == COMMAND_CARD || closed) /* its title opens it */
        player->closed ^= 1u << card;
    else
        player->large = player->large == card ? -1 : card;
    return STATUS_OK;
}

/* ---- the sheet ----------------------------------------------------------- */

/* All scenes at once, as small pictures that live: the tour first, which turns
 * its pages, and then a cell for each row of the table of scenes.  The run
 * waits behind them. */
enum {
    LIFE = 240, /* frames until a scene begins again, */
    SLOW = 24   /* and between two steps where no time passes */
};

static const double LIVING = 0.008; /* s of a frame */

typedef struct Sheet {
    int cells, next;       /* whose turn it is */
    int page;              /* of the tour */
    int age[LAYOUT_CELLS]; /* frames; 0: it is not made yet */
    Simulation simulation[LAYOUT_CELLS];
} Sheet;

void player_close_sheet(Player *player)
{
    Sheet *sheet = player->sheet;
    for (int i = 0; sheet && i < sheet->cells; i++)
        simulation_free(&sheet->simulation[i]);
    free(sheet);
    player->sheet = NULL;
}

/* All scenes but those by name, or the run again.  The open scene is chosen,
 * the tour where the sheet does not have it. */
Status obey_sheet(Player *player, const Command *command)
{
    const Options *options = player_settings(player);
    bool opens = !player->sheet;
    player_close_sheet(player);
    player_deselect(player);
    if (!opens)
        return STATUS_OK;
    player->sheet = calloc(1, sizeof *player->sheet);
    if (!player->sheet)
        return STATUS_OUT_OF_MEMORY;
    int cells = 1; /* the first one is the tour's */
    while (cells < LAYOUT_CELLS && scenes[cells - 1].name &&
           !scenes[cells - 1].by_name)
        cells++;
    player->sheet->cells = cells;
    player->show.chosen = options->page || options->scene->by_name
                              ? 0
                              : (int)(options->scene - scenes) + 1;
    return STATUS_OK;
}

/* A scene from its start.  What cannot begin stays a frame without a picture.
 */
static void begin_cell(Sheet *sheet, int i)
{
    char message[256];
    Options options;
    Simulation *simulation = &sheet->simulation[i];
    const LecturePage *page = &lecture_pages[sheet->page];
    Status status =
        i == 0 ? lecture_options(page, &options, message, sizeof message)
               : options_of_line(scenes[i - 1].name, &options, message,
                                 sizeof message);
    simulation_free(simulation);
    if (i == 0)
        sheet->page = page[1].name ? sheet->page + 1 : 0;
    if (!status && simulation_create(&options, NULL, NULL, simulation))
        simulation_free(simulation);
}

void player_live(Player *player)
{
    Sheet *sheet = player->sheet;
    double begin = clock_now();
    if (!sheet)
        return;
    for (int i = 0; i < sheet->cells && clock_now() - begin < LIVING; i++) {
        int cell = sheet->next, age = sheet->age[cell]++;
        Simulation *simulation = &sheet->simulation[cell];
        Status status = simulation->status;
        if (age % LIFE == 0)
            begin_cell(sheet, cell);
        else if (simulation->scene && !simulation->done &&
                 (!status || status_is_unconverged(status)) &&
                 ((simulation->scene->needs & NEEDS_TIME) || age % SLOW == 0))
            simulation_step(simulation);
        sheet->next = (cell + 1) % sheet->cells;
    }
    player->changed = true;
}

void player_fill_sheet(Player *player)
{
    const Sheet *sheet = player->sheet;
    Show *show = &player->show;
    if (!sheet)
        return;
    show->cells = sheet->cells;
    for (int i = 0; i < sheet->cells; i++) {
        const Scene *scene = &scenes[i > 0 ? i - 1 : 0];
        const Simulation *simulation = &sheet->simulation[i];
        show->cell[i] =
            (SheetCell){.name = i > 0 ? scene->name : "the guided tour",
                        .group = i == 1 ? NULL : scene->group,
                        .simulation = simulation->scene ? simulation : NULL};
        if (i == show->chosen)
            snprintf(show->sentence, SHOW_TEXT, "%s: %s", show->cell[i].name,
                     i > 0 ? scene->sentence : "the lecture, page by page");
    }
    show->topic = "Scenes";
    snprintf(show->method, SHOW_TEXT, "arrows, Enter");
    snprintf(show->state, SHOW_VALUE, "digits: a page of the tour");
}

/* The cell beside it; or the next one, on or back, that is below it and not to
 * its left, or above it and not to its right. */
Status obey_choose(Player *player, const Command *command)
{
    Show *show = &player->show;
    const Paper *paper = player_paper(player);
    const char *key = command->text;
    bool up = strcmp(key, "Up") == 0, upright = up || strcmp(key, "Down") == 0;
    int way = up || strcmp(key, "Left") == 0 ? -1 : 1, i = show->chosen + way;
    if (!paper)
        return STATUS_OK;
    player_fill(player);
    Layout layout =
        show_layout(show, paper->canvas.width, paper->canvas.height);
    const Box *cell = layout.cell, *now = &cell[show->chosen];
    while (upright && 0 <= i && i < layout.cells &&
           !((cell[i].y - now->y) * way > 0 && (cell[i].x - now->x) * way >= 0))
        i += way;
    if (0 <= i && i < layout.cells)
        show->chosen = i;
    return STATUS_OK;
}

/* The scene that is chosen, by a command that a script can repeat; the page
 * that is open is behind the sheet. */
Status obey_open(Player *player, const Command *command)
{
    char line[32] = "page-on";
    int cell = player->show.chosen;
    bool behind = cell == 0 && player_settings(player)->page;
    if (cell > 0)
        snprintf(line, sizeof line, "scene %s", scenes[cell - 1].name);
    Status status = behind ? STATUS_OK : player_obey_lines(player, line);
    player_close_sheet(player);
    player_deselect(player);
    return status;
}

/* ---- what is kept -------------------------------------------------------- */

/* elasto_SCENE_000012.png, or the first of ..._2.png, ... that is free. */
static void free_name(const Player *player, const char *end, char *name,
                      size_t size)
{
    char number[16] = "";
    for (int i = 2; i < 100000; i++) {
        snprintf(name, size, "elasto_%s_%06ld%s%s", player->scene->name,
                 player->past.step, number, end);
        if (access(name, F_OK) != 0)
            return;
        snprintf(number, sizeof number, "_%d", i);
    }
}

/* The frame as it is, in the present folder. */
Status obey_shot(Player *player, const Command *command)
{
    char name[80];
    const bool draws = player->draws;
    player->draws = true;
    Paper *paper = player_paper(player);
    Status status = paper ? STATUS_OK : STATUS_OUT_OF_MEMORY;
    player->draws = draws;
    free_name(player, ".png", name, sizeof name);
    if (paper) {
        player_paint(player, paper);
        status = png_file_write(name, NULL, &paper->canvas);
    }
    if (status)
        player_note(player, "not saved: %s", output_reason(status));
    else
        player_note(player, "saved %s", name);
    return STATUS_OK;
}

/* Begins a film of all that is drawn, or ends it. */
Status obey_film(Player *player, const Command *command)
{
    char name[80], told[OUTPUT_TOLD] = "";
    Film *film = &player->recording.film;
    bool ends = film_runs(film);
    if (!player->draws)
        return player_refuse(player, "nothing is drawn that could be filmed");
    free_name(player, ".mp4", name, sizeof name);
    film->output.told = told;
    Status status =
        ends ? film_close(film, KEEP_WHOLE) : film_open(name, told, film);
    film->output.told = player->recording.message;
    player->sampled = -1; /* the present frame is the first, or drawn again */
    if (status)
        player_note(player, "no film: %s", told);
    else if (ends)
        player_note(player, "film ends: %ld frames, in %s", film->frames,
                    film->output.name);
    else
        player_note(player, "filming %s", name);
    return STATUS_OK;
}

/* A word as a shell takes it: as it is, in quotes or, where it has what no
 * terminal should see, as bash, zsh and ksh write that. */
static void put_word(FILE *file, const char *word)
{
    static const char plain[] = "%+,-./0123456789:=@_"
                                "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                "abcdefghijklmnopqrstuvwxyz";
    bool bare = word[0] && word[strspn(word, plain)] == '\0';
    bool clean = is_one_line(word);
    fputs(bare ? " " : clean ? " '" : " $'", file);
    for (; *word; word++)
        if (clean && *word == '\'')
            fputs("'\\''", file);
        else if (clean || strchr(plain, *word))
            fputc(*word, file);
        else
            fprintf(file, "\\%03o", (unsigned)(unsigned char)*word);
    fputs(bare ? "" : "'", file);
}

/* The command line that leads to the present step, by a script where commands
 * have led to it (else NULL).  NULL: not enough memory; free it. */
static char *make_line(const Player *player, const char *script)
{
    char *line = NULL;
    size_t size;
    FILE *file = open_memstream(&line, &size);
    if (!file)
        return NULL;
    fputs("elasto", file);
    for (int i = 0; (i = player_next_word(player, i + 1));)
        put_word(file, player->words[i]);
    if (script)
        fprintf(file, " --script %s", script);
    else
        fprintf(file, " --steps %ld", player->past.step);
    if (fclose(file) == 0)
        return line;
    free(line);
    return NULL;
}

/* The journal as a script under this name, which begins with the line that
 * plays it, and ends with a pause. */
static Status write_journal(Player *player, const char *name, const char *line)
{
    const Command pause = {.kind = COMMAND_PAUSE};
    Script *journal = &player->journal;
    size_t count = journal->count;
    Status status = STATUS_OK;
    if (!player_stands(player))
        status = script_add(journal, player->past.step, &pause, 0);
    if (!status)
        status = script_write(name, line, journal);
    journal->count = count;
    return status;
}

/* The hash of the state and the line that leads to it, whole on the terminal;
 * where commands have led here they are written down as a script, which leads
 * here again and stays. */
Status obey_hash(Player *player, const Command *command)
{
    char name[80], hash[64];
    bool commands = player->journal.count > 0;
    free_name(player, ".script", name, sizeof name);
    char *line = make_line(player, commands ? name : NULL);
    Status status = line ? STATUS_OK : STATUS_OUT_OF_MEMORY;
    if (!status && commands)
        status = write_journal(player, name, line);
    snprintf(hash, sizeof hash, "state %016llx at step %ld",
             (unsigned long long)player_hash(player), player->past.step);
    if (status) {
        player_note(player, "%s: no script: %s", hash, output_reason(status));
    } else {
        const char *where = commands ? name : "the terminal";
        bool fits = strlen(line) <= NOTE_LINE;
        player_note(player, "%s: %s%s", hash, fits ? "" : "its line is in ",
                    fits ? line : where);
        fprintf(stderr, "%s: %s\n", hash, line);
    }
    free(line);
    return STATUS_OK;
}
