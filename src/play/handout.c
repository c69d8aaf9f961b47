/* handout.c - the lecture as one HTML file, to be printed, two pages a sheet:
 * what the window shows of each, drawn for print, its question, and room to
 * write.  Everything stands in the file itself: it has no scripts and asks no
 * network.  How it begins stands in handout.html.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "picture/picture.h"
#include "play/playing.h"
#include "lesson/pages.h"
#include "run/scene.h"

extern const char handout_head[]; /* handout.html, by the Makefile */

enum {
    PICTURE_WIDTH = 1360, /* pixels, of 190 mm */
    PICTURE_HEIGHT = 720,
    PICTURE_EM = 16,
    INKS = 5 /* steps between white and a colour's darkest */
};

/* Bytes in base 64 (RFC 4648): four letters for each three bytes, '=' where
 * bytes lack; 76 letters a line. */
static void write_base64(FILE *file, const char *bytes, size_t size)
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                  "abcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t at = 0; at < size; at += 3) {
        unsigned bits = 0;
        for (size_t i = at; i < at + 3; i++)
            bits = bits << 8 | (i < size ? (unsigned char)bytes[i] : 0);
        for (size_t i = 0; i < 4; i++)
            fputc(at + i <= size ? letters[bits >> (18 - 6 * i) & 63] : '=',
                  file);
        if (at / 3 % 19 == 18)
            fputc('\n', file);
    }
}

/* Stage and cards, in few shades, so that the file is small. */
static Status draw_picture(Player *player, FILE *file)
{
    char *bytes = NULL;
    size_t size = 0;
    Paper *paper = player_paper(player);
    FILE *picture = paper ? open_memstream(&bytes, &size) : NULL;
    if (!picture)
        return STATUS_OUT_OF_MEMORY;
    player_fill(player);
    player->show.print = true;
    player->show.letter = PICTURE_EM;
    show_draw(paper, &player->show);
    Canvas *canvas = &paper->canvas;
    for (size_t i = 0; i < (size_t)canvas->width * canvas->height; i++) {
        Colour shade = 0xff000000u;
        for (int shift = 0; shift < 24; shift += 8) {
            Colour value = canvas->pixels[i] >> shift & 255;
            shade |= (value * INKS + 127) / 255 * (255 / INKS) << shift;
        }
        canvas->pixels[i] = shade;
    }
    Status status = png_write(picture, canvas, true);
    if (fclose(picture) == 0)
        write_base64(file, bytes, size);
    free(bytes);
    return status;
}

/* Plays the page without a screen up to what its picture shows: what it opens
 * with, and so many lines or steps more. */
static Status play_page(Options *options, const volatile sig_atomic_t *stop,
                        Player *player)
{
    const LecturePage *page = options->page;
    const Command next = {.kind = COMMAND_NEXT};
    options->headless = options->quiet = true;
    options->steps = page->picture;
    Status status = player_create(options, 1, NULL, stop, player);
    player->draws = true;
    player->size[0] = PICTURE_WIDTH;
    player->size[1] = PICTURE_HEIGHT;
    if (!status)
        status = player_open_page(player);
    if (!status)
        status = player_obey_lines(player, page->tell);
    for (int i = 0; i < page->lines && !status; i++)
        status = player_obey(player, &next);
    if (!status && !page->lines)
        status = player_run(player);
    if (status && status == player->past.machine[0].simulation.status)
        status = STATUS_OK; /* the end of the run is what the page shows */
    return *stop && !status ? STATUS_INTERRUPTED : status;
}

Status handout_write(const Options *options, const volatile sig_atomic_t *stop,
                     char *told, Player *player)
{
    Output output;
    Status status = output_open(options->handout, told, &output);
    FILE *file = output.file;
    if (status)
        return status;
    fputs(handout_head, file);
    for (int i = 0; lecture_pages[i].name && !status; i++) {
        const LecturePage *page = &lecture_pages[i];
        Options of_page;
        char message[256];
        status = lecture_options(page, &of_page, message, sizeof message);
        if (status)
            break; /* which a test rules out */
        status = play_page(&of_page, stop, player);
        fprintf(file,
                "<section>\n<h2 id=\"%s\">%d. %s</h2>\n"
                "<img alt=\"%s\" src=\"data:image/png;base64,\n",
                page->name, i + 1, page->topic, page->topic);
        if (!status)
            status = draw_picture(player, file);
        fprintf(
            file,
            "\n\">\n<p class=\"small\"><a href=\"elasto.html#--lecture+%s\">"
            "live: elasto.html#--lecture+%s</a> or <code>elasto %s</code>"
            "</p>\n<div class=\"room\"><hr><hr></div>\n</section>\n",
            page->name, page->name, page->line);
        player_free(player);
    }
    fputs("</body>\n</html>\n", file);
    Status closed = output_close(&output, status ? KEEP_NOTHING : KEEP_WHOLE);
    return status ? status : closed;
}
