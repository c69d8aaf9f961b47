#include "play/film.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "scenes/one_line.h"

/* ---- animated PNG -------------------------------------------------------
 * The file is a PNG whose picture is the first frame, with chunks that other
 * readers skip (APNG specification 1.0):
 *     IHDR acTL | fcTL IDAT... | fcTL fdAT... | ... IEND
 * acTL counts the frames, fcTL says where on the picture a frame goes and for
 * how long, fdAT is IDAT behind a running number.  Each frame holds only the
 * rectangle that has changed. */

enum {
    SIGNATURE = 8, /* bytes of a PNG before its first chunk */
    ACTL_SIZE = 8, /* bytes of the data of an acTL chunk */
    FCTL_SIZE = 26,
    CHUNK_FRAME = 12 /* bytes of a chunk around its data */
};

/* A part of the picture. */
typedef struct Area {
    int x, y, width, height;
} Area;

/* A growing piece of memory that libpng writes to. */
typedef struct Bytes {
    uint8_t *data;
    size_t count, size;
    bool failed;
} Bytes;

static void bytes_append(png_structp png, png_bytep data, size_t count)
{
    Bytes *bytes = png_get_io_ptr(png);
    if (bytes->count + count > bytes->size) {
        size_t size = 2 * (bytes->count + count);
        uint8_t *grown = realloc(bytes->data, size);
        if (!grown) {
            bytes->failed = true;
            png_error(png, "no memory");
        }
        bytes->data = grown;
        bytes->size = size;
    }
    memcpy(bytes->data + bytes->count, data, count);
    bytes->count += count;
}

static void bytes_flush(png_structp png)
{
    (void)png;
}

/* libpng's messages are not for standard error. */
static void png_failed(png_structp png, png_const_charp message)
{
    (void)message;
    longjmp(png_jmpbuf(png), 1);
}

static void png_warned(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static png_structp png_writer(void)
{
    return png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, png_failed,
                                   png_warned);
}

/* A whole PNG of one area of an RGB picture, in memory. */
static Status encode_area(const uint8_t *rgb, int width, Area area,
                          Bytes *bytes)
{
    png_structp png = png_writer();
    png_infop info = png ? png_create_info_struct(png) : NULL;
    *bytes = (Bytes){0};
    if (!info) {
        png_destroy_write_struct(&png, NULL);
        return STATUS_OUT_OF_MEMORY;
    }
    if (setjmp(png_jmpbuf(png))) {
        png_destroy_write_struct(&png, &info);
        free(bytes->data);
        *bytes = (Bytes){0};
        return STATUS_OUT_OF_MEMORY;
    }
    png_set_write_fn(png, bytes, bytes_append, bytes_flush);
    png_set_IHDR(png, info, (png_uint_32)area.width, (png_uint_32)area.height,
                 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_filter(png, 0, PNG_FILTER_NONE); /* for flat colours the best */
    png_set_compression_level(png, 6);
    png_write_info(png, info);
    for (int y = 0; y < area.height; y++)
        png_write_row(png, rgb + 3 * ((size_t)(area.y + y) * (size_t)width +
                                      (size_t)area.x));
    png_write_end(png, NULL);
    png_destroy_write_struct(&png, &info);
    return STATUS_OK;
}

/* One chunk into the file; libpng makes its length and its check sum. */
static Status write_chunk(Film *film, const char *type, const uint8_t *data,
                          size_t size)
{
    png_structp png = png_writer();
    if (!png)
        return STATUS_OUT_OF_MEMORY;
    errno = 0;
    if (setjmp(png_jmpbuf(png))) {
        int reason = errno;
        png_destroy_write_struct(&png, NULL);
        errno = reason ? reason : EIO;
        return STATUS_FILE_FAILED;
    }
    png_init_io(png, film->output.file);
    png_write_chunk(png, (png_const_bytep)type, data, size);
    png_destroy_write_struct(&png, NULL);
    return output_check(&film->output);
}

/* How many frames, shown for ever. */
static Status write_actl(Film *film)
{
    uint8_t data[ACTL_SIZE];
    png_save_uint_32(data, (png_uint_32)film->frames);
    png_save_uint_32(data + 4, 0);
    return write_chunk(film, "acTL", data, sizeof data);
}

/* Where the frame goes, and for how long. */
static Status write_fctl(Film *film, Area area, int shown)
{
    uint8_t data[FCTL_SIZE] = {0};
    png_save_uint_32(data, film->sequence++);
    png_save_uint_32(data + 4, (png_uint_32)area.width);
    png_save_uint_32(data + 8, (png_uint_32)area.height);
    png_save_uint_32(data + 12, (png_uint_32)area.x);
    png_save_uint_32(data + 16, (png_uint_32)area.y);
    png_save_uint_16(data + 20, (unsigned)(shown < 65535 ? shown : 65535));
    png_save_uint_16(data + 22, (unsigned)lrint(film->rate)); /* of a second */
    return write_chunk(film, "fcTL", data, sizeof data);
}

/* The chunks of an encoded area: the first frame's go as they are, later ones
 * as fdAT. */
static Status write_data(Film *film, const Bytes *bytes)
{
    Status status = STATUS_OK;
    size_t at = SIGNATURE;
    while (!status && at + CHUNK_FRAME <= bytes->count) {
        const uint8_t *chunk = bytes->data + at;
        size_t size = png_get_uint_32(chunk);
        bool first = film->frames == 0;
        if (memcmp(chunk + 4, "IDAT", 4) == 0 && first) {
            status = write_chunk(film, "IDAT", chunk + 8, size);
        } else if (memcmp(chunk + 4, "IDAT", 4) == 0) {
            uint8_t *data = malloc(size + 4);
            if (!data)
                return STATUS_OUT_OF_MEMORY;
            png_save_uint_32(data, film->sequence++);
            memcpy(data + 4, chunk + 8, size);
            status = write_chunk(film, "fdAT", data, size + 4);
            free(data);
        }
        at += size + CHUNK_FRAME;
    }
    return status;
}

/* Signature and IHDR of the whole, and room for acTL. */
static Status write_start(Film *film, const Bytes *bytes)
{
    size_t size =
        SIGNATURE + png_get_uint_32(bytes->data + SIGNATURE) + CHUNK_FRAME;
    errno = 0;
    if (fwrite(bytes->data, 1, size, film->output.file) != size)
        return STATUS_FILE_FAILED;
    film->header = ftell(film->output.file);
    return write_actl(film);
}

/* The rectangle in which two frames differ; one pixel where they are equal. */
static Area changed_area(const Film *film)
{
    size_t row = 3 * (size_t)film->width;
    int top = 0, bottom = film->height - 1;
    int left = film->width - 1, right = 0;
    while (top < bottom && memcmp(film->last + (size_t)top * row,
                                  film->next + (size_t)top * row, row) == 0)
        top++;
    while (bottom > top && memcmp(film->last + (size_t)bottom * row,
                                  film->next + (size_t)bottom * row, row) == 0)
        bottom--;
    for (int y = top; y <= bottom; y++) {
        const uint8_t *a = film->last + (size_t)y * row;
        const uint8_t *b = film->next + (size_t)y * row;
        for (int x = 0; x < left; x++)
            if (memcmp(a + 3 * x, b + 3 * x, 3) != 0)
                left = x;
        for (int x = film->width - 1; x > right; x--)
            if (memcmp(a + 3 * x, b + 3 * x, 3) != 0)
                right = x;
    }
    if (left > right) /* nothing has changed */
        left = right = 0;
    return (Area){left, top, right - left + 1, bottom - top + 1};
}

static Status add_apng(Film *film, int shown)
{
    Area area = {0, 0, film->width, film->height};
    Bytes bytes;
    if (film->frames > 0)
        area = changed_area(film);
    Status status = encode_area(film->next, film->width, area, &bytes);
    if (status)
        return status;
    if (film->frames == 0)
        status = write_start(film, &bytes);
    if (!status)
        status = write_fctl(film, area, shown);
    if (!status)
        status = write_data(film, &bytes);
    free(bytes.data);
    return status;
}

/* The end of the file, then its number of frames. */
static Status close_apng(Film *film)
{
    if (film->frames == 0) {
        output_discard(&film->output);
        return STATUS_OK;
    }
    Status status = write_chunk(film, "IEND", NULL, 0);
    if (!status && fseek(film->output.file, film->header, SEEK_SET) != 0)
        status = STATUS_FILE_FAILED;
    if (!status)
        status = write_actl(film);
    if (!status)
        return output_close(&film->output, false);
    int reason = errno;
    output_discard(&film->output);
    errno = reason;
    return status;
}

/* ---- ffmpeg ------------------------------------------------------------- */

/* Whether a program of this name is in the path. */
static bool program_exists(const char *name)
{
    char file[4096];
    const char *path = getenv("PATH");
    while (path && *path) {
        int length = (int)strcspn(path, ":");
        snprintf(file, sizeof file, "%.*s/%s", length, path, name);
        if (access(file, X_OK) == 0)
            return true;
        path += length + (path[length] == ':');
    }
    return false;
}

/* In the new process: standard input is the pipe, its words go nowhere. */
static void run_ffmpeg(const Film *film, int from)
{
    char size[32], rate[32];
    snprintf(size, sizeof size, "%dx%d", film->width, film->height);
    snprintf(rate, sizeof rate, "%g", film->rate);
    const char *gif_filter =
        "fps=25,split[a][b];[a]palettegen=stats_mode=single[p];[b][p]"
        "paletteuse=new=1";
    const char *mp4_filter =
        "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white,format=yuv420p";
    const char *words[] = {"ffmpeg",
                           "-loglevel",
                           "quiet",
                           "-y",
                           "-f",
                           "rawvideo",
                           "-pixel_format",
                           "rgb24",
                           "-video_size",
                           size,
                           "-framerate",
                           rate,
                           "-i",
                           "pipe:0",
                           "-vf",
                           film->gif ? gif_filter : mp4_filter,
                           "-f",
                           film->gif ? "gif" : "mp4",
                           film->output.temporary,
                           NULL};
    int nowhere = open("/dev/null", O_WRONLY);
    signal(SIGINT, SIG_IGN); /* the film ends when the pipe does */
    if (dup2(from, STDIN_FILENO) < 0 || dup2(nowhere, STDOUT_FILENO) < 0 ||
        dup2(nowhere, STDERR_FILENO) < 0)
        _exit(127);
    execvp(words[0], (char *const *)words);
    _exit(127);
}

static Status start_ffmpeg(Film *film)
{
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
        return STATUS_FILE_FAILED;
    int process = fork();
    if (process == 0)
        run_ffmpeg(film, ends[0]);
    close(ends[0]);
    if (process < 0) {
        close(ends[1]);
        return STATUS_FILE_FAILED;
    }
    film->process = process;
    film->pipe = ends[1];
    return STATUS_OK;
}

static Status add_ffmpeg(Film *film, int shown)
{
    size_t size = 3 * (size_t)film->width * (size_t)film->height;
    Status status = film->frames == 0 ? start_ffmpeg(film) : STATUS_OK;
    for (int i = 0; i < shown && !status; i++) {
        size_t done = 0;
        while (done < size && !status) {
            ssize_t wrote = write(film->pipe, film->next + done, size - done);
            if (wrote > 0)
                done += (size_t)wrote;
            else if (errno != EINTR)
                status = STATUS_FILE_FAILED;
        }
    }
    return status;
}

/* Waits for ffmpeg; its file gets its name if all went well. */
static Status close_ffmpeg(Film *film)
{
    int code = 0;
    if (film->process > 0) {
        close(film->pipe);
        while (waitpid(film->process, &code, 0) < 0 && errno == EINTR)
            continue;
    }
    film->process = 0;
    film->pipe = -1;
    if (film->frames > 0 && WIFEXITED(code) && WEXITSTATUS(code) == 0)
        return output_close(&film->output, false);
    output_discard(&film->output);
    errno = EIO;
    return film->frames > 0 ? STATUS_FILE_FAILED : STATUS_OK;
}

/* ---- both --------------------------------------------------------------- */

/* Whether the name ends so. */
static bool ends_with(const char *name, const char *end)
{
    size_t length = strlen(name), last = strlen(end);
    return length > last && strcmp(name + length - last, end) == 0;
}

static Status refuse(char *message, size_t size, const char *format,
                     const char *name)
{
    snprintf(message, size, format, name);
    return STATUS_INVALID_INPUT;
}

Status film_open(const char *name, double rate, Film *film, char *message,
                 size_t size)
{
    *film = (Film){.rate = rate, .pipe = -1};
    char shown[128];
    one_line(name, shown, sizeof shown);
    message[0] = '\0';
    film->gif = ends_with(name, ".gif");
    if (film->gif || ends_with(name, ".mp4"))
        film->kind = FILM_FFMPEG;
    else if (!ends_with(name, ".apng") && !ends_with(name, ".png"))
        return refuse(message, size,
                      "--film: '%s' does not end in .apng, .mp4 or .gif",
                      shown);
    if (film->kind == FILM_FFMPEG && !program_exists("ffmpeg"))
        return refuse(message, size,
                      "--film: '%s' needs the program ffmpeg: apt-get install "
                      "ffmpeg, or name the film .apng",
                      shown);
    Status status = output_open(name, &film->output);
    if (status || film->output.temporary)
        return status;
    output_discard(&film->output);
    return refuse(message, size, "--film: '%s' is no regular file", shown);
}

bool film_runs(const Film *film)
{
    return film->output.file != NULL;
}

/* The canvas as RGB, in the size of the film. */
static void take_frame(Film *film, const Canvas *canvas)
{
    for (int y = 0; y < film->height; y++) {
        uint8_t *to = film->next + 3 * (size_t)y * (size_t)film->width;
        const uint32_t *from =
            canvas->pixels + (size_t)y * (size_t)canvas->width;
        for (int x = 0; x < film->width; x++) {
            bool there = x < canvas->width && y < canvas->height;
            uint32_t pixel = there ? from[x] : 0xffffff;
            *to++ = (uint8_t)(pixel >> 16);
            *to++ = (uint8_t)(pixel >> 8);
            *to++ = (uint8_t)pixel;
        }
    }
}

/* Room for two frames, at the first one. */
static Status make_frames(Film *film, const Canvas *canvas)
{
    size_t count = 3 * (size_t)canvas->width * (size_t)canvas->height;
    film->width = canvas->width;
    film->height = canvas->height;
    film->last = malloc(count);
    film->next = malloc(count);
    return film->last && film->next ? STATUS_OK : STATUS_OUT_OF_MEMORY;
}

Status film_add(Film *film, const Canvas *canvas, int shown)
{
    Status status = film->next ? STATUS_OK : make_frames(film, canvas);
    if (status)
        return status;
    take_frame(film, canvas);
    status = film->kind == FILM_APNG ? add_apng(film, shown)
                                     : add_ffmpeg(film, shown);
    if (status)
        return status;
    uint8_t *swap = film->last;
    film->last = film->next;
    film->next = swap;
    film->frames++;
    return STATUS_OK;
}

/* Memory. */
static void film_free(Film *film)
{
    free(film->last);
    free(film->next);
    *film = (Film){.pipe = -1};
}

Status film_close(Film *film)
{
    Status status = STATUS_OK;
    if (film_runs(film))
        status =
            film->kind == FILM_APNG ? close_apng(film) : close_ffmpeg(film);
    int reason = errno;
    film_free(film);
    errno = reason;
    return status;
}

void film_discard(Film *film)
{
    int reason = errno;
    if (film->process > 0) {
        close(film->pipe);
        kill(film->process, SIGKILL);
        waitpid(film->process, NULL, 0);
    }
    output_discard(&film->output);
    film_free(film);
    errno = reason;
}
