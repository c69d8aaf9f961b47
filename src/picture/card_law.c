/* card_law.c - the law of a term as a curve, and a dot where the gap, the
 * triangle, the contact or the spring is now that feels it most.
 *
 * The curve is the term's own function, asked for this one element while one
 * number of it goes from end to end of the axis: so the dot is on the curve.
 */
#include <math.h>
#include <string.h>

#include "model/fracture.h"
#include "model/friction.h"
#include "model/mass_spring_energy.h"
#include "model/neo_hookean.h"
#include "model/plasticity.h"
#include "model/self_contact.h"
#include "picture/cards.h"
#include "picture/colour_map.h"

/* One element, and what its law needs. */
typedef struct LawNow {
    Place at;
    Element element;
    SpringLaw spring;
    double breaks;  /* the strain at which the spring does */
    double reach;   /* the unit of the axis */
    double x, felt; /* where it is on the axis, NaN: nowhere; how much */
} LawNow;

typedef struct Law {
    const char *name, *now, *across, *upwards;
    const TermKind *kind, *source; /* the term; whose elements, or springs */
    double (*value)(const void *now, double x);
    double low, high; /* ends of the axis, in units of reach */
} Law;

static double energy_at(const LawNow *now, double s)
{
    LawNow there = *now;
    there.element.s = s;
    return now->at.term->kind->element->value(&there.at, &there.element);
}

static double gap_value(const void *now, double d)
{
    return energy_at(now, d);
}

static double near_value(const void *data, double d)
{
    const LawNow *now = data;
    return energy_at(now, d / now->reach * (d / now->reach));
}

/* W/A of the triangle when it is pressed flatter, or let out, in the direction
 * in which it is flattest. */
static double triangle_value(const void *data, double J)
{
    LawNow there = *(const LawNow *)data;
    double *f = there.element.v, factor = J / there.element.s - 1;
    double turn =
        0.5 * atan2(2 * (f[0] * f[1] + f[2] * f[3]),
                    f[0] * f[0] + f[2] * f[2] - f[1] * f[1] - f[3] * f[3]);
    const double n[2] = {-sin(turn), cos(turn)};
    for (int i = 0; i < 4; i += 2) {
        double part = factor * (n[0] * f[i] + n[1] * f[i + 1]);
        f[i] += part * n[0];
        f[i + 1] += part * n[1];
    }
    return energy_at(&there, J) / solid_of(there.at.system)->area;
}

static double slip_value(const void *now, double v)
{
    return friction_slope(v, ((const LawNow *)now)->reach);
}

static double spring_value(const void *data, double s)
{
    const LawNow *now = data;
    return s > now->breaks ? 0
                           : spring_law_slope(now->spring, s - now->spring.ep);
}

#define GAPS   "gap d in m", "W in J"
#define SLIPS  "slip in m/s", "f/(\u03bc N)"
#define SPRING "strain s", "f/(2k|d|)"

static const Law laws[] = {
    {"barrier", "the smallest gap, m", GAPS, &contact_energy, &contact_energy,
     gap_value, 0, 1.2},
    {"near", "the nearest point and edge, m", GAPS, &self_contact_energy,
     &self_contact_energy, near_value, 0, 1.2},
    {"friction", "where it is pressed most, m/s", SLIPS, &friction_energy,
     &contact_energy, slip_value, 1e-2, 1e4},
    {"rub", "where it is pressed most, m/s", SLIPS, &self_friction_energy,
     &self_contact_energy, slip_value, 1e-2, 1e4},
    {"triangle", "J of the flattest triangle", "J", "W/A in J/m\u00b2",
     &neo_hookean_energy, &neo_hookean_energy, triangle_value, 0, 1.5},
    {"yield", "s of the spring that flowed most", SPRING, &plastic_energy, NULL,
     spring_value, -1, 1},
    {"break", "s of the spring nearest to breaking", SPRING, &fracture, NULL,
     spring_value, 0, 1.3},
};

static void find_spring(LawNow *now, int s)
{
    const System *system = now->at.system;
    const Plasticity *flow = plasticity_of(system);
    const Fracture *tear = fracture_of(system);
    double d[2];
    now->spring = plasticity_law(system, s);
    now->breaks = tear ? fracture_strength(tear, s) : INFINITY;
    now->x = spring_strain(system->e + 2 * s, system->l2[s], now->at.x, d);
    now->felt = spring_is_broken(system, s) ? -INFINITY
                : flow ? fabs(now->spring.ep) + 1e-3 * fabs(now->x)
                       : now->x / now->breaks;
    now->reach =
        flow ? fmax(4 * now->spring.yield, 1.2 * fabs(now->x)) : now->breaks;
}

static void find_element(LawNow *now, const Law *law, const double *v)
{
    const Element *element = &now->element;
    double t[4], w[4], slip;
    now->felt = -element->s;
    now->x =
        law->value == near_value ? sqrt(element->s) * now->reach : element->s;
    if (law->value != slip_value)
        return;
    now->felt = now->at.term->kind->element->rub(&now->at, element, t, &slip);
    element_vectors(element, v, w);
    for (int i = 0; i < 2 * element->vectors; i++)
        slip -= t[i] * w[i];
    now->x = fabs(slip);
}

/* The law that the page is about, and where a run is on it, most of all.  NULL:
 * the scene has none. */
static const Law *law_now(const Simulation *simulation, int run, LawNow *most)
{
    const LecturePage *page = simulation->options.page;
    const System *system = simulation->run[run].system;
    const double *x = simulation->run[run].x, *v = simulation->run[run].v;
    const Law *law = page && page->law ? laws : NULL;
    while (law && strcmp(law->name, page->law) != 0)
        law++;
    const Term *term = law ? system_find_term(system, law->kind) : NULL;
    if (!term)
        return NULL;
    *most = (LawNow){.at = place_at(system, x, NULL, x),
                     .reach = 1,
                     .x = NAN,
                     .felt = -INFINITY};
    if (law->value == slip_value)
        most->reach = ((const Friction *)term->data)->slip_speed;
    else if (law->source == &contact_energy)
        most->reach = contact_of(system)->barrier.d_hat;
    else if (law->source == &self_contact_energy)
        most->reach = self_contact_of(system)->d_hat;
    LawNow now = *most;
    for (int s = 0; s < system->springs && !law->source; s++) {
        find_spring(&now, s);
        *most = now.felt > most->felt ? now : *most;
    }
    if (!law->source)
        return law;
    most->at.term = now.at.term = system_find_term(system, law->source);
    for (ElementWalk walk = elements_from(&now.at, NULL, 0);
         elements_next(&walk);) {
        now.element = walk.element;
        find_element(&now, law, v);
        *most = now.felt > most->felt ? now : *most;
    }
    return law;
}

bool law_gap(const Simulation *simulation, LawGap *gap)
{
    LawNow now;
    const Law *law = law_now(simulation, 0, &now);
    if (!law || simulation->runs > 1 || isnan(now.x) || !law->source ||
        law->value == triangle_value)
        return false;
    const System *system = now.at.system;
    bool self = law->source == &self_contact_energy;
    gap->d_hat = self ? self_contact_of(system)->d_hat
                      : contact_of(system)->barrier.d_hat;
    gap->d = self ? sqrt(now.element.s) * gap->d_hat : now.element.s;
    for (int c = 0; c < 2; c++) {
        gap->node[c] = now.at.x[2 * now.element.node[0] + c];
        gap->foot[c] = gap->node[c] - gap->d * now.element.n[c];
    }
    return true;
}

void law_facts(const Simulation *simulation, Facts *facts)
{
    LawNow now;
    const Law *law = law_now(simulation, 0, &now);
    if (!law || simulation->runs > 1)
        return;
    bool flowed = law->kind != &plastic_energy || now.spring.ep != 0;
    fact_words(facts, "law",
               isnan(now.x) ? "nothing is near enough"
               : flowed     ? law->now
                            : "no spring has flowed");
    fact(facts, "law x", flowed ? now.x : NAN);
    fact(facts, "law y", isnan(now.x) ? NAN : law->value(&now, now.x));
    const SquareMesh *mesh = &simulation->mesh;
    int last = mesh->bodies - 1, nodes = mesh->nodes / mesh->bodies;
    double sum = 0;
    for (int i = last * nodes; i < mesh->nodes; i++)
        sum += simulation->run[0].x[2 * i];
    if (law->kind == &self_friction_energy)
        fact(facts, "gone", sum / nodes - simulation->options.body[last][0]);
}

/* The curve for the element of the first run; of springs all others are there,
 * small; a dot for each run, beyond the axis at its end. */
void law_draw(const Plot *card)
{
    static const double dot = 6, small_dot = 2; /* units */
    static const char *const names[] = {"upper", "middle", "lower"};
    const Simulation *simulation = card->simulation;
    LawNow now;
    const Law *law = law_now(simulation, 0, &now);
    if (!law)
        return;
    bool log = law->value == slip_value, both = law->low < 0;
    double low = law->low * now.reach, high = law->high * now.reach;
    double most = both ? 1.4 * now.spring.yield
                       : fmax(law->value(&now, 0.9 * low + 0.1 * high),
                              law->value(&now, 0.25 * low + 0.75 * high));
    most = plot_round_axis(1.1 * fmax(most, fabs(law->value(&now, now.x))));
    Plot plot = plot_create(
        card, (Axis){low, high, log, false, law->across},
        (Axis){both ? -most : -0.02 * most, most, false, false, law->upwards});
    plot_graph(&plot, law->value, &now, 2.4, COLOUR_X);
    for (int s = 0; s < now.at.system->springs && !law->source; s++) {
        LawNow other = now;
        find_spring(&other, s);
        if (other.felt > -INFINITY)
            plot_disc(&plot,
                      (double[2]){other.x, spring_value(&other, other.x)},
                      small_dot, COLOUR_GHOST);
    }
    for (int i = 0; i < 2 * simulation->runs; i++) { /* dots, then words */
        int run = i % simulation->runs;
        law_now(simulation, run, &now);
        double at[1][2] = {
            {fmin(fmax(now.x, low), high), law->value(&now, now.x)}};
        if (isnan(now.x))
            continue;
        if (i == run) {
            plot_disc(&plot, at[0], dot, COLOUR_P);
        } else if (simulation->runs > 1) {
            plot_words(&plot, 1, at, 0.6, 1, FACE_REGULAR, COLOUR_P,
                       names[run]);
        }
    }
}
