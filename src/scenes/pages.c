#include "scenes/pages.h"

#include <stdlib.h>
#include <string.h>

int lecture_count(void)
{
    int count = 0;
    while (lecture_pages[count].name)
        count++;
    return count;
}

const LecturePage *lecture_find(const char *text)
{
    char *end = NULL;
    long number = strtol(text, &end, 10);
    if (end != text && *end == '\0')
        return number >= 1 && number <= lecture_count()
                   ? &lecture_pages[number - 1]
                   : NULL;
    for (const LecturePage *page = lecture_pages; page->name; page++)
        if (strcmp(page->name, text) == 0)
            return page;
    return NULL;
}

Status lecture_options(const LecturePage *page, Options *options, char *message,
                       size_t size)
{
    Status status = options_of_line(page->line, options, message, size);
    options->page = page;
    options->flips = page->flips;
    options->speed = page->speed;
    return status;
}
