/* sheet.c - the sheet: live small pictures of the scenes. */
#include <stdio.h>
#include <stdlib.h>

#include "base/clock.h"
#include "play/playing.h"
#include "lesson/pages.h"
#include "scenes/scenes.h"

enum {
    CELL_LIFE_FRAMES = 240, /* frames until the scene of a cell begins again */
    CELL_PAUSE_FRAMES = 24 /* frames between two steps in scenes without time */
};

/* Computing time in a frame of the window for the steps of all scenes, s */
static const double STEP_TIME = 0.008;

/* The first cell shows the tour's pages in turn, each other cell a scene. */
typedef struct Sheet {
    int cell_count; /* number of cells */
    int next_cell;  /* index of the cell that gets the next step */
    int next_page;  /* index of the page that the first cell shows next */
    int cell_age[LAYOUT_MAX_CELLS]; /* turns of each cell, one per frame */
    Simulation simulation[LAYOUT_MAX_CELLS];
} Sheet;

void sheet_close(Player *player)
{
    Sheet *sheet = player->screen.sheet;
    for (int i = 0; sheet && i < sheet->cell_count; i++)
        simulation_free(&sheet->simulation[i]);
    free(sheet);
    player->screen.sheet = NULL;
}

/* Closes the sheet, or opens it and selects the scene's cell or the tour's. */
Status obey_toggle_sheet(Player *player, const Command *command)
{
    const Options *options = player_get_active_options(player);
    bool opens = !player->screen.sheet;
    sheet_close(player);
    player_deselect(player);
    if (!opens)
        return STATUS_OK;
    Sheet *sheet = player->screen.sheet = calloc(1, sizeof *sheet);
    if (!sheet)
        return STATUS_OUT_OF_MEMORY;
    const Scene *scene = scenes; /* scene of cell 1; cell 0 is the tour */
    while (++sheet->cell_count < LAYOUT_MAX_CELLS && scene->name &&
           !scene->is_hidden)
        scene++;
    player->screen.view.selected_cell =
        options->page || options->scene->is_hidden
            ? 0
            : (int)(options->scene - scenes) + 1;
    return STATUS_OK;
}

/* Begins the scene of a cell; a cell that fails stays empty. */
static void begin_scene_of_cell(Sheet *sheet, int i)
{
    char message[256];
    Options options;
    Simulation *simulation = &sheet->simulation[i];
    const LecturePage *page = &lecture_pages[sheet->next_page];
    Status status = i == 0
                        ? lecture_make_options(page, &options, MESSAGE(message))
                        : options_parse_line(scenes[i - 1].name, &options,
                                             MESSAGE(message));
    simulation_free(simulation);
    if (i == 0)
        sheet->next_page = page[1].name ? sheet->next_page + 1 : 0;
    if (!status && simulation_create(&options, NULL, NULL, simulation))
        simulation_free(simulation);
}

void sheet_advance_cells(Player *player)
{
    Sheet *sheet = player->screen.sheet;
    double begin = clock_now();
    if (!sheet)
        return;
    for (int i = 0; i < sheet->cell_count; i++) {
        if (player->screen.window && clock_now() - begin > STEP_TIME)
            break;
        int cell = sheet->next_cell, age = sheet->cell_age[cell]++;
        Simulation *simulation = &sheet->simulation[cell];
        if (age % CELL_LIFE_FRAMES == 0)
            begin_scene_of_cell(sheet, cell);
        else if (simulation->scene && !simulation->is_over &&
                 !status_is_failure(simulation->status) &&
                 ((simulation->scene->traits & HAS_TIME) ||
                  age % CELL_PAUSE_FRAMES == 0))
            simulation_step(simulation);
        sheet->next_cell = (cell + 1) % sheet->cell_count;
    }
    player->screen.must_redraw = true;
}

void sheet_build_content(const Player *player, FrameContent *content)
{
    const Sheet *sheet = player->screen.sheet;
    content->sheet.cells = sheet->cell_count;
    for (int i = 0; i < sheet->cell_count; i++) {
        const Scene *scene = &scenes[i > 0 ? i - 1 : 0];
        const Simulation *simulation = &sheet->simulation[i];
        content->sheet.cell[i] =
            (SheetCell){.name = i > 0 ? scene->name : "the guided tour",
                        .heading = i == 1 ? NULL : scene->group_heading,
                        .simulation = simulation->scene ? simulation : NULL};
        if (i == player->screen.view.selected_cell)
            snprintf(content->title_bar.sentence, SENTENCE_SIZE, "%s: %s",
                     content->sheet.cell[i].name,
                     i > 0 ? scene->description : "the lecture, page by page");
    }
    content->title_bar.topic = "Scenes";
    snprintf(content->title_bar.method, SENTENCE_SIZE, "arrows, Enter");
    snprintf(content->title_bar.state, VALUE_SIZE,
             "digits: a page of the tour");
}

/* Opens the scene or page of the chosen cell by a command, which scripts can
 * repeat.  An open page stays if the chosen cell is the tour. */
Status obey_open_sheet_cell(Player *player, const Command *command)
{
    char line[32] = "page-on";
    int cell = player->screen.view.selected_cell;
    bool behind = cell == 0 && player_get_active_options(player)->page;
    if (cell > 0)
        snprintf(line, sizeof line, "scene %s", scenes[cell - 1].name);
    sheet_close(player);
    player_deselect(player);
    return behind ? STATUS_OK : player_enqueue_lines(player, line);
}
