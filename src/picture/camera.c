/* camera.c - maps the world to pixels, with the user's zoom and pan. */
#include <math.h>

#include "picture/layout.h"

const Lens LENS_FITS = {1, {0, 0}, false};

static const double MIN_ZOOM = 1e-3, MAX_ZOOM = 1e6;

Camera camera_create(Box box, const double bounds[4], bool stretched,
                     const Lens *lens)
{
    Camera camera;
    double zoom = lens->zoom > 0 ? lens->zoom : 1, *scale = camera.scale;
    const double size[2] = {box.width, box.height};
    for (int k = 0; k < 2; k++)
        scale[k] =
            zoom * fmax(size[k], 1) / fmax(bounds[k + 2] - bounds[k], 1e-300);
    if (!stretched)
        scale[0] = scale[1] = fmin(scale[0], scale[1]);
    for (int k = 0; k < 2; k++) {
        double sign = k ? -1 : 1, corner = k ? box.y : box.x;
        camera.origin[k] =
            corner + 0.5 * size[k] +
            sign * (lens->pan[k] * size[k] * zoom -
                    scale[k] * 0.5 * (bounds[k] + bounds[k + 2]));
    }
    return camera;
}

void camera_to_world(const Camera *camera, double x, double y, double world[2])
{
    world[0] = (x - camera->origin[0]) / camera->scale[0];
    world[1] = (camera->origin[1] - y) / camera->scale[1];
}

void lens_zoom(Lens *lens, Box box, double x, double y, double factor)
{
    double zoom = lens->zoom > 0 ? lens->zoom : 1;
    lens->zoom = fmin(fmax(zoom * factor, MIN_ZOOM), MAX_ZOOM);
    double growth = lens->zoom / zoom - 1;
    lens_pan(lens, box, -growth * (x - box.x - 0.5 * box.width),
             -growth * (y - box.y - 0.5 * box.height));
}

void lens_pan(Lens *lens, Box box, double dx, double dy)
{
    double zoom = lens->zoom > 0 ? lens->zoom : 1;
    lens->pan[0] += dx / (zoom * fmax(box.width, 1));
    lens->pan[1] -= dy / (zoom * fmax(box.height, 1));
}
