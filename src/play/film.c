/* film.c - films of the drawn frames, encoded by the program ffmpeg. */
#include "play/recording.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Options of ffmpeg for pixels that all players can show.  Width and height
 * become even, as this format of pixels needs. */
#define COMMON "-vf 'pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white,format=yuv420p'"

static const struct FilmKind {
    const char *suffix;    /* end of the film's name: ".mp4" */
    int frame_rate;        /* frames a second */
    const char *arguments; /* options of ffmpeg for its output */
} film_kinds[] = {
    {".mp4", 60, COMMON},
    {".webm", 60,
     COMMON " -c:v libvpx-vp9 -crf 30 -b:v 0 -deadline realtime -cpu-used 5"},
    {".gif", 50, /* stats_mode=single makes a palette for each frame */
     "-vf 'split[a][b];[a]palettegen=stats_mode=single[p];"
     "[b][p]paletteuse=new=1'"},
    {".apng", 60, "-pix_fmt rgb24 -plays 0"},
    {NULL, 0, NULL},
};

/* Message if the program ffmpeg is missing. */
#ifdef __EMSCRIPTEN__
#define WHY_NO_FILM "a page makes no films; the program does"
#else
#define WHY_NO_FILM                                                            \
    "a film needs the program ffmpeg: apt-get install ffmpeg; "                \
    "--frames DIR needs nothing"
#endif

#define WHY_FFMPEG_FAILS "ffmpeg ended early; the disk may be full"

Status film_open(const char *name, char *message, Film *film)
{
    const char *end = strrchr(name, '.'), *why = NULL;
    *film = (Film){.kind = film_kinds};
    while (film->kind->suffix &&
           (!end || end == name || strcmp(end, film->kind->suffix)))
        film->kind++;
    if (!film->kind->suffix)
        why = "its name does not end in .mp4, .webm, .gif or .apng";
    else if (system("command -v ffmpeg >/dev/null 2>&1") != 0)
        why = WHY_NO_FILM;
    else if (output_open(name, message, &film->output))
        return STATUS_FILE_FAILED;
    return why ? output_fill_message(message, name, STATUS_INVALID_INPUT, why)
               : STATUS_OK;
}

/* Starts ffmpeg for frames of the size of the first one.  The messages of
 * ffmpeg are discarded.  setsid keeps Ctrl+C from ffmpeg: an interrupted film
 * is whole. */
static void start_ffmpeg(Film *film, const Canvas *canvas)
{
    char line[512];
    film->width = canvas->width;
    film->height = canvas->height;
    snprintf(line, sizeof line,
             "exec $(command -v setsid) ffmpeg -loglevel quiet -xerror -y "
             "-f rawvideo -pixel_format bgr0 -video_size %dx%d -framerate %d "
             "-i pipe:0 %s -f %s \"file:$ELASTO_FILM\" >/dev/null 2>&1",
             film->width, film->height, film->kind->frame_rate,
             film->kind->arguments, film->kind->suffix + 1);
    if (setenv("ELASTO_FILM", film->output.part_file_name, 1) == 0)
        film->pipe = popen(line, "we");
    if (film->pipe)
        setvbuf(film->pipe, NULL, _IOFBF, 1 << 16); /* a pipe's buffer size */
}

Status film_add_frame(Film *film, const Canvas *canvas, int times)
{
    const Colour white = 0xffffffffu;
    if (!film->pipe)
        start_ffmpeg(film, canvas);
    if (!film->pipe)
        return output_report_failure(&film->output, NULL);
    int both = canvas->width < film->width ? canvas->width : film->width;
    for (int i = 0; i < times * film->height; i++) {
        int y = i % film->height, there = y < canvas->height ? both : 0;
        size_t first = there > 0 ? (size_t)canvas->width * (size_t)y : 0;
        fwrite(canvas->pixels + first, sizeof white, (size_t)there, film->pipe);
        for (int x = there; x < film->width; x++)
            fwrite(&white, sizeof white, 1, film->pipe);
    }
    film->frame_count += times;
    if (!ferror(film->pipe))
        return STATUS_OK;
    return output_report_failure(&film->output, WHY_FFMPEG_FAILS);
}

Status film_close(Film *film, CloseAction keep)
{
    OutputFile *output = &film->output;
    struct stat info;
    Status status = STATUS_OK;
    if (!film_is_open(film))
        return STATUS_OK;
    bool well = film->pipe && pclose(film->pipe) == 0;
    bool full = stat(output->part_file_name, &info) == 0 && info.st_size > 0;
    if (!well || !full)
        status = output_report_failure(
            output, film->frame_count > 0 ? WHY_FFMPEG_FAILS
                                          : "no frame was drawn for it");
    Status closed = output_close(output, !full    ? KEEP_NOTHING
                                         : status ? KEEP_PART_FILE
                                                  : keep);
    return status ? status : closed;
}
