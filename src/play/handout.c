/* handout.c - the lecture as one HTML file, to be printed: words and a picture
 * of every page, which is what the window shows of it.  Everything stands in
 * the file itself: it has no scripts and asks no network.
 */
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "play/playing.h"
#include "scenes/pages.h"
#include "scenes/scene.h"

enum { PICTURE_WIDTH = 1120, PICTURE_HEIGHT = 700 }; /* pixels */

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
    ".small { font-size: .85em; color: #6a6a6a; }\n"
    "@media print { section { break-inside: avoid; } }\n"
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

/* Goes to what the page's picture shows: what it opens with, and so many lines
 * more, or a step. */
static Status go_to_picture(Player *player, const LecturePage *page)
{
    const Command next = {.kind = COMMAND_NEXT};
    if (!page->open)
        return player_run(player);
    Status status = player_open_page(player);
    for (int i = 0; i < page->lines && !status; i++)
        status = player_obey(player, &next);
    return status;
}

static Status draw_picture(Player *player, const char *name)
{
    Paper *paper = view_paper(player->view);
    if (!paper)
        return STATUS_OUT_OF_MEMORY;
    player_paint(player, paper);
    return png_file_write(name, &paper->canvas);
}

/* Plays the page without a screen.  name in, of the file with its picture */
static Status play_page(const LecturePage *page,
                        const volatile sig_atomic_t *stop, Player *player,
                        const char *name, char *message, size_t size)
{
    Options options;
    Status status = lecture_options(page, &options, message, size);
    if (status)
        return status;
    options.headless = options.quiet = true;
    options.steps = page->picture;
    status = player_create(&options, 1, "elasto", stop, player);
    if (!status)
        status =
            view_create_surface(PICTURE_WIDTH, PICTURE_HEIGHT, &player->view);
    if (!status)
        status = go_to_picture(player, page);
    if (status && status == player->past.machine[0].simulation.status)
        status = STATUS_OK; /* the end of the run is what the page shows */
    if (!status)
        status = *stop ? STATUS_INTERRUPTED : draw_picture(player, name);
    player_free(player);
    return status;
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
            "\n\">\n<p class=\"small\"><a href=\"elasto.html#--lecture+%s\">"
            "live</a>; <code>elasto --lecture %s</code> or "
            "<code>elasto %s</code></p>\n",
            page->name, page->name, page->line);
    write_paragraph(file, "Look:", page->look);
    write_paragraph(file, "Try:", page->touch);
    write_paragraph(file, "Tested:", page->claim);
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

/* Pictures are made beside the handout and go when they stand in it. */
Status handout_write(const Options *options, const volatile sig_atomic_t *stop,
                     Player *player, char *message, size_t size)
{
    Output output;
    char name[PATH_MAX];
    message[0] = '\0';
    snprintf(name, sizeof name, "%s.png", options->handout);
    Status status = output_open(options->handout, &output);
    if (status)
        return status;
    fputs(handout_head, output.file);
    write_contents(output.file);
    for (int i = 1; i <= lecture_count() && !status; i++) {
        status = write_page(output.file, i, stop, player, name, message, size);
        if (!status)
            status = output_check(&output);
    }
    int reason = errno;
    unlink(name);
    errno = reason;
    if (status) {
        output_discard(&output, false);
        return status;
    }
    fputs("</body>\n</html>\n", output.file);
    return output_close(&output);
}
