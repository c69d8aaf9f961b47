/* handout.c - the lecture as one HTML file, to be printed, two pages a sheet:
 * words, formulas, a picture drawn for print, a question with room to write.
 * Everything stands in the file itself: it has no scripts and asks no network.
 * How it begins stands in handout.html.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "picture/picture.h"
#include "play/playing.h"
#include "scenes/listing.h"
#include "scenes/pages.h"
#include "scenes/scene.h"

enum {
    PICTURE_WIDTH = 1900, /* pixels, of 190 mm */
    PICTURE_HEIGHT = 720,
    PICTURE_EM = 25,
    INKS = 5, /* steps between white and a colour's darkest */
    WORDS = 1024
};

/* ---- text --------------------------------------------------------------- */

/* What opens a part of a formula, and what it is in HTML up to its end. */
typedef struct Mark {
    const char *opens, *html, *closes;
    const char *part, *between; /* and between its parts */
    const char *part_of_row;
} Mark;

static const Mark marks[] = {
    {"^{", "<sup>", "</sup>", NULL, NULL, NULL},
    {"_{", "<sub>", "</sub>", NULL, NULL, NULL},
    {"frac{", "<span class=\"frac\"><span>", "</span></span>", " over ",
     "</span><span>", NULL},
    {"sqrt{", "\u221a<span class=\"root\">", "</span>", NULL, NULL, NULL},
    {"matrix{", "<table><tr><td>", "</td></tr></table>", "; ",
     "</td></tr><tr><td>", "& "},
};
static const Mark coloured = {"#", "", "</span>", NULL, NULL, NULL};

static bool begins(const char *text, const char *with)
{
    return with && strncmp(text, with, strlen(with)) == 0;
}

/* The mark that opens here, or NULL. */
static const Mark *find_mark(const char *text)
{
    for (size_t i = 0; i < sizeof marks / sizeof *marks; i++)
        if (begins(text, marks[i].opens))
            return &marks[i];
    size_t name = strspn(text + 1, "abcdefghijklmnopqrstuvwxyz");
    return *text == '#' && text[1 + name] == '{' ? &coloured : NULL;
}

/* A word in its colour begins: #name{; returns where it goes on. */
static const char *open_colour(FILE *file, const char *name)
{
    size_t length = strcspn(name, "{}");
    fprintf(file, "<span style=\"color:#%06x\">",
            colour_named(name, length) & 0xffffffu);
    return name + length + 1;
}

/* Markup (text.h) as HTML; & and < are written out. */
static void write_text(FILE *file, const char *text)
{
    static const char *const letters[][2] = {
        {"{x}", "x"}, {"{xt}", "x\u0303"}, {"{p}", "p"}, {"{alpha}", "\u03b1"}};
    const Mark *open[16] = {NULL};
    int depth = 0;
    while (*text) {
        const Mark *mark = find_mark(text), *in = open[depth];
        size_t letter = 0;
        while (letter < 4 && !begins(text, letters[letter][0]))
            letter++;
        if (mark && depth < 15) {
            open[++depth] = mark;
            text += strlen(mark->opens);
            if (mark == &coloured)
                text = open_colour(file, text);
            fputs(mark->html, file);
        } else if (letter < 4) {
            text = open_colour(file, text + 1);
            fprintf(file, "%s</span>", letters[letter][1]);
        } else if (in && *text == '}') {
            fputs(open[depth--]->closes, file);
            text++;
        } else if (in && begins(text, in->part)) {
            text += strlen(in->part);
            fputs(in->between, file);
        } else if (in && begins(text, in->part_of_row)) {
            text += strlen(in->part_of_row);
            fputs("</td><td>", file);
        } else {
            const char *escaped = *text == '&'   ? "&amp;"
                                  : *text == '<' ? "&lt;"
                                                 : NULL;
            if (escaped)
                fputs(escaped, file);
            else
                fputc(*text, file);
            text++;
        }
    }
    while (depth > 0)
        fputs(open[depth--]->closes, file);
}

/* <p> or another element, a head in bold, and what is known of the text now,
 * line by line; nothing where nothing is. */
static void write_said(FILE *file, Show *show, const char *element,
                       const char *head, const char *text)
{
    char words[WORDS] = "";
    if (text)
        show_say(show, text, words, sizeof words);
    if (!words[0])
        return;
    fprintf(file, *head ? "<%s><b>%s</b> " : "<%s>", element, head);
    for (char *line = words; line;) {
        char *next = strchr(line, '\n');
        if (next)
            *next++ = '\0';
        write_text(file, line);
        if (next)
            fputs("<br>", file);
        line = next;
    }
    fprintf(file, "</%.*s>\n", (int)strcspn(element, " "), element);
}

/* ---- pictures ----------------------------------------------------------- */

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

/* Goes to what the page's picture shows: what it opens with, and so many lines
 * or steps more. */
static Status go_to_picture(Player *player, const LecturePage *page)
{
    const Command next = {.kind = COMMAND_NEXT};
    if (!page->open && !page->tell && !page->lines)
        return player_run(player);
    Status status = player_open_page(player);
    if (!status)
        status = player_obey_lines(player, page->tell);
    for (int i = 0; i < page->lines && !status; i++)
        status = player_obey(player, &next);
    return status || page->lines ? status : player_run(player);
}

/* Stage and cards alone, in few shades, so that the file is small. */
static Status draw_picture(Player *player, FILE *file)
{
    char *bytes = NULL;
    size_t size = 0;
    Paper *paper = view_paper(player->view);
    FILE *picture = paper ? open_memstream(&bytes, &size) : NULL;
    if (!picture)
        return STATUS_OUT_OF_MEMORY;
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

/* Plays the page without a screen. */
static Status play_page(Options *options, const volatile sig_atomic_t *stop,
                        Player *player)
{
    const LecturePage *page = options->page;
    options->headless = options->quiet = true;
    options->steps = page->picture;
    Status status = player_create(options, 1, "elasto", stop, player);
    if (!status)
        status = view_create(PICTURE_WIDTH, PICTURE_HEIGHT, &player->view);
    if (!status)
        status = go_to_picture(player, page);
    if (status && status == player->past.machine[0].simulation.status)
        status = STATUS_OK; /* the end of the run is what the page shows */
    return *stop && !status ? STATUS_INTERRUPTED : status;
}

/* ---- pages -------------------------------------------------------------- */

/* The page that the player shows. */
static Status write_page(FILE *file, const LecturePage *page, Player *player)
{
    Show *show = &player->show;
    player_fill(player);
    fprintf(file, "<section>\n<h2 id=\"%s\">%d. ", page->name,
            (int)(page - lecture_pages) + 1);
    write_text(file, page->topic);
    fputs("</h2>\n<div class=\"say\">", file);
    write_said(file, show, "p", "", page->text);
    write_said(file, show, "div", "", page->formula);
    fputs("</div>\n", file);
    write_said(file, show, "p", "Question:", page->ask);
    fputs("<img alt=\"", file);
    write_text(file, page->topic);
    fputs("\" src=\"data:image/png;base64,\n", file);
    Status status = draw_picture(player, file);
    fputs("\n\">\n", file);
    write_said(file, show, "p class=\"small\"", "Look:", page->look);
    write_said(file, show, "p class=\"small\"", "Try:", page->touch);
    fprintf(file,
            "<p class=\"small\"><a href=\"elasto.html#--lecture+%s\">"
            "live: elasto.html#--lecture+%s</a> or <code>elasto %s</code></p>"
            "\n",
            page->name, page->name, page->line);
    fputs("<div class=\"room\"><hr><hr><hr></div>\n</section>\n", file);
    return status;
}

Status handout_write(const Options *options, const volatile sig_atomic_t *stop,
                     Player *player, char *message, size_t size)
{
    Output output;
    const Listing *head = listing_find("src/play/handout.html");
    message[0] = '\0';
    Status status = output_open(options->handout, &output);
    if (status)
        return status;
    for (int i = 0; i < head->lines; i++)
        fprintf(output.file, "%s\n", head->line[i]);
    for (const LecturePage *page = lecture_pages; page->name && !status;
         page++) {
        Options of_page;
        status = lecture_options(page, &of_page, message, size);
        if (status)
            break; /* which a test rules out */
        status = play_page(&of_page, stop, player);
        if (!status)
            status = write_page(output.file, page, player);
        player_free(player);
    }
    if (status) {
        output_discard(&output, false);
        return status;
    }
    fputs("</body>\n</html>\n", output.file);
    return output_close(&output);
}
