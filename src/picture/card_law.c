/* card_law.c - the law of an energy term as a curve, with a dot at the most
 * loaded element (contact, triangle or spring).
 *
 * The curve evaluates the term for this element while its gap, area ratio, slip
 * speed or strain varies along the x axis, so the dot lies on the curve. */
#include <math.h>
#include <string.h>

#include "model/fracture.h"
#include "model/friction.h"
#include "model/neo_hookean.h"
#include "model/plasticity.h"
#include "model/self_contact.h"
#include "model/spring_law.h"
#include "picture/cards.h"

/* An element, and its place on the curve of the law. */
typedef struct LawPoint {
    EvalPoint eval;
    Element element;  /* contact or triangle */
    FlowLaw flow_law; /* law of the spring */
    double axis_unit; /* factor of axis_low and axis_high, such as d_hat */
    double x;         /* value on the axis; NaN: there is no element */
    double load; /* how far the element is strained; the card shows the most
                    strained one */
} LawPoint;

typedef struct DrawnLaw {
    const char *name; /* value of Options.law_name */
    const char *x_label, *y_label;
    const TermKind *law_term;     /* term with the law */
    const TermKind *element_term; /* term with the elements; NULL: springs */
    double (*find_y)(const void *now, double x);
    double axis_low, axis_high; /* ends of the axis, in units of axis_unit */
    bool is_in_mm;              /* x_label is in mm or mm/s */
} DrawnLaw;

static double element_energy_at(const void *data, double d)
{
    LawPoint there = *(const LawPoint *)data;
    there.element.s = d;
    return there.eval.term->kind->element->potential(&there.eval,
                                                     &there.element);
}

/* Returns the energy per area of the triangle, after it is stretched along its
 * shortest direction to the area ratio J. */
static double triangle_energy_density(const void *data, double J)
{
    LawPoint there = *(const LawPoint *)data;
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
    return element_energy_at(&there, J) /
           get_neo_hookean(there.eval.system)->triangles.rest_area;
}

static double friction_force_ratio(const void *now, double v)
{
    return friction_slope(v, ((const LawPoint *)now)->axis_unit);
}

static double plastic_force_at(const void *data, double s)
{
    const LawPoint *now = data;
    return flow_law_slope(now->flow_law, s - now->flow_law.ep_n);
}

/* Returns force / breaking force for part = strain / strength; 0: broken. */
static double breaking_force_ratio(const void *now, double part)
{
    return part > 1 ? 0 : part;
}

static const DrawnLaw laws[] = {
    {"barrier", "gap \u03b4 in mm", "W in J", &contact_energy, &contact_energy,
     element_energy_at, 0, 1.2, true},
    {"pair", "", "", &self_contact_energy, &self_contact_energy,
     element_energy_at, 0, 1.2, false},
    {"rub", "slip in mm/s", "f/(\u03bc f_{N})", &self_friction_energy,
     &self_contact_energy, friction_force_ratio, 0, 2, true},
    {"triangle", "J", "\u03a8 in J/m\u00b2", &neo_hookean_energy,
     &neo_hookean_energy, triangle_energy_density, 0, 1.5, false},
    {"yield", "strain s", "s \u2212 s_{p}", &plastic_energy, NULL,
     plastic_force_at, -1, 1, false},
    {"break", "s/s_{c}", "force, 1 at s_{c}", &fracture, NULL,
     breaking_force_ratio, 0, 1.3, false},
};

static void find_spring_on_law(LawPoint *now, int s)
{
    const System *system = now->eval.system;
    const Plasticity *flow = system_term_data(system, &plastic_energy);
    const Fracture *tear = system_term_data(system, &fracture);
    double d[2];
    now->flow_law = plasticity_get_flow_law(system, s);
    double d2 = spring_vector(system->e + 2 * s, now->eval.x, d);
    now->x = spring_strain(d2, system->l2[s]);
    now->x /= tear ? fracture_strength(tear, s) : 1;
    now->load = spring_is_broken(system, s) ? -INFINITY
                : tear                      ? now->x
                       : fabs(now->flow_law.ep_n) + 1e-3 * fabs(now->x);
    if (flow)
        now->axis_unit =
            fmax(4 * now->flow_law.yield_strain, 1.2 * fabs(now->x));
}

/* Returns the law's value at the dot.  A spring beyond its strength keeps its
 * force until it breaks, since a neighbour may break first. */
static double evaluate_law(const DrawnLaw *law, const LawPoint *now)
{
    return law->find_y == breaking_force_ratio ? now->x
                                               : law->find_y(now, now->x);
}

/* Finds the scene's law, and the point of the most loaded element on its curve.
 * The point of friction is at the mean slip speed of all contacts, weighted by
 * their normal forces.  Returns NULL if the scene has no law. */
static const DrawnLaw *find_law(const Simulation *simulation, LawPoint *most)
{
    const char *name = simulation->options.law_name;
    const System *system = &simulation->system;
    const double *x = simulation->run[0].x, *v = simulation->run[0].v;
    const DrawnLaw *law = name ? laws : NULL;
    while (law && strcmp(law->name, name) != 0)
        law++;
    const EnergyTerm *term =
        law ? system_find_term(system, law->law_term) : NULL;
    if (!term)
        return NULL;
    bool rubs = law->find_y == friction_force_ratio;
    *most = (LawPoint){.eval = make_eval_point(system, x, NULL, x),
                       .axis_unit = 1,
                       .x = NAN,
                       .load = -INFINITY};
    if (rubs)
        most->axis_unit = ((const Friction *)term->data)->slip_speed;
    else if (law->element_term == &contact_energy)
        most->axis_unit = get_contact(system)->barrier.d_hat;
    else if (law->element_term == &self_contact_energy)
        most->axis_unit = get_self_contact(system)->d_hat;
    LawPoint now = *most;
    for (int s = 0; s < system->springs && !law->element_term; s++) {
        find_spring_on_law(&now, s);
        *most = now.load > most->load ? now : *most;
    }
    if (!law->element_term)
        return law;
    double force = 0, mean = NAN; /* sum of limits mu f_N, N; mean slip, m/s */
    most->eval.term = now.eval.term =
        system_find_term(system, law->element_term);
    for (ElementIterator walk = elements_begin(&now.eval, NULL, 0);
         elements_next(&walk);) {
        const Element *element = &walk.element;
        double t[4], w[4], slip;
        now.element = *element;
        now.load = -element->s;
        now.x = element->s;
        if (rubs) {
            now.load = walk.kind->friction_limit(&now.eval, element, t, &slip);
            element_compute_vectors(element, v, w);
            for (int i = 0; i < 2 * element->vector_count; i++)
                slip -= t[i] * w[i];
            mean = force > 0 ? mean : 0;
            force += now.load;
            mean += (fabs(slip) - mean) * now.load / force;
        }
        *most = now.load > most->load ? now : *most;
    }
    most->x = rubs ? mean : most->x;
    return law;
}

bool law_find_contact(const Simulation *simulation, NodeContact *gap)
{
    LawPoint now;
    const DrawnLaw *law = find_law(simulation, &now);
    if (!law || isnan(now.x) || law->find_y != element_energy_at)
        return false;
    bool self = law->element_term == &self_contact_energy;
    gap->d_hat = now.axis_unit;
    gap->d = self ? sqrt(now.element.s) * gap->d_hat : now.element.s;
    for (int c = 0; c < 2; c++) {
        gap->node_position[c] = now.eval.x[2 * now.element.node[0] + c];
        gap->nearest_point[c] =
            gap->node_position[c] - gap->d * now.element.n[c];
    }
    return true;
}

/* Returns the contact force -dW/dd, N. */
static double find_contact_force(const LawPoint *now)
{
    const Element *element = &now->element;
    double g[4];
    now->eval.term->kind->element->gradient(&now->eval, element, g);
    return -(g[0] * element->n[0] + g[1] * element->n[1]);
}

/* Finds the ends of a spring's plastic flow on the curve.  Returns false if the
 * spring has not flowed, or has flowed in both directions. */
static bool find_plastic_path(const LawPoint *now, double from[2], double to[2])
{
    const Plasticity *flow =
        system_term_data(now->eval.system, &plastic_energy);
    double ep = now->flow_law.ep_n,
           most = flow ? now->flow_law.yield_strain : 0;
    double away =
        flow ? most - flow->initial_yield_strain - flow->hardening * fabs(ep)
             : 0;
    from[0] = from[1] = flow ? copysign(flow->initial_yield_strain, ep) : 0;
    to[1] = copysign(most, ep);
    to[0] = ep + to[1];
    return ep != 0 && fabs(away) <= 1e-9 * most;
}

bool law_find_slip(const Simulation *simulation, int body, double distance[2])
{
    const SquareMesh *mesh = &simulation->mesh;
    const Options *options = &simulation->options;
    int nodes = mesh->nodes / mesh->bodies;
    double v = options->body[body][3], sum = 0;
    for (int i = body * nodes; i < (body + 1) * nodes; i++)
        sum += simulation->run[0].x[2 * i];
    distance[0] = sum / nodes - options->body[body][0];
    distance[0] = fabs(distance[0]) < 1e-9 ? 0 : distance[0];
    double mu =
        options->self_friction < 0 ? options->friction : options->self_friction;
    distance[1] = v * v / (2 * mu * options->gravity);
    return options->law_name && strcmp(options->law_name, "rub") == 0;
}

void list_law_values(const Simulation *simulation, LiveValues *values)
{
    LawPoint now;
    const DrawnLaw *law = find_law(simulation, &now);
    if (!law)
        return;
    bool self = law->element_term == &self_contact_energy;
    bool flows = law->find_y == plastic_force_at;
    bool still = flows && now.flow_law.ep_n == 0;
    double way[2];
    values_add_flag(values, "law", true);
    values_add_flag(values, "unflowed", still);
    values_add_flag(values, "bodies apart", self);
    values_add_flag(values, law->name, !isnan(now.x) && !still);
    if (law->find_y == element_energy_at) {
        const System *system = now.eval.system;
        values_add(values, "c",
                   self ? get_self_contact(system)->c
                        : get_contact(system)->barrier.c);
        values_add(values, "d hat", 1e3 * now.axis_unit);
        values_add(values, "law force", find_contact_force(&now));
    }
    values_add(values, "law x", now.x);
    values_add(values, "law mm", 1e3 * now.x);
    if (!isnan(now.x))
        values_add(values, "law y", evaluate_law(law, &now));
    if (flows)
        values_add(values, "s_p", now.flow_law.ep_n);
    Energies energies = simulation_get_energies(simulation, 0);
    for (int i = 0; i < energies.count; i++)
        values_add(values, energies.energy[i].name, energies.energy[i].value);
    if (law_find_slip(simulation, simulation->mesh.bodies - 1, way))
        values_add(values, "rigid", way[1]);
}

/* Draws the law's curve for the shown element.  A contact also has the tangent,
 * whose slope is the force; a spring its plastic flow and strain.  The dot of
 * the element is at the end of the axis if its value lies beyond. */
void draw_law_card(const Plot *card)
{
    LawPoint point, *now = &point;
    const DrawnLaw *law = find_law(card->simulation, now);
    if (!law)
        return;
    bool both = law->axis_low < 0;
    double low = law->axis_low * now->axis_unit,
           high = law->axis_high * now->axis_unit;
    double most = both ? 1.4 * now->flow_law.yield_strain
                       : fmax(law->find_y(now, 0.9 * low + 0.1 * high),
                              law->find_y(now, 0.25 * low + 0.75 * high));
    double x = now->x, y = evaluate_law(law, now);
    const double rest[2] = {now->flow_law.ep_n, 0};
    const double dot[2] = {fmin(fmax(x, low), high), y};
    most = plot_round_axis_end(1.1 * fmax(most, fabs(y)));
    Plot plot = plot_create(
        card,
        (Axis){low, high, .shows_milli = law->is_in_mm, .label = law->x_label},
        (Axis){both ? -most : -0.02 * most, most, .label = law->y_label});
    plot_graph(&plot, law->find_y, now, 2.4, COLOUR_X);
    if (law->find_y == element_energy_at && !isnan(x))
        plot_line(&plot,
                  (double[2]){low, y + (x - low) * find_contact_force(now)},
                  (double[2]){high, y + (x - high) * find_contact_force(now)},
                  1.4, COLOUR_FORCE);
    if (both && rest[0] != 0) {
        double from[2], to[2];
        if (find_plastic_path(now, from, to)) {
            plot_line(&plot, (double[2]){0, 0}, from, 2.4, COLOUR_PLASTIC);
            plot_line(&plot, from, to, 2.4, COLOUR_PLASTIC);
            plot_line(&plot, to, (double[2]){x, y}, 2.4, COLOUR_PLASTIC);
        }
        plot_ring(&plot, rest, 9, 2, COLOUR_PLASTIC);
        plot_label(&plot, 1, rest, COLOUR_PLASTIC, "s_{p}");
    }
    if (!isnan(x))
        plot_disc(&plot, dot, 6, COLOUR_P);
    if (x > high)
        plot_label(&plot, 1, dot, COLOUR_P, "\u2192");
}
