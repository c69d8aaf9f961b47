#include "scenes/pages.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* In the texts \u00a0 is a blank at which no line is broken. */

#define LECTURE "src/lecture.c"

/* Cards of the square while Algorithm 3 is the topic. */
#define CARDS_NEWTON "page listing line residual"

const LecturePage lecture_pages[] = {
    /* ---- what is simulated ---------------------------------------------- */
    {.name = "solid",
     .topic = "Spatial discretisation",
     .text = "A solid is cut into cells. Its mass sits in the corners of the "
             "cells; springs along their edges and diagonals hold it together.",
     .line = "square --stretch 1 --segments 4",
     .numbers = true,
     .cards = "page",
     .look = "With 4 segments 25 masses and 72 springs, with n (n + 1)² and "
             "4n² + 2n: in rows, in columns, and two diagonals in each cell.",
     .touch = "Drag the number of segments: more masses and springs, the same "
              "1000 kg.",
     .file = LECTURE,
     .function = "square",
     .lit = "add_spring",
     .claim = "4 segments give 25 masses and 72 springs; with any number of "
              "segments all masses together have 1000 kg."},
    {.name = "mesh",
     .topic = "The mesh and its numbers",
     .text = "With n segments on a side, node i (n + 1) + j stands in column i "
             "and row j, counted from the lower left. A spring is a pair of "
             "such numbers.",
     .line = "square --stretch 1 --segments 2",
     .numbers = true,
     .cards = "page",
     .look = "Nodes are numbered upwards, column by column. With "
             "n\u00a0=\u00a02: 0 lower "
             "left, 8 upper right; 6 springs are horizontal, 6 vertical, 8 "
             "diagonal.",
     .touch = "Point at a spring: the numbers of its two nodes are shown. "
              "Point at a node, too.",
     .file = LECTURE,
     .function = "square",
     .lit = "add_spring",
     .claim = "In the mesh of 2 segments node 1 is above node 0 and node 3 to "
              "its right; the first spring joins 0 and 3, and every squared "
              "rest length is 1/4 or 1/2."},
    {.name = "equation",
     .topic = "Equation of motion and mass matrix",
     .text = "M dv/dt = −∇P(x): mass times acceleration is force, and force is "
             "minus the gradient of the energy. M is diagonal and holds the "
             "masses of the nodes.",
     .line = "square --stretch 1.4",
     .cards = "page energies",
     .look = "Press Space: the stretched square swings. Its inner forces "
             "cancel in pairs, so its middle stays where it is.",
     .touch = "Drag the stretch, or pull at a node.",
     .file = LECTURE,
     .function = "spring_grad",
     .lit = "g_diff",
     .claim = "Each of the 25 masses is 40 kg, the forces of all springs add "
              "up to zero, and after 50 steps the middle of the square has "
              "not moved.",
     .film = 20},
    /* ---- stepping through time ------------------------------------------ */
    {.name = "forward",
     .topic = "Forward Euler",
     .text = "Velocity and force at the start of the step carry the mass "
             "through all of it: x′\u00a0=\u00a0x\u00a0+\u00a0h\u00a0v, "
             "v′\u00a0=\u00a0v\u00a0+\u00a0h\u00a0a(x).",
     .line = "arrows --integrator forward-euler",
     .cards = "page numbers energies",
     .look = "The step leaves the exact path along its tangent. Each step "
             "gains energy.",
     .touch = "Drag the mass, the tip of v, or h. Click where the next step "
              "will end, then press N.",
     .file = LECTURE,
     .function = "forward_euler",
     .lit = "x[i] = add",
     .claim = "One step from (1, 0) with v = (0, 1) and h = 0.5 leads to "
              "(1, 0.5), and every step multiplies the energy by 1 + h².",
     .film = 12,
     .predict = true},
    {.name = "symplectic",
     .topic = "Symplectic Euler",
     .text = "First the velocity, then the position with the new velocity: "
             "v′\u00a0=\u00a0v\u00a0+\u00a0h\u00a0a(x), "
             "x′\u00a0=\u00a0x\u00a0+\u00a0h\u00a0v′.",
     .line = "arrows --integrator symplectic-euler",
     .cards = "page numbers energies",
     .look = "One v differs from forward Euler, and now the energy stays "
             "bounded: the path is an ellipse.",
     .touch = "Drag h: the ellipse gets longer. From h\u00a0=\u00a02\u00a0s on "
              "the mass flies away.",
     .file = LECTURE,
     .function = "symplectic_euler",
     .lit = "x[i] = add",
     .claim = "|x|² + |v|² − h x·v stays what it was at the start, to "
              "rounding, through 1000 steps with h = 0.5.",
     .film = 14,
     .predict = true},
    {.name = "backward",
     .topic = "Backward Euler",
     .text = "The force is taken at the end of the step: "
             "v′\u00a0=\u00a0v\u00a0+\u00a0h\u00a0a(x′), "
             "x′\u00a0=\u00a0x\u00a0+\u00a0h\u00a0v′. The unknown x′ is on "
             "both sides: an equation must be solved.",
     .line = "arrows --integrator backward-euler",
     .cards = "page numbers energies",
     .look = "The arrow of the force starts where the step ends. Each step "
             "loses energy.",
     .touch = "Drag h as far as you like: the mass is drawn to the middle, it "
              "never flies away.",
     .file = LECTURE,
     .function = "step_forward",
     .lit = "v[i] = mul(1 / h",
     .claim = "One step from (1, 0) with v = (0, 1) and h = 0.5 leads to "
              "(0.8, 0.4), and every step divides the energy by 1 + h².",
     .film = 12,
     .predict = true},
    {.name = "stability",
     .topic = "Stability on the circle",
     .text = "All three methods on the same circle: one spirals outwards, one "
             "stays, one spirals inwards.",
     .line = "circle",
     .cards = "page radius",
     .look = "The radius over time: in each step forward Euler multiplies it "
             "by √(1 + h²ω²), backward Euler divides it by that.",
     .touch = "Drag h while it runs. Above 2/ω\u00a0=\u00a00.318\u00a0s the "
              "symplectic one flies away, too.",
     .file = "src/scenes/mass_scenes.c",
     .function = "create_orbit",
     .lit = "names[i]",
     .claim = "With h = 0.02 s each step of forward Euler multiplies the "
              "radius by 1.00786, backward Euler divides it by that; the "
              "symplectic one stays within 4 percent, with 0.31 s within 7 m, "
              "with 0.33 s not for 10 steps.",
     .film = 32,
     .plays = true},
    {.name = "explicit",
     .topic = "Why not explicit steps",
     .text =
         "An explicit step must be short compared to the fastest oscillation "
         "of the square. A little too long, and the square explodes.",
     .line = "square --integrator symplectic-euler --timestep 0.008",
     .cards = "page energies",
     .look = "Press Space: the square tears itself apart within a few steps.",
     .touch = "Drag h down to 0.003 s and press R: it swings on. Backward "
              "Euler can take any h.",
     .file = LECTURE,
     .function = "symplectic_euler",
     .lit = "v[i] = sub",
     .claim = "With h = 0.008 s symplectic Euler overflows within 20 steps, "
              "with 0.003 s it swings on for 1000; backward Euler ends every "
              "step with 0.008 s and with 1 s.",
     .film = 11},
    /* ---- Newton's method ------------------------------------------------ */
    {.name = "tangent",
     .topic = "Newton's method in one dimension",
     .text = "Follow the tangent of g to its zero, then repeat. Below is the "
             "same step for E, with E′ = g: to the lowest point of the "
             "parabola that fits E.",
     .line = "tangent",
     .cards = "page numbers residual",
     .look = "Tangent and parabola lead to the same x. Near the root each "
             "update doubles the number of correct digits.",
     .touch = "Drag the start or x̃. Click where the next iterate will be, "
              "then press N.",
     .file = "src/scenes/descent.c",
     .function = "newton_direction",
     .lit = "scalar ? -g",
     .claim = "From 2.5 six updates reach the root 1.17799, and near it each "
              "error is g″/(2 g′) = 0.95 times the square of the one "
              "before.",
     .film = 6,
     .predict = true},
    {.name = "newton",
     .topic = "Newton in n dimensions: Algorithm 1",
     .text =
         "In n dimensions the slope is a vector g, the curvature a matrix H. "
         "Solve H\u00a0p\u00a0=\u00a0−g, move by p, repeat while |g| > ε.",
     .line = "landscape --filter none --line-search none --start 0.6,0.9",
     .cards = "page listing residual",
     .look = "A few updates lead to the bottom of the valley; the residual "
             "falls faster and faster.",
     .touch = "Drag the start into the shade, where E is not convex: p can "
              "point uphill, the end be a saddle.",
     .file = LECTURE,
     .function = "search_dir",
     .lit = "cholmod_solve",
     .claim = "From (0.6, 0.9) Algorithm 1 needs 5 updates, and each "
              "direction solves H p = −g to 12 digits; from (0.05, −0.05) it "
              "ends on a saddle.",
     .film = 5,
     .predict = true},
    {.name = "overshoot",
     .topic = "Overshooting",
     .text = "Where the curvature is small, Newton's step is too long: it ends "
             "farther out than it began, and the next one is longer still.",
     .line = "overshoot",
     .cards = "page line residual",
     .look = "f has a single valley, but from 2 the first step leads to −11.6 "
             "and the next one beyond 3·10⁹.",
     .touch = "Drag the start: nearer to 0 than 1.0886 it converges, else it "
              "flies away. L: line search.",
     .file = "src/scenes/descent.c",
     .function = "update_iterate",
     .lit = "x[i] +=",
     .claim = "From 2 the first update leads to −11.645 and the next beyond "
              "3e9; from 1.08 it converges, from 1.09 it makes seven swings, "
              "each wider.",
     .film = 2,
     .predict = true},
    {.name = "explodes",
     .topic = "Overshooting: the square explodes",
     .text = "No projection, no line search: Algorithm 1. ‖p‖∞ is the largest "
             "|p_x| + |p_y| of a node.",
     .line = "square --segments 3 --timestep 0.02 --stretch 0.485 --filter "
             "none --line-search none",
     .open = "finer; finer; next; next; next",
     .lines = 12,
     .cards = CARDS_NEWTON,
     .look = "N, line by line: within one step E rises to 2·10¹⁶, nodes fly "
             "over a kilometre.",
     .touch =
         "P tames it: 5 updates. L alone stops it: p points uphill, and no "
         "step helps.",
     .file = LECTURE,
     .function = "step_forward",
     .lit = "line_search(",
     .claim = "Within the first step E rises above 10¹⁶ and a node is more "
              "than a kilometre away; with projection it converges in 5 "
              "updates, and with projection or line search E never rises."},
    /* ---- a step as a minimisation --------------------------------------- */
    {.name = "minimise",
     .topic = "A time step is a minimisation",
     .text = "Backward Euler's equation is ∇E(x) = 0 with E(x) = ½ (x − x̃)ᵀ M "
             "(x − x̃) + h² P(x). It has a minimum: walk downhill.",
     .line = "square",
     .open = "next; next; next; finer; finer; next; next; next; next",
     .lines = 4,
     .cards = CARDS_NEWTON,
     .look = "The dashed ghost is x̃, where the masses would fly without "
             "springs. Springs pull them off it.",
     .touch = "Drag h: the longer the step, the farther from the ghost.",
     .file = LECTURE,
     .function = "ip_val",
     .lit = "return",
     .claim = "At the end of a step M (x − x̃) + h² ∇P(x) is zero "
              "within the tolerance: x is backward Euler's x′.",
     .film = 10},
    {.name = "parts",
     .topic = "Inertia against elasticity",
     .text = "E has two parts. Inertia wants x = x̃, elasticity wants the "
             "springs at rest length. The step ends where the two balance.",
     .line = "landscape --start 0.6,0.9",
     .cards = "page residual",
     .look = "Inertia alone is one round bowl. Elasticity alone has two "
             "valleys and a ridge between them.",
     .touch = "Switch each part off and on. Drag x̃: the bowl moves, the "
              "valleys stay.",
     .file = LECTURE,
     .function = "ip_grad",
     .lit = "spring_grad",
     .claim =
         "Inertia is lowest at x̃, elasticity where the springs have "
         "their rest length; at the minimum of the sum each part is above its "
         "own minimum."},
    {.name = "dial",
     .topic = "What the time step h does",
     .text = "h weighs elasticity against inertia: the longer the step, the "
             "nearer its end is to the rest shape, and the farther from x̃.",
     .line = "dial",
     .cards = "page numbers",
     .look = "The path of the minimiser: each point of it is the end of a step "
             "with another h.",
     .touch = "Drag h or x̃. Space turns h up by itself.",
     .file = "src/scenes/dial_scene.c",
     .function = "dial_minimise",
     .lit = "const double p[2]",
     .claim = "At h = 1 ms the minimiser is within 1 mm of x̃, at 10 s "
              "within 1 mm of rest, and on the way elasticity falls and "
              "inertia rises from point to point.",
     .speed = 0.25,
     .film = 20},
    {.name = "inertia",
     .topic = "Inertia energy",
     .text = "½ Σ m |x − x̃|² is a bowl around x̃ with the gradient M (x − "
             "x̃). Its Hessian is M and never changes.",
     .line = "landscape --start 0.6,0.9",
     .cards = "page numbers",
     .look = "Round contours: the Hessian is the same everywhere, and positive "
             "definite.",
     .touch = "N: one update leads to x̃. Drag x̃, or switch elasticity on.",
     .file = LECTURE,
     .function = "inertia_val",
     .lit = "dot",
     .claim = "At (0.6, 0.9) it is 0.26 J s², as the formula says, and "
              "one update leads to x̃, where Newton ends.",
     .flips = 2},
    /* ---- line search ---------------------------------------------------- */
    {.name = "alpha",
     .topic = "Line search on E(α)",
     .text = "Along p, E is a curve over α. It begins downhill, but at α = 1 "
             "it may be higher than at the start: then halve α.",
     .line = "square --stretch 0.2 --timestep 0.1",
     .open = "finer; finer; next; next; next; next; next",
     .lines = 8,
     .cards = "page line residual",
     .look = "The curve of E, the parabola that Newton's method assumes, and "
             "the values of α that were tried.",
     .touch = "N goes to the next line. L turns the line search off.",
     .file = LECTURE,
     .function = "line_search",
     .lit = "alpha /= 2",
     .claim = "In the first step α = 1 would raise E, and one of its "
              "updates is made with α = 1/8."},
    {.name = "algorithm2",
     .topic = "Algorithm 2: backtracking line search",
     .text = "Begin with α = 1. While E is higher than before, halve α. If p "
             "points downhill, this always ends.",
     .line = "overshoot --line-search backtrack",
     .cards = "page line residual",
     .look = "From 2 the first step takes α = 1/4, the second 1/2, all others "
             "1: now it converges.",
     .touch = "Drag the start anywhere: f falls in every update. Click where "
              "the next one ends, then press N.",
     .file = LECTURE,
     .function = "line_search",
     .lit = "alpha /= 2",
     .claim = "From 2 the step lengths are 1/4, 1/2, 1, 1, 1, 1, and f falls "
              "in every update.",
     .film = 6,
     .predict = true},
    /* ---- projection ----------------------------------------------------- */
    {.name = "descent",
     .topic = "Descent directions and projection",
     .text = "Where E is not convex, −H⁻¹ g may point uphill: no small step "
             "helps. With negative eigenvalues set to 0, p points downhill "
             "everywhere.",
     .line = "landscape --filter none",
     .cards = "page line",
     .look = "Two arrows from one place: Newton's direction climbs, the "
             "projected one falls. In the shaded region E is not convex.",
     .touch = "Drag the start over the map and watch both arrows. P turns the "
              "projection on.",
     .file = LECTURE,
     .function = "spring_hess",
     .lit = "make_psd",
     .claim = "At (0.1, −0.35) ∇E·p is above 0.1 without and below −0.1 "
              "with projection; from each of 289 starts the projected "
              "direction is downhill."},
    {.name = "psd",
     .topic = "make_PSD: eigenvalues set to 0",
     .text = "Each spring's 4 × 4 block is made positive semi-definite by "
             "itself: its negative eigenvalues are replaced by 0.",
     .line = "spring --start 0.6,0.3",
     .cards = "page eigenvalues",
     .look = "A short spring has a negative eigenvalue across it, a very short "
             "one also along it.",
     .touch = "Drag the end: above 1 m nothing is changed, below 0.577 m "
              "nothing is left.",
     .file = LECTURE,
     .function = "make_psd",
     .lit = "fmax",
     .claim = "The block has the eigenvalues 0, 0, and twice the curvatures "
              "along and across; below |d| = l/√3 projection leaves only 0."},
    {.name = "energy",
     .topic = "Spring energy, with and without the square root",
     .text =
         "P = ½ l² k (|d|²/l² − 1)² needs no square root: it is a polynomial, "
         "smooth even at length 0. 2k\u00a0(|d|\u00a0−\u00a0l)² is as stiff at "
         "rest, but has a kink at length 0.",
     .line = "spring --start 1.3,0",
     .cards = "page numbers profile",
     .look = "The two curves touch at rest. At length 0 one is smooth, the "
             "other has a sharp tip.",
     .touch = "Drag the end through the held one and watch the numbers.",
     .file = LECTURE,
     .function = "spring_val",
     .lit = "sum +=",
     .claim = "At rest both have the curvature 4k along the spring. At 1 mm "
              "the curvature across is −2k for P and −3996 k with the "
              "square "
              "root.",
     .flips = 1},
    {.name = "force",
     .topic = "Its gradient and its Hessian",
     .text = "With s = |d|²/l² − 1 the force is −2\u00a0k\u00a0s\u00a0d: along "
             "the spring, zero at rest. The Hessian is "
             "2k/l²\u00a0(2\u00a0d\u00a0dᵀ + (|d|²\u00a0−\u00a0l²)\u00a0I).",
     .line = "spring --start 1.2,0.5",
     .cards = "page numbers eigenvalues profile",
     .look =
         "At the circle of the rest length the force changes its direction.",
     .touch = "Drag the end: all numbers follow. Space lets it go.",
     .file = LECTURE,
     .function = "spring_grad",
     .lit = "g_diff",
     .claim = "At d = (1.2, 0.5) the energy is 23.805 J and the force "
              "(−165.6, −69) N; both agree with differences of P.",
     .film = 24},
    {.name = "potential",
     .topic = "The incremental potential and its Hessian",
     .text = "Energies add up, and so do gradients and Hessians. Each spring "
             "writes triplets (row, column, value); values for the same place "
             "are summed.",
     .line = "square --segments 4",
     .open = "next",
     .cards = "page spy",
     .look = "Each square is a 2 × 2 block. Two nodes without a common spring "
             "have none. Orange: filled in by Cholesky.",
     .touch = "Point at a spring: its four blocks light up. Drag the number of "
              "segments.",
     .file = LECTURE,
     .function = "ip_hess",
     .lit = "cholmod_triplet_to_sparse",
     .claim = "50 + 72 × 16 triplets fall on 676 of the 2500 places, and "
              "the matrix times q is the slope of the gradient along q."},
    /* ---- the whole ------------------------------------------------------ */
    {.name = "algorithm3",
     .topic = "Algorithm 3: projected Newton",
     .text = "Project, solve, search, update, test: each line of it is one "
             "press of N.",
     .line = "square --timestep 0.02 --stretch 0.5",
     .open = "finer; finer; next; next; next",
     .lines = 12,
     .cards = CARDS_NEWTON,
     .look = "The lit line, and what it does to the square: red springs were "
             "projected, arrows are p.",
     .touch = "N: next line, Left: back. P and L strike a line through.",
     .file = LECTURE,
     .function = "step_forward",
     .lit = "search_dir",
     .claim = "The first step projects 52 of 72 springs, takes 5 updates with "
              "α = 1, and E falls in each.",
     .film = 30},
    {.name = "step",
     .topic = "step_forward and its residuals",
     .text =
         "The loop ends when ‖p‖∞ / h ≤ ε. Here ‖p‖∞ is the largest |p_x| + "
         "|p_y| of a node, as in numpy for an n × 2 array. So ε is a velocity.",
     .line = "square --tolerance 1e-6",
     .open = "next",
     .cards = "page residual energies",
     .look = "The residual of each update on a logarithmic axis: in the first "
             "step it falls by a factor of 36, then of 330. A ring is an upper "
             "bound.",
     .touch = "Drag ε up to 0.01 m/s, as on the slides: that saves only two "
              "updates.",
     .file = LECTURE,
     .function = "residual",
     .lit = "fmax",
     .claim = "In the first step a tolerance of 10⁻⁶ m/s costs 2 updates more "
              "than 10⁻² m/s, and E falls in all of them.",
     .film = 10},
    {.name = "simulator",
     .topic = "The simulator",
     .text = "Build the square, stretch it, and take a step for each frame. "
             "That is all.",
     .line = "square",
     .cards = "page energies residual",
     .look = "The square swings and comes to rest. Backward Euler takes energy "
             "from it: the total falls.",
     .touch = "Pull at a node. Drag k, h or the stretch.",
     .file = LECTURE,
     .function = "main",
     .lit = "step_forward",
     .claim = "In 50 steps every one converges, and the total energy never "
              "rises.",
     .film = 20,
     .plays = true},
    /* ---- beyond --------------------------------------------------------- */
    {.name = "contact",
     .topic = "Contact: a barrier in E",
     .text = "Near a wall a barrier makes E grow without bound: one more term, "
             "smooth, zero farther away. A step is still a minimisation, and "
             "no update passes through a wall.",
     .line = "drop",
     .cards = "page energies residual",
     .look = "The square tumbles between floor and walls. A gap always stays.",
     .touch = "Drag h or k, or pull at a node. The gap shrinks, but it stays.",
     .file = "src/model/contact.c",
     .function = "contact_value",
     .lit = "barrier_value",
     .claim = "In 300 steps every one converges, and no node comes nearer to "
              "floor or walls than 1 mm.",
     .film = 240,
     .every = 16,
     .plays = true},
    {.name = "friction",
     .topic = "Friction",
     .text = "Friction acts against sliding, in proportion to the contact "
             "force. Its energy is smooth, too: below a slip speed the force "
             "fades to zero.",
     .line = "slope",
     .cards = "page energies",
     .look = "Three blocks on a slope of 20°. A block holds if its friction "
             "coefficient is above tan\u00a020°\u00a0=\u00a00.364: at the "
             "start two slide, one holds.",
     .touch = "Drag μ; the blocks have 0.5, 0.9, 1.1 times it. Above 0.404 the "
              "second one holds, too.",
     .file = "src/model/friction.c",
     .function = "friction_value",
     .lit = "return",
     .claim =
         "In 3 s the first block slides more than 7 m along, the last one "
         "less than 2 cm. With μ = 0.41 the second one comes to rest within "
         "6 cm, with 0.4 it does not; with μ = 0.32 the third one slides "
         "more than 50 cm.",
     .film = 300,
     .every = 15,
     .plays = true},
    {.name = "inelastic",
     .topic = "Inelasticity",
     .text = "Beyond its yield strain a spring flows: its rest length changes "
             "for good. The same minimisation finds the flow.",
     .line = "dent",
     .cards = "page energies residual",
     .look = "The square falls on a ball and keeps the dent. The energy that "
             "the flow took is \"plastic\" in the card below.",
     .touch = "Drag k, or pull at a node until the square stays bent.",
     .file = "src/model/plasticity.c",
     .function = "spring_law_value",
     .lit = "return",
     .claim = "After 300 steps a spring has a plastic strain above 0.05, all "
              "energies add up to those at the start, and no node is inside "
              "the ball.",
     .film = 192,
     .every = 16,
     .plays = true},
    {.name = "fracture",
     .topic = "Fracture",
     .text = "A spring that is stretched too far breaks at the end of a step, "
             "the most stretched one first: a crack opens and runs.",
     .line = "tear",
     .cards = "page energies",
     .look = "The sides are pulled apart. The slit opens slowly; then a crack "
             "runs through the square.",
     .touch = "Drag k or the number of segments.",
     .file = "src/model/fracture.c",
     .function = "find_candidates",
     .lit = "load",
     .claim =
         "In the first 20 steps no spring breaks, after 100 steps more than "
         "100 have, and their energy is \"fracture\": all energies add up.",
     .film = 98,
     .every = 7,
     .plays = true},
    {.name = "race",
     .topic = "Run time against error",
     .text = "Many methods, many time steps, one question: how much run time "
             "for how many digits? Each point is a run, measured now.",
     .line = "race",
     .cards = "page numbers",
     .look = "Steeper lines: higher order. On a soft square explicit methods "
             "win by far. Hollow: with this h it explodes later.",
     .touch = "Drag k up: the stiffer the square, the shorter the steps that "
              "explicit methods need.",
     .file = "src/scenes/race_scene.c",
     .function = "run_to_end",
     .lit = "time_integrator_step",
     .claim = "Halving h divides the error by 2 for the Euler methods, by 4 "
              "for Verlet and midpoint, by 16 for AVF of 4th order. With 8 ms "
              "Verlet explodes after the race, with 4 ms it does not.",
     .speed = 0.25,
     .film = 42,
     .plays = true},
    {.name = "trust",
     .topic = "How far it can be trusted",
     .text = "Time steps from a nanosecond to a quarter of an hour, stiffness "
             "over 21 powers of ten: three steps each.",
     .line = "envelope",
     .cards = "page numbers cell",
     .look = "Each cell is a run. Darker: more updates. Violet: within ε, "
             "nothing was done. Orange: did not converge, and said so.",
     .touch = "Point at a cell to see its run, click to load it. Drag the "
              "stretch for another map.",
     .file = "src/scenes/envelope_scene.c",
     .function = "envelope_visit",
     .lit = "time_integrator_step",
     .claim = "In 280 of the 550 cells every step passes the test without an "
              "update, with the square as stretched as before; of the others "
              "at least 97 of 100 converge. Every state is finite.",
     .speed = 0.25,
     .film = 22,
     .plays = true},
    {.name = NULL},
};

int lecture_count(void)
{
    int count = 0;
    while (lecture_pages[count].name)
        count++;
    return count;
}

const LecturePage *lecture_find(const char *text)
{
    char *end = NULL;
    long number = strtol(text, &end, 10);
    if (end != text && *end == '\0')
        return number >= 1 && number <= lecture_count()
                   ? &lecture_pages[number - 1]
                   : NULL;
    for (const LecturePage *page = lecture_pages; page->name; page++)
        if (strcmp(page->name, text) == 0)
            return page;
    return NULL;
}

Status lecture_options(const LecturePage *page, Options *options, char *message,
                       size_t size)
{
    Status status = options_of_line(page->line, options, message, size);
    options->page = page;
    options->flips = page->flips;
    options->speed = page->speed;
    return status;
}
