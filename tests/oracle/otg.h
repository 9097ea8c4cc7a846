/* A C interface behind which any online trajectory generator can be put. Arrays have `dofs` entries;
 * SI units; vmin and amin are negative. */
#ifndef TAKT_TESTS_ORACLE_OTG_H
#define TAKT_TESTS_ORACLE_OTG_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define OTG_VERSION 1u
#define OTG_MAX_SEGMENTS 32

enum {
    OTG_VELOCITY = 1, /* reach a velocity; position and velocity limits play no part */
    OTG_PHASE = 2,    /* a straight line where the limits allow it */
    OTG_NO_SYNC = 4,  /* each axis for itself */
    OTG_DISCRETE = 8, /* the duration is a multiple of the cycle */
    OTG_SECOND = 16   /* no jerk limit */
};

typedef struct {
    uint32_t dofs;
    uint32_t flags;
    double cycle;
    double min_duration; /* zero: none */
    const double *p0, *v0, *a0;
    const double *pf, *vf, *af;
    const double *vmax, *vmin, *amax, *amin, *jmax;
} otg_problem;

/* a(t) = a + j t for 0 <= t <= dt */
typedef struct {
    double dt, a, j;
} otg_segment;

uint32_t otg_abi_version(void);
const char* otg_name(void);
/* Everything that allocates happens here; NULL on failure. */
void* otg_open(uint32_t dofs, double cycle);
/* 0: solved, and the trajectory is kept in the handle. */
int32_t otg_solve(void* handle, const otg_problem* problem, double* duration);
void otg_sample(void* handle, double t, double* p, double* v, double* a);
/* Writes at most OTG_MAX_SEGMENTS segments of one axis, returns their number. */
uint32_t otg_segments(void* handle, uint32_t dof, otg_segment* out);
void otg_close(void* handle);

#ifdef __cplusplus
}
#endif

#endif
