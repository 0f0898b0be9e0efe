/* Every tolerance of the simulation on one page: its unit, why it has this size, and what a change of it does. All are
 * far above the rounding of doubles in metres and seconds and far below what can be seen on a table; none is there to
 * make a result look better. A change of any but the caps changes results in their last bits at least. */
#ifndef BILLIARD_PHYSICS_TOLERANCES_H
#define BILLIARD_PHYSICS_TOLERANCES_H

/* ---- motion ---- */

/* m/s. A ball slower than this in centre and rim rests: it would go on for less than 1e-15 m. Larger: balls stop short
 * of where they roll out; much smaller: events without visible motion. */
static const double REST_SPEED = 1e-8;
/* Share of the ball's own speed and rim speed. Slip below it is rounding: the ball rolls. Smaller: rolling balls begin
 * slides of 1e-16 s; larger: a ball struck to roll at once is forced to. */
static const double SLIP_ROUNDING = 1e-13;

/* ---- a bed that is not level ---- */

/* m, when a table names none (bed.path_error). The path between the ends of a piece is nowhere farther from the true
 * one. A tenth of what a camera resolves; a tenth of it takes twice the pieces. */
static const double PATH_ERROR = 1e-5;
/* Share of it that a phase's last piece, taken as if the pull across did not turn the ball, may be off at its end. */
static const double LAST_PIECE = 0.025;
/* rad, by which the direction may turn in a piece: keeps the Runge-Kutta step's own error below 1e-6 m. */
static const double PIECE_TURN = 0.25;
/* Share of the slope at which a resting ball would begin to roll: steeper beds are refused. */
static const double STEEPEST = 0.9;

/* ---- prediction of contacts ---- */

/* Share of the sizes of two velocities or accelerations: a smaller difference is none. Two units in the last place.
 * Larger: slow approaches are missed; smaller: balls in line are taken to meet by rounding. */
static const double ROUNDING = 4e-16;
/* Share of the squared distance of two touching balls: nearer ones touch. Covers the rounding of positions and of a
 * contact's time at 20 m/s. Larger: balls that only come near are taken to touch, and do not meet again; smaller: balls
 * that part are found to meet at once. */
static const double TOUCH = 1e-12;
/* m, by which boxes around paths are widened. Only what a box can decide is left out by it; larger costs time. */
static const double BOX_SLACK = 1e-9;
/* m, the same for the boxes around pockets, made once for a table. */
static const double REGION_SLACK = 1e-6;

/* ---- roots ---- */

/* Share of a root: two units in the last place, nearer is not to be had. */
static const double ROOT_CLOSE = 4.5e-16;
/* Iterations; the methods converge in a handful, the cap only bounds the time of what nobody has seen. */
enum { NEWTON_MAX = 200 };

/* ---- contacts of one instant ---- */

/* s. Contacts within it are one instant: above the rounding of a contact's time, and at 20 m/s less than 1e-10 m.
 * Smaller: contacts at once are taken one after the other and mirrored positions give unlike results. */
static const double SAME_INSTANT = 4e-12;
/* Sweeps over the contacts of a group, and the share of the speed at which the largest change ends them: the last bit. */
enum { SWEEPS_MAX = 2000 };
static const double SWEEP_END = 1e-16;
/* Contacts of one instant: more are an inelastic collapse, not a cascade through a rack (a rack's has at most 40). */
enum { CASCADE_MAX = 150 };
/* Share of the speed by which each contact beyond parts the balls. */
static const double CASCADE_LIFT = 1e-4;
/* The thesis' topspin adds speed at each contact: in a cascade of one instant it counts for this many contacts only. */
enum { TOPSPIN_MAX = 32 };

/* ---- contacts that overlap in time ---- */

/* m/s. Slower balls press on each other by less than a micrometre: they meet one after the other. */
static const double CLUSTER_SPEED = 1e-3;
/* Clusters of one instant: what still approaches after as many is resolved as contacts without time. */
enum { CLUSTERS_MAX = 40 };
/* Contact times at the speed of the first approach: gaps that close within them may matter. */
static const double CLUSTER_REACH = 3;
/* Steps of a contact's time. Error of a velocity about 2 / CLUSTER_STEPS^2; the cost grows with it. */
enum { CLUSTER_STEPS = 20 };
/* A rack's break is over after some 8 contact times; slower ends have long been separate contacts. */
enum { CLUSTER_STEPS_MAX = 60 * CLUSTER_STEPS };
/* Restitution below it is not damped more: the damping would overshoot. */
static const double LEAST_RESTITUTION = 0.05;

/* ---- pressing contacts ---- */

/* s, and share of the time in which the cloth could take all their motion. Two bodies that press on each other meet
 * again no sooner than this. The restitution laws have no force that lasts; without a bound, a pressed pair bounces
 * ever faster (Luding and McNamara 1998 bound it likewise). Smaller: more events; larger: pressed balls wander. */
static const double PRESS_INTERVAL = 2e-3;
static const double PRESS_SHARE = 2e-3;
/* s, the same for a ball that a slope rolls along a cushion: it leaves it by less than 10 um. */
static const double ROLL_PRESS_INTERVAL = 0.05;
/* Share of the pair's root mean square speed; at most this much goes into keeping them apart. */
static const double LIFT_SHARE = 0.2;

/* ---- Mathavan's cushion ---- */

/* Shares of the speed before: error estimate allowed a step; a slip that counts as none; an impulse no impact needs. A
 * tenth of the first two costs twice the time and changes results by less than 2e-5. */
static const double IMPACT_ERROR = 1e-6;
static const double IMPACT_REST_SLIP = 1e-5;
static const double IMPULSE_MAX = 20;
/* Share of the speed: the impulse that is left at a phase's end. */
static const double IMPULSE_END = 1e-9;
/* Steps of one phase; a phase that takes more is taken as wedged. */
enum { IMPACT_STEPS_MAX = 1000 };

/* ---- tables and positions ---- */

/* m. A jaw whose surface passes within this of a cushion's end covers that end: drawings are rounded to 0.1 mm.
 * Smaller: rounded drawings get sharp tips beside their jaws. */
static const double COVER_TOLERANCE = 5e-4;
/* m. Balls seen by a camera may seem to overlap by this much: they are taken to touch. */
static const double OVERLAP_ALLOWED = 1e-4;

#endif
