/* scene.c - the table of scenes; a user's guess where the next step ends. */
#include "scenes/scenes.h"

#include "simulation/body.h"
#include "scenes/small_scenes.h"

/* ---- scenes of the square that no options describe ----------------------- */

/* Returns the ceiling of `squeeze`.  The ceiling starts as far above the square
 * as the floor is below, presses the square by 0.55 of the height, and goes
 * back at twice the speed. */
static Obstacle make_squeeze_ceiling(const Options *options)
{
    double down = 0.55 / 0.4, back = down + 0.7;
    double speed = 0.4 * options->side;
    return (Obstacle){
        .kind = OBSTACLE_WALL,
        .n = {0, -1},
        .o = {0, 0.51 * options->side + options->at[1]},
        .mu = options->friction,
        .ball_node = -1,
        .motion = {2, {down, back}, {{0, -speed}, {0, 2 * speed}}}};
}

/* Small random sideways velocities cause buckling (Numerical Recipes, 7.1). */
static Status create_squeeze_scene(Simulation *simulation)
{
    Status status = create_square_scene(simulation);
    unsigned state = 1;
    for (int i = 0; i < simulation->mesh.nodes && !status; i++) {
        state = state * 1664525u + 1013904223u;
        simulation->run[0].v[2 * i] +=
            1e-3 * ((double)(state >> 8) / 8388608 - 1);
    }
    return status;
}

/* Returns the heavy third ball of `bend`, 0.05 m above the beam. */
static Obstacle make_bend_ball(const Options *options)
{
    const SquareMesh shape = body_make_mesh(options);
    double half = 0.5 * shape.rows * shape.spacing;
    return (Obstacle){.kind = OBSTACLE_BALL,
                      .o = {0, half + 0.18 + 0.05},
                      .radius = 0.18,
                      .mu = options->friction,
                      .ball_node = shape.nodes};
}

/* Creates `bend`: a ball of 60 kg falls on a beam, at first with 3 m/s. */
static Status create_bend_scene(Simulation *simulation)
{
    const SquareMesh *mesh = &simulation->mesh;
    Status status = create_square_scene(simulation);
    if (status)
        return status;
    simulation->system.m[mesh->nodes] = 60;
    if (!simulation->options.state) /* a state file has its own velocities */
        simulation->run[0].v[2 * mesh->nodes + 1] = -3;
    return STATUS_OK;
}

/* ---- the table ----------------------------------------------------------- */

/* Picture and parts of the scenes of a square in time. */
#define SQUARE PICTURE_SQUARE, HAS_SQUARE

/* Options of scenes in which a body of springs falls. */
#define FALL "--stretch 1 --tolerance 1e-4 --gravity 9.81 --cells on "

/* Options of scenes with soft bodies. */
#define SOLIDS                                                                 \
    "--material neo-hookean --timestep 0.01 --tolerance 1e-4 --gravity 9.81 "

const Scene scenes[] = {
    {"square", "A stretched square", "the stretched square relaxes", SQUARE,
     NULL, create_square_scene, .steps_per_frame = 0.25,
     .needs_dissipation = true,
     .group_heading = "Time steps and Newton's method"},
    {"circle", "Stability on a circle",
     "one circle, three Euler methods: out, in, or on it", PICTURE_CIRCLE,
     HAS_MOTION, "--timestep 0.02", .create = create_circle_scene},
    {"overshoot", "Overshooting",
     "Newton's full steps overshoot; a line search tames them", PICTURE_CURVE,
     HAS_START | HAS_ONE_COORDINATE | HAS_MINIMISATION,
     "--start 2 --tolerance 1e-10 --line-search none", create_overshoot_scene,
     .step_name = "iteration", .starts_paused = true, .step = step_descent,
     .after_drag = descent_update_direction, .handle_kinds = "x"},
    {"unprojected", "Without projection",
     "the squeezed square: without projection Newton is stuck", SQUARE,
     "--timestep 0.02 --stretch 0.5 --projection none", create_square_scene,
     .starts_paused = true},
    /* Without projection and line search, nodes fly 1.7 km in the first step,
     * in which E rises to 2e16 J s^2.  The start is the worst of 2560 starts
     * that were tried. */
    {"explosion", "Newton's method explodes",
     "one step without projection and line search: nodes fly", SQUARE,
     "--segments 3 --timestep 0.02 --stretch 0.485 --projection none "
     "--line-search none",
     create_square_scene, .starts_paused = true},
    {"hang", "Gravity: a hanging square",
     "pinned at its upper corners, it sags and swings", SQUARE,
     "--segments 12 --stiffness 1e4 --stretch 1 --timestep 0.01 "
     "--tolerance 1e-3 --gravity 9.81",
     create_square_scene, .default_pin = "top-corners",
     .group_heading = "Gravity, contact, inelasticity, fracture"},
    {"drop", "Contact: a square thrown down",
     "it falls on a corner, tumbles, and comes to rest", SQUARE,
     FALL "--segments 16 --timestep 0.005 --turn 25 --at -0.3,0.75 "
          "--velocity 0.9,-1 --friction 0.3 --ground 0,1,0,-0.5 "
          "--ground 1,0,-1.1,0 --ground -1,0,1.1,0",
     create_square_scene, .needs_dissipation = true,
     .view = {-1.25, -0.65, 1.25, 1.45}, .strain_colour_max = 0.1},
    {"slope", "Friction: three blocks",
     "three blocks, each with a friction of its own", SQUARE,
     FALL "--segments 6 --stiffness 5e4 --timestep 0.01 "
          "--tolerance 1e-5 --side 0.5 --turn 20 "
          "--at -0.08636008618973134,0.2372723867484419 "
          "--friction 0.36397023426620234 "
          "--ground -0.3420201433256687,0.9396926207859084,0,0",
     /* friction = tan(20 degrees): on this slope a block just stays at rest. */
     create_square_scene, .view = {-2.3, -2.75, 0.9, 2.0}, .body.runs = 3,
     .body.run_distance = 2.6, .body.friction_factor = {0.5, 0.9, 1.1}},
    {"squeeze", "Contact: pressed flat",
     "a ceiling comes down and lets go: all of it returns", SQUARE,
     FALL "--segments 16 --timestep 0.01 --friction 0.8 "
          "--ground 0,1,0,-0.51",
     create_squeeze_scene, .view = {-0.9, -0.7, 0.9, 0.7},
     .strain_colour_max = 0.5, .body.make_obstacle = make_squeeze_ceiling},
    {"return", "Solids that never turn over",
     "pressed to 3 % of its width, a square again", SQUARE,
     "--segments 10 --stretch 0.03 --timestep 0.01 --tolerance 1e-3 "
     "--material neo-hookean",
     create_square_scene, .steps_per_frame = 0.125, .needs_dissipation = true,
     .view = {-1.1, -1.1, 1.1, 1.1}},
    {"stack", "Self-contact: three squares",
     "three soft squares fall on one another", SQUARE,
     SOLIDS "--segments 6 --side 0.45 --friction 0.4 --barrier 0.01875,1e5 "
            "--ground 0,1,0,-1 --ground 1,0,-1,0 --ground -1,0,1,0 "
            "--body 0,-0.76 --body 0.2,-0.22,12 --body -0.12,0.33,-30",
     create_square_scene, .view = {-1.1, -1.1, 1.1, 0.75}},
    {"rub", "Friction between bodies",
     "a block slides on another one, and stops", SQUARE,
     SOLIDS "--segments 12 --young 4e5 --friction 0.2 --barrier 0.02,1e5 "
            "--body 0,-0.125 --body -0.15,0.1448,0,1,0",
     create_square_scene, .view = {-0.75, -0.4, 0.75, 0.5}, .body.aspect = 0.25,
     .default_pin = "all:1"},
    {"gap", "Squeezed through a gap",
     "a soft square falls through a gap narrower than itself", SQUARE,
     SOLIDS "--segments 10 --side 0.5 --young 2e4 --friction 0.1 "
            "--barrier 0.0125,1e5 --ground 0,1,0,-1.1 --body 0,0.65 "
            "--body -0.5036,0,45 --body 0.5036,0,45",
     create_square_scene, .view = {-0.95, -1.2, 0.95, 0.95},
     .default_pin = "all:2,all:3"},
    {"dent", "Inelasticity: a dent that stays",
     "springs beyond their yield strain flow, and keep it", SQUARE,
     FALL "--segments 16 --stiffness 2e5 --timestep 0.004 --at 0,0.62 "
          "--velocity 0.02,-2 --friction 0.3 --yield 0.04 "
          "--hardening 0.1 --ball 0,-0.75,0.35 --ground 0,1,0,-1.15",
     create_square_scene, .view = {-1.3, -1.3, 1.3, 1.25}},
    {"tear", "Fracture: a slit runs",
     "pulled apart, springs break: a crack runs from a slit", SQUARE,
     FALL "--segments 24 --timestep 0.002 --gravity 0 --tear 0.12 "
          "--self-contact on",
     create_square_scene, .view = {-0.78, -0.65, 0.78, 0.65},
     .strain_colour_max = 0.05, .default_pin = "left,right",
     .body.pin_speed = 0.2, .body.notch_ends = {-0.12, 0.12},
     .body.cell_stiffness = 0.3},
    {"bend", "Fracture: a beam breaks",
     "struck from above it cracks from below, at a notch", SQUARE,
     FALL "--segments 32 --stiffness 2e5 --timestep 0.002 --side 2 "
          "--tear 0.1 --friction 0.3 --barrier 0.008,8e5 --self-contact on "
          "--ball -0.8,-0.3325,0.14 --ball 0.8,-0.3325,0.14 "
          "--ground 0,1,0,-1",
     create_bend_scene, .view = {-1.25, -1.1, 1.25, 0.75},
     .strain_colour_max = 0.05, .body.aspect = 0.1875,
     .body.cell_stiffness = 0.3, .body.notch_ends = {-1, -0.4},
     .body.make_obstacle = make_bend_ball},
    {"race", "Run time and error", "run time against error, measured now",
     PICTURE_RACE, HAS_MESH | HAS_SPRINGS | HAS_MINIMISATION | HAS_BODY,
     /* motion without chaos; a tolerance below the error of every time step */
     "--stretch 1.1 --tolerance 1e-8", create_race_scene, .step_name = "run",
     .step = step_race_scene, .switch_labels = {"error over h"},
     .group_heading = "Measured now"},
    {"envelope", "How far it can be trusted",
     "where the square converges: h across, k upwards", PICTURE_ENVELOPE,
     HAS_MESH | HAS_SPRINGS | HAS_MINIMISATION | HAS_TIMESTEP, NULL,
     create_envelope_scene, .step_name = "row", .step = step_envelope_scene},
    /* Scenes of the tour, small enough to compute on paper. */
    {"landscape", "Search directions",
     "without projection Newton may go uphill; clamped, never",
     PICTURE_LANDSCAPE,
     HAS_START | HAS_SPRINGS | HAS_MINIMISATION | HAS_TIMESTEP,
     "--start 0.1,-0.35 --tolerance 1e-6 --timestep 0.2",
     create_landscape_scene, .step_name = "iteration", .starts_paused = true,
     .step = step_descent, .after_drag = descent_update_direction,
     .update_direction = descent_update_direction, .handle_kinds = "tx",
     .switch_labels = {"inertia", "elasticity"}, .is_hidden = true},
    {"arrows", "One mass",
     "one mass on a spring: the arrows of three Euler steps", PICTURE_MASS,
     HAS_MOTION | HAS_START, "--timestep 0.5 --start 1,0", create_arrows_scene,
     .starts_paused = true, .handle_kinds = "xv", .is_hidden = true},
    {"tangent", "Newton in one dimension",
     "Newton in one dimension: tangents of g, parabolas of E", PICTURE_TANGENT,
     HAS_START | HAS_MINIMISATION | HAS_ONE_COORDINATE | HAS_TIMESTEP,
     "--start 2.5 --tolerance 1e-10 --line-search none --timestep 0.3",
     create_tangent_scene, .step_name = "iteration", .step = step_descent,
     .after_drag = descent_update_direction, .handle_kinds = "xt",
     .is_hidden = true},
    {"dial", "The time step as a dial",
     "a longer time step: from free flight to the rest shape", PICTURE_DIAL,
     HAS_TIMESTEP, "--timestep 0.005", create_dial_scene, .step_name = "point",
     .step = step_dial_scene, .after_drag = dial_update_curve,
     .handle_kinds = "t", .switch_labels = {"inertia", "elasticity"},
     .is_hidden = true},
    {"spring", "One spring",
     "one spring: energy, force, eigenvalues; drag its end", PICTURE_SPRING,
     HAS_MOTION | HAS_START | HAS_SPRINGS | HAS_MINIMISATION,
     "--timestep 0.02 --start 0.6,0.3 --tolerance 1e-6", create_spring_scene,
     .handle_kinds = "x", .switch_labels = {"with the square root"},
     .is_hidden = true},
    {.name = NULL},
};

const Scene *scene_find(const char *text)
{
    int place = names_find_or_parse(NAMES_OF(scenes), text);
    return place < 0 ? NULL : &scenes[place];
}

void scene_store_guess(Simulation *simulation, double x, double y)
{
    const Scene *scene = simulation->scene;
    const double *p = simulation->descent.direction;
    double at[2];
    int count = simulation_find_shown_point(simulation, at);
    const double iterate[2] = {at[0] + p[0], at[1] + p[1]}, *end = iterate;
    MassStep step;
    if (simulation->is_over || count == 0)
        return;
    if (scene->step == step_dial_scene)
        end = simulation->exhibit.dial.minimiser[DIAL_POINTS - 1];
    if (scene->traits & HAS_TIME) {
        mass_find_next_step(simulation, 0, &step);
        end = step.new_x;
    }
    simulation->prediction = (UserPrediction){
        .has_guess = true,
        .guess_step = simulation->steps,
        .guess = {x, y},
        .outcome = {end[0], end[1]},
        .error = math_hypot(end[0] - x, count == 1 ? 0 : end[1] - y)};
}
