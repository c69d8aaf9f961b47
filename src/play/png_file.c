#include "play/recording.h"

#include <errno.h>
#include <png.h>
#include <stdlib.h>

#include "play/output.h"

/* Red, green, blue for each pixel, in memory of its own, or NULL. */
static uint8_t *canvas_to_rgb(const Canvas *canvas)
{
    size_t count = (size_t)canvas->width * (size_t)canvas->height;
    uint8_t *bytes = malloc(3 * count);
    if (!bytes)
        return NULL;
    for (size_t i = 0; i < count; i++) {
        uint32_t pixel = canvas->pixels[i];
        bytes[3 * i] = (uint8_t)(pixel >> 16);
        bytes[3 * i + 1] = (uint8_t)(pixel >> 8);
        bytes[3 * i + 2] = (uint8_t)pixel;
    }
    return bytes;
}

/* libpng's simplified writer; it leaves errno of a failed write alone. */
Status png_file_write(const char *name, const Canvas *canvas, bool small)
{
    Output output;
    uint8_t *bytes = canvas_to_rgb(canvas);
    if (!bytes)
        return STATUS_OUT_OF_MEMORY;
    Status status = output_open(name, &output);
    if (status) {
        free(bytes);
        return status;
    }
    png_image image = {.version = PNG_IMAGE_VERSION,
                       .width = (png_uint_32)canvas->width,
                       .height = (png_uint_32)canvas->height,
                       .format = PNG_FORMAT_RGB,
                       .flags = small ? 0 : PNG_IMAGE_FLAG_FAST};
    errno = 0;
    bool whole =
        png_image_write_to_stdio(&image, output.file, 0, bytes, 0, NULL);
    int reason = errno;
    png_image_free(&image);
    free(bytes);
    if (whole)
        return output_close(&output);
    output_discard(&output, false);
    errno = reason ? reason : EIO;
    return reason == ENOMEM ? STATUS_OUT_OF_MEMORY : STATUS_FILE_FAILED;
}
