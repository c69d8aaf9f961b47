/* handout.c - the lecture as one HTML file for a course's page: words, pictures
 * and films of every page.
 *
 * The pictures are what the window shows, played without a screen; films are
 * animated PNGs.  Everything stands in the file itself: it has no scripts and
 * asks no network.
 */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "play/playing.h"
#include "scenes/listing.h"
#include "scenes/pages.h"
#include "scenes/scene.h"

enum {
    STILL_WIDTH = 1120, /* pixels of the pictures */
    STILL_HEIGHT = 700,
    FILM_WIDTH = 736, /* and of the films */
    FILM_HEIGHT = 460
};

static const char handout_head[] =
    "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
    "<meta name=\"viewport\" content=\"width=device-width\">\n"
    "<title>Reliable simulation of elastodynamics: handout</title>\n"
    "<style>\n"
    "body { font: 17px/1.5 \"DejaVu Sans\", Verdana, sans-serif; color: "
    "#1c1c1c;\n"
    "  max-width: 1120px; margin: 2em auto; padding: 0 1em; }\n"
    "h1 { font-size: 1.7em; } h2 { margin: 2.2em 0 .3em; }\n"
    "img { width: 100%; height: auto; border: 1px solid #cfcfcf; }\n"
    "nav { columns: 2; font-size: .9em; } nav a { display: block; }\n"
    "a { color: #0044b0; text-decoration: none; }\n"
    "b { color: #0000ff; }\n"
    "pre { font: 13px/1.35 \"DejaVu Sans Mono\", monospace; background: "
    "#f6f6f6;\n"
    "  padding: .8em; overflow-x: auto; }\n"
    "mark { background: #fff1cd; } .small { font-size: .85em; color: #6a6a6a; "
    "}\n"
    "@media print { section { break-inside: avoid; } details { display: none; "
    "} }\n"
    "</style>\n</head>\n<body>\n"
    "<h1>Reliable simulation of elastodynamics</h1>\n"
    "<p>Every page is a scene of the program elasto; what stands below a "
    "picture opens\nit there, to be touched. What a page claims is held by a "
    "test.</p>\n";

/* ---- text --------------------------------------------------------------- */

/* With what HTML takes for its own written out. */
static void write_escaped(FILE *file, const char *text)
{
    for (; *text; text++)
        if (*text == '&')
            fputs("&amp;", file);
        else if (*text == '<')
            fputs("&lt;", file);
        else
            fputc(*text, file);
}

/* The function with the lines at work marked. */
static void write_code(FILE *file, const LecturePage *page)
{
    const Listing *listing = listing_find(page->file);
    int from, body, to;
    if (!listing ||
        !listing_function(listing, page->function, &from, &body, &to))
        return;
    fputs("<details><summary>Its code: ", file);
    write_escaped(file, page->function);
    fprintf(file, " in %s, from line %d</summary>\n<pre>", page->file,
            body + 1);
    for (int i = from; i < to; i++) {
        bool lit = i >= body && strstr(listing->line[i], page->lit);
        fputs(lit ? "<mark>" : "", file);
        write_escaped(file, listing->line[i]);
        fputs(lit ? "</mark>\n" : "\n", file);
    }
    fputs("</pre></details>\n", file);
}

/* <p>, a head in bold if there is one, and the text. */
static void write_paragraph(FILE *file, const char *head, const char *text)
{
    fprintf(file, *head ? "<p><b>%s</b> " : "<p>%s", head);
    write_escaped(file, text);
    fputs("</p>\n", file);
}

/* ---- pictures ----------------------------------------------------------- */

/* A file in base 64 (RFC 4648): four letters for each three bytes, '=' where
 * bytes lack. */
static Status write_base64(FILE *file, const char *name)
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                  "abcdefghijklmnopqrstuvwxyz0123456789+/";
    FILE *picture = fopen(name, "rb");
    if (!picture)
        return STATUS_FILE_FAILED;
    for (size_t count = 3, row = 0; count == 3; row++) {
        unsigned char byte[3] = {0};
        count = fread(byte, 1, 3, picture);
        unsigned bits =
            (unsigned)byte[0] << 16 | (unsigned)byte[1] << 8 | byte[2];
        for (size_t i = 0; i < 4 && count > 0; i++)
            fputc(i <= count ? letters[bits >> (18 - 6 * i) & 63] : '=', file);
        if (row % 19 == 18) /* 76 letters a line */
            fputc('\n', file);
    }
    Status status = ferror(picture) ? STATUS_FILE_FAILED : STATUS_OK;
    fclose(picture);
    return status;
}

/* The lines that the page opens with, and those after them, a frame each. */
static Status play_lines(Player *player, const LecturePage *page)
{
    const Command next = {.kind = COMMAND_NEXT};
    Status status = player_open_page(player);
    for (int i = 0; i <= page->lines && !status; i++) {
        Paper *paper = view_paper(player->view);
        if (!paper)
            return STATUS_OUT_OF_MEMORY;
        player_paint(player, paper);
        status = film_add(&player->recording.film, &paper->canvas, 1);
        if (!status && i < page->lines)
            status = player_obey(player, &next);
    }
    return status;
}

/* Plays the page without a screen into a film, of one picture if it has no
 * more.  name in, where the film shall stand */
static Status play_page(const LecturePage *page,
                        const volatile sig_atomic_t *stop, Player *player,
                        const char *name, char *message, size_t size)
{
    Options options;
    Status status = lecture_options(page, &options, message, size);
    if (status)
        return status;
    options.headless = options.quiet = true;
    options.film = name;
    bool moves = page->film > 0 || page->lines > 0;
    options.size[0] = moves ? FILM_WIDTH : STILL_WIDTH;
    options.size[1] = moves ? FILM_HEIGHT : STILL_HEIGHT;
    options.steps = page->film;
    status = player_create(&options, 1, "elasto", stop, player);
    double every = page->every > 1 ? page->every : 1;
    player->recording.film_every = (long)every;
    player->recording.film.rate =
        page->lines ? 1 : fmin(player_rate(player), FILM_RATE) / every;
    if (!status && (page->open || page->lines))
        status = play_lines(player, page);
    else if (!status)
        status = player_run(player);
    if (status && status == player->past.machine[0].simulation.status)
        status = STATUS_OK; /* the end of the run is what the page shows */
    Status finished = player_finish(player);
    if (player->recording.message[0])
        snprintf(message, size, "%s", player->recording.message);
    if (!status && *stop)
        status = STATUS_INTERRUPTED;
    player_free(player);
    return status ? status : finished;
}

static Status write_page(FILE *file, int number,
                         const volatile sig_atomic_t *stop, Player *player,
                         const char *name, char *message, size_t size)
{
    const LecturePage *page = &lecture_pages[number - 1];
    fprintf(file, "<section>\n<h2 id=\"%s\">%d. ", page->name, number);
    write_escaped(file, page->topic);
    fputs("</h2>\n", file);
    write_paragraph(file, "", page->text);
    Status status = play_page(page, stop, player, name, message, size);
    if (status)
        return status;
    fputs("<img alt=\"", file);
    write_escaped(file, page->topic);
    fputs("\" src=\"data:image/png;base64,\n", file);
    status = write_base64(file, name);
    fprintf(file,
            "\n\">\n<p class=\"small\"><code>elasto --lecture %s</code> or "
            "<code>elasto %s</code></p>\n",
            page->name, page->line);
    write_paragraph(file, "Look:", page->look);
    write_paragraph(file, "Try:", page->touch);
    write_paragraph(file, "Tested:", page->claim);
    write_code(file, page);
    fputs("</section>\n", file);
    return status;
}

static void write_contents(FILE *file)
{
    fputs("<nav>\n", file);
    for (int i = 0; lecture_pages[i].name; i++) {
        fprintf(file, "<a href=\"#%s\">%d. ", lecture_pages[i].name, i + 1);
        write_escaped(file, lecture_pages[i].topic);
        fputs("</a>\n", file);
    }
    fputs("</nav>\n", file);
}

/* Films are made beside the handout and go when they stand in it. */
Status handout_write(const Options *options, const volatile sig_atomic_t *stop,
                     Player *player, char *message, size_t size)
{
    Output output;
    size_t room = strlen(options->handout) + sizeof ".film.apng";
    char *name = malloc(room);
    message[0] = '\0';
    if (!name)
        return STATUS_OUT_OF_MEMORY;
    if (!film_is_possible()) {
        snprintf(message, size,
                 "its pictures need the program ffmpeg: apt-get "
                 "install ffmpeg");
        free(name);
        return STATUS_INVALID_INPUT;
    }
    snprintf(name, room, "%s.film.apng", options->handout);
    Status status = output_open(options->handout, &output);
    if (!status) {
        fputs(handout_head, output.file);
        write_contents(output.file);
    }
    for (int i = 1; i <= lecture_count() && !status; i++) {
        status = write_page(output.file, i, stop, player, name, message, size);
        if (!status)
            status = output_check(&output);
    }
    int reason = errno;
    unlink(name);
    free(name);
    errno = reason;
    if (status) {
        output_discard(&output, false);
        return status;
    }
    fputs("</body>\n</html>\n", output.file);
    return output_close(&output);
}
