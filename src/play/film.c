#include "play/film.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "scenes/one_line.h"

struct FilmKind {
    const char *end;   /* of the name; without its dot the name of the format */
    int rate;          /* frames a second */
    const char *words; /* what ffmpeg is told behind its input */
};

static const FilmKind film_kinds[] = {
    {".mp4", FILM_RATE,
     "-vf 'pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white,format=yuv420p'"},
    {".webm", FILM_RATE,
     "-c:v libvpx-vp9 -crf 30 -b:v 0 -deadline realtime -cpu-used 5"},
    {".gif", 50, /* each frame with colours of its own */
     "-vf 'split[a][b];[a]palettegen=stats_mode=single[p];"
     "[b][p]paletteuse=new=1'"},
    {".apng", FILM_RATE, "-pix_fmt rgb24 -plays 0"},
};

/* The kind that the end of the name says, or NULL. */
static const FilmKind *kind_of(const char *name)
{
    size_t length = strlen(name);
    for (size_t i = 0; i < sizeof film_kinds / sizeof *film_kinds; i++) {
        size_t end = strlen(film_kinds[i].end);
        if (length > end && !strcmp(name + length - end, film_kinds[i].end))
            return &film_kinds[i];
    }
    return NULL;
}

Status film_open(const char *name, Film *film, char *message, size_t size)
{
    char shown[128];
    one_line(name, shown, sizeof shown);
    *film = (Film){.kind = kind_of(name)};
    if (!film->kind)
        snprintf(message, size,
                 "--film: '%s' does not end in .mp4, .webm, .gif or .apng",
                 shown);
    else if (system("command -v ffmpeg >/dev/null 2>&1") != 0)
        snprintf(message, size,
                 "--film: '%s' needs the program ffmpeg: apt-get install "
                 "ffmpeg; --frames DIR needs nothing",
                 shown);
    else {
        Status status = output_open(name, &film->output);
        if (status || film->output.temporary)
            return status;
        output_discard(&film->output, false);
        snprintf(message, size, "--film: '%s' is no regular file", shown);
    }
    return STATUS_INVALID_INPUT;
}

bool film_runs(const Film *film)
{
    return film->output.file != NULL;
}

/* With the first frame, whose size the film has.  ffmpeg's words go nowhere; a
 * session of its own keeps Ctrl+C from it: the film ends when the pipe does. */
static Status start_ffmpeg(Film *film, const Canvas *canvas)
{
    char line[512];
    size_t count = (size_t)canvas->width * (size_t)canvas->height;
    film->width = canvas->width;
    film->height = canvas->height;
    film->frame = malloc(count * sizeof *film->frame);
    if (!film->frame || setenv("ELASTO_FILM", film->output.temporary, 1))
        return STATUS_OUT_OF_MEMORY;
    snprintf(line, sizeof line,
             "exec $(command -v setsid) ffmpeg -loglevel quiet -y -f rawvideo "
             "-pixel_format bgr0 -video_size %dx%d -framerate %d -i pipe:0 %s "
             "-f %s \"file:$ELASTO_FILM\" >/dev/null 2>&1",
             film->width, film->height, film->kind->rate, film->kind->words,
             film->kind->end + 1);
    film->pipe = popen(line, "we");
    return film->pipe ? STATUS_OK : STATUS_FILE_FAILED;
}

Status film_add(Film *film, const Canvas *canvas, int shown)
{
    Status status = film->frame ? STATUS_OK : start_ffmpeg(film, canvas);
    if (status)
        return status;
    size_t row = (size_t)film->width;
    size_t there =
        (size_t)(canvas->width < film->width ? canvas->width : film->width);
    memset(film->frame, 0xff, row * (size_t)film->height * sizeof *film->frame);
    for (int y = 0; y < film->height && y < canvas->height; y++)
        memcpy(film->frame + row * (size_t)y,
               canvas->pixels + (size_t)canvas->width * (size_t)y,
               there * sizeof *film->frame);
    for (int i = 0; i < shown; i++, film->frames++)
        if (fwrite(film->frame, sizeof *film->frame * row, (size_t)film->height,
                   film->pipe) < (size_t)film->height) {
            film->reason = "ffmpeg ended before the film did";
            return STATUS_FILE_FAILED;
        }
    return STATUS_OK;
}

Status film_close(Film *film)
{
    struct stat info = {0};
    if (!film_runs(film))
        return STATUS_OK;
    bool well = film->pipe && pclose(film->pipe) == 0;
    bool full = stat(film->output.temporary, &info) == 0 && info.st_size > 0;
    const char *reason = film->reason;
    film->pipe = NULL;
    if (!reason && film->frames == 0)
        reason = "no frame was drawn for it";
    else if (!reason && (!well || !full))
        reason = "ffmpeg could not write it";
    Status status = reason ? STATUS_FILE_FAILED : output_close(&film->output);
    output_discard(&film->output, full);
    film_discard(film);
    film->reason = reason;
    return status;
}

void film_discard(Film *film)
{
    int reason = errno;
    if (film->pipe)
        pclose(film->pipe);
    output_discard(&film->output, false);
    free(film->frame);
    *film = (Film){0};
    errno = reason;
}
