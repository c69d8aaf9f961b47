/* film_web.c - films in a page: its browser films the canvas while it is drawn
 * and gives the film as a download.
 */
#include "play/recording.h"

#include <emscripten.h>
#include <stdlib.h>
#include <string.h>

/* clang-format off */
EM_JS(int, page_films, (void), { return Page.films() ? 1 : 0; });
EM_JS(void, page_film, (const char *name), { Page.film(UTF8ToString(name)); });
EM_JS(void, page_film_end, (int keep), { Page.filmEnd(keep); });
/* clang-format on */

Status film_open(const char *name, Film *film)
{
    *film = (Film){0};
    if (!page_films()) {
        film->reason = "this browser makes no films of a page";
        return STATUS_INVALID_INPUT;
    }
    film->output.name = strdup(name);
    if (!film->output.name)
        return STATUS_OUT_OF_MEMORY;
    page_film(name);
    return STATUS_OK;
}

Status film_add(Film *film, const Canvas *canvas, int shown)
{
    (void)canvas;
    film->frames += shown;
    return STATUS_OK;
}

Status film_close(Film *film)
{
    bool empty = film->frames == 0;
    if (!film_runs(film))
        return STATUS_OK;
    page_film_end(!empty);
    free(film->output.name);
    *film = (Film){.reason = empty ? "no frame was drawn" : NULL};
    return empty ? STATUS_FILE_FAILED : STATUS_OK;
}
