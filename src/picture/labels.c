#include "picture/labels.h"

#include <math.h>

#include "picture/colour_map.h"

static const double FARTHEST = 1e6;    /* pixels */
static const double LINE_HEIGHT = 1.3; /* ems of the words */
/* What a place costs: for the whole of it on other words, for the part of its
 * width that lines cross, outside of the stage, and for each place that would
 * have been preferred. */
static const double COST_WORDS = 10, COST_LINE = 4, COST_OUTSIDE = 30,
                    COST_LATER = 0.08;

/* Whether a place can be counted in pixels. */
static bool is_near(const double at[2])
{
    return fabs(at[0]) < FARTHEST && fabs(at[1]) < FARTHEST;
}

void labels_line(Labels *labels, const double a[2], const double b[2])
{
    bool near = is_near(a) && is_near(b);
    if (labels->lines >= LABELS_LINES || !near)
        return;
    double *line = labels->line[labels->lines++];
    line[0] = a[0];
    line[1] = a[1];
    line[2] = b[0];
    line[3] = b[1];
}

void labels_box(Labels *labels, Box box)
{
    if (labels->boxes < LABELS_BOXES)
        labels->box[labels->boxes++] = box;
}

void labels_disc(Labels *labels, const double middle[2], double radius)
{
    int size = (int)ceil(2 * radius);
    if (!is_near(middle))
        return;
    labels_box(labels, (Box){(int)floor(middle[0] - radius),
                             (int)floor(middle[1] - radius), size, size});
}

/* The area that two boxes share. */
static double shared_area(Box a, Box b)
{
    double wide = fmin(a.x + a.width, b.x + b.width) - fmax(a.x, b.x);
    double high = fmin(a.y + a.height, b.y + b.height) - fmax(a.y, b.y);
    return fmax(wide, 0) * fmax(high, 0);
}

/* The length of a line inside a box (Liang and Barsky 1984). */
static double length_inside(Box box, const double line[4])
{
    double from = 0, to = 1;
    const double low[2] = {box.x, box.y};
    const double high[2] = {box.x + box.width, box.y + box.height};
    for (int k = 0; k < 2; k++) {
        double d = line[2 + k] - line[k];
        if (d == 0) {
            if (line[k] < low[k] || line[k] > high[k])
                return 0;
            continue;
        }
        double p = (low[k] - line[k]) / d, q = (high[k] - line[k]) / d;
        from = fmax(from, fmin(p, q));
        to = fmin(to, fmax(p, q));
    }
    return fmax(to - from, 0) * hypot(line[2] - line[0], line[3] - line[1]);
}

static double place_cost(const Labels *labels, Box place)
{
    double area = (double)place.width * place.height, cost = 0;
    for (int i = 0; i < labels->boxes; i++)
        cost += COST_WORDS * shared_area(place, labels->box[i]) / area;
    for (int i = 0; i < labels->lines; i++)
        cost += COST_LINE * length_inside(place, labels->line[i]) / place.width;
    return cost + COST_OUTSIDE * (1 - shared_area(place, labels->stage) / area);
}

void labels_put(Paper *paper, Labels *labels, Face face, double size,
                Colour colour, const double (*point)[2], int points, double gap,
                const char *words)
{
    /* right, left, below, above, then the corners */
    static const int side[8][2] = {{1, 0}, {-1, 0}, {0, 1},  {0, -1},
                                   {1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
    int wide = paper_width(paper, face, size, words);
    int high = (int)ceil(LINE_HEIGHT * size * paper->em);
    Box best = {0, 0, wide, high};
    double least = INFINITY;
    for (int i = 0; i < 8 * points; i++) {
        const double *at = point[i / 8];
        const int *to = side[i % 8];
        if (!is_near(at))
            continue;
        double apart = i % 8 < 4 ? gap : 0.7 * gap;
        Box place = {(int)(at[0] + to[0] * (apart + 0.5 * wide) - 0.5 * wide),
                     (int)(at[1] + to[1] * (apart + 0.5 * high) - 0.5 * high),
                     wide, high};
        double cost = place_cost(labels, place) + COST_LATER * i;
        if (cost < least) {
            least = cost;
            best = place;
        }
    }
    if (wide < 1 || !isfinite(least))
        return;
    canvas_rectangle(&paper->canvas, best.x - 1, best.y + high / 8, wide + 2,
                     high - high / 4, COLOUR_PANEL);
    paper_write(paper, face, size, colour, best.x, best.y, ALIGN_LEFT, "%s",
                words);
    labels_box(labels, best);
}
