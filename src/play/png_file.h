/* png_file.h - a canvas as a PNG file.
 */
#ifndef ELASTO_PNG_FILE_H
#define ELASTO_PNG_FILE_H

#include "picture/canvas.h"

/* Writes it, whole or not at all (output.h).
 * Returns OK, OUT_OF_MEMORY, FILE_FAILED (errno tells why). */
Status png_file_write(const char *name, const Canvas *canvas);

#endif
