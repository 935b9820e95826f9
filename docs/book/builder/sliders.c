/* The functions of a robot for a page. The page writes q, v and a to `arguments` and calls `run`.
   Then torques, energies and placements are at `results`. */
#include "robot.h"

#define EXPORTED(name) __attribute__((export_name(#name))) name

static double in[3 * ROBOT_NV], out[ROBOT_NV + 2 + 12 * ROBOT_FRAMES];

double *EXPORTED(arguments)(void);
double *EXPORTED(results)(void);
void EXPORTED(run)(void);

double *arguments(void) {
    return in;
}

double *results(void) {
    return out;
}

void run(void) {
    const double *q = in, *v = in + ROBOT_NV, *a = in + 2 * ROBOT_NV;
    robot_inverse_dynamics(q, v, a, out);
    robot_kinetic_energy(q, v, out + ROBOT_NV);
    robot_potential_energy(q, out + ROBOT_NV + 1);
    robot_placements(q, out + ROBOT_NV + 2);
}
