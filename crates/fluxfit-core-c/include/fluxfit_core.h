/* Recursive estimators of the electrical parameters of a permanent magnet synchronous motor. f32, no allocation; the caller gives the
 * memory. SI units, amplitude-invariant dq frame, electrical rad/s. Link with libfluxfit_core_c.a. */
#ifndef FLUXFIT_CORE_H
#define FLUXFIT_CORE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Memory of an estimator. Its content is private. */
typedef struct { uint64_t words[64]; } fluxfit_rls;
typedef struct { uint64_t words[96]; } fluxfit_ekf;

/* rs in ohm, ld and lq in H, psi_f in Wb, and their standard errors. */
typedef struct { float value[4]; float standard_error[4]; } fluxfit_estimate;

/* Block least squares with gated forgetting: needs no good start, and tells by its standard errors what the samples determine.
 * nominal: rs, ld, lq, psi_f within a factor of some tens. */
void fluxfit_rls_init(fluxfit_rls *rls, const float nominal[4]);
/* A measured current from which on periods follow: at the start, and after a gap. */
void fluxfit_rls_begin(fluxfit_rls *rls, float id, float iq);
/* One period: the voltage that acted over it, in the dq frame at its middle, the mean speed, its length, and the current at its end.
 * Returns 1 if the estimate changed, which it does every 50 periods. */
int32_t fluxfit_rls_advance(fluxfit_rls *rls, float ud, float uq, float omega_e, float length, float id, float iq);
void fluxfit_rls_estimate(const fluxfit_rls *rls, fluxfit_estimate *estimate);
/* 1 if the last half second excited the parameters. */
int32_t fluxfit_rls_is_excited(const fluxfit_rls *rls);

/* Kalman filter: start it at what block least squares found. unknown_voltage: standard deviation of voltages that act but are not
 * commanded, V. tracks: 1 for parameters that drift and step, 0 for constant ones. */
void fluxfit_ekf_init(fluxfit_ekf *ekf, const float start[4], float rated_current, float unknown_voltage, int32_t tracks);
void fluxfit_ekf_begin(fluxfit_ekf *ekf, float id, float iq);
void fluxfit_ekf_advance(fluxfit_ekf *ekf, float ud, float uq, float omega_e, float length, float id, float iq);
/* 0 while fluxfit_rls_is_excited says 0: what one operating point does not tell is then held, and becomes less certain. */
void fluxfit_ekf_note_excitation(fluxfit_ekf *ekf, int32_t is_excited);
void fluxfit_ekf_estimate(const fluxfit_ekf *ekf, fluxfit_estimate *estimate);

#ifdef __cplusplus
}
#endif
#endif
