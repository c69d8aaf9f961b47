#include "play/recording.h"

#include <errno.h>
#include <png.h>
#include <stdlib.h>

/* libpng's simplified writer wants red, green and blue of each pixel; it leaves
 * errno of a failed write alone. */
Status png_write(FILE *file, const Canvas *canvas, bool small)
{
    size_t count = (size_t)canvas->width * (size_t)canvas->height;
    png_image image = {.version = PNG_IMAGE_VERSION,
                       .width = (png_uint_32)canvas->width,
                       .height = (png_uint_32)canvas->height,
                       .format = PNG_FORMAT_RGB,
                       .flags = small ? 0 : PNG_IMAGE_FLAG_FAST};
    uint8_t *bytes = malloc(3 * count);
    if (!bytes)
        return STATUS_OUT_OF_MEMORY;
    for (size_t i = 0; i < 3 * count; i++)
        bytes[i] = (uint8_t)(canvas->pixels[i / 3] >> (16 - i % 3 * 8));
    errno = 0;
    bool whole = png_image_write_to_stdio(&image, file, 0, bytes, 0, NULL);
    int reason = errno;
    png_image_free(&image);
    free(bytes);
    errno = reason ? reason : EIO;
    return whole             ? STATUS_OK
           : errno == ENOMEM ? STATUS_OUT_OF_MEMORY
                             : STATUS_FILE_FAILED;
}

Status png_file_write(const char *name, const Canvas *canvas)
{
    Output output;
    Status status = output_open(name, &output);
    return status
               ? status
               : output_close(&output, png_write(output.file, canvas, false));
}
