/* hud.h - what the texts around the picture say: numbers of the last step,
 * energies over time, and which of all this is switched on.
 */
#ifndef ELASTO_HUD_H
#define ELASTO_HUD_H

#include "picture/history.h"
#include "scenes/simulation.h"
#include "picture/trail.h"

enum { HUD_NOTE_SIZE = 64 };

typedef struct Hud {
    bool text;   /* numbers, plot and legend */
    bool strain; /* springs coloured by strain */
    bool keys;   /* the list of keys */
    int column;  /* enum LectureColumn of show.h */
    bool paused;
    double speed;      /* simulated over real time, as it is set */
    double measured;   /* the same as it is reached; 0: unknown */
    bool stepped;      /* at least one step was made */
    int iterations;    /* Newton updates of the last step */
    int trials;        /* energies its line searches looked at */
    int projected;     /* springs projected, in the update that had most */
    double alpha;      /* its smallest step length */
    double slope;      /* of its last direction, J s^2: < 0 is downhill */
    Status trouble;    /* of the last step, if it did not converge or failed */
    long trouble_step; /* 0: at the start */
    bool hints;        /* say which key helps: there are keys */
    char note[HUD_NOTE_SIZE]; /* what a key just did, or "" */
    History history; /* total, kinetic, elastic energy, J; or radii, m */
    Trail trail;     /* of node 0 in each run, in the circle */
} Hud;

/* Text on, everything else off, nothing seen yet. */
void hud_create(Hud *hud);

/* Forgets the run, keeps what is switched on. */
void hud_restart(Hud *hud);

/* Before a step, at each Newton update, and after the step. */
void hud_begin_step(Hud *hud);
void hud_add_update(Hud *hud, const NewtonRecord *record);
void hud_end_step(Hud *hud, const Simulation *simulation);

/* Takes what curves and trails show of the state now; once for each drawn
 * state.  Energies are not computed while text is off. */
void hud_sample(Hud *hud, const Simulation *simulation);

#endif
