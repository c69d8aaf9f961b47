#include "scenes/pages.h"

#include <string.h>

int lecture_count(void)
{
    return names_count(NAMES_OF(lecture_pages));
}

const LecturePage *lecture_find(const char *text)
{
    int place = name_or_number(NAMES_OF(lecture_pages), text);
    return place < 0 ? NULL : &lecture_pages[place];
}

Status lecture_options(const LecturePage *page, Options *options, char *message,
                       size_t size)
{
    Status status = options_of_line(page->line, options, message, size);
    const char *pin = strstr(page->line, "--pin ");
    if (pin) /* the line's last option: its text stays */
        options->pin = pin + strlen("--pin ");
    options->page = page;
    options->flips = page->flips;
    options->speed = page->speed;
    return status;
}
