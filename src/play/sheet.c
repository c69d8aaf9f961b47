/* sheet.c - all scenes at once, as small pictures that live: the tour first,
 * which turns its pages, and then a cell for each row of the table of scenes.
 * The run waits behind them.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "play/playing.h"
#include "scenes/pages.h"
#include "scenes/scene.h"

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

/* All scenes, or the run again.  The one that is open is chosen. */
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
    player->sheet->cells = 1;
    for (const Scene *scene = scenes;
         scene->name && player->sheet->cells < LAYOUT_CELLS; scene++)
        player->sheet->cells++;
    player->show.chosen =
        options->page ? 0 : (int)(options->scene - scenes) + 1;
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

/* A frame of one scene: a step, or it begins again. */
static void live(Sheet *sheet, int i)
{
    Simulation *simulation = &sheet->simulation[i];
    int *age = &sheet->age[i];
    if (*age % LIFE == 0)
        begin_cell(sheet, i);
    else if (simulation->scene && !simulation->done &&
             (!simulation->status ||
              status_is_unconverged(simulation->status)) &&
             ((simulation->scene->needs & NEEDS_TIME) || *age % SLOW == 0))
        simulation_step(simulation);
    ++*age;
}

void player_live(Player *player)
{
    Sheet *sheet = player->sheet;
    double begin = clock_now();
    if (!sheet)
        return;
    for (int i = 0; i < sheet->cells && clock_now() - begin < LIVING; i++) {
        live(sheet, sheet->next);
        sheet->next = (sheet->next + 1) % sheet->cells;
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
    show->topic = "All scenes";
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
