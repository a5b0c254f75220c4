/* A simulated motor, identified as firmware would: block least squares for the first 0.15 s, then a Kalman filter from there.
 * Prints the four parameters; exit status 1 if one is more than 1 % off. */
#include "fluxfit_core.h"
#include <math.h>
#include <stdio.h>

static const double RS = 0.958, LD = 5.25e-3, LQ = 12e-3, PSI_F = 0.1827, TS = 1e-4, OMEGA = 400.0;

/* One period of the motor in 100 small steps. The voltage stands still in the stator. */
static void motor(double i[2], double ud, double uq)
{
    const int steps = 100;
    const double h = TS / steps;
    for (int n = 0; n < steps; n++) {
        const double angle = OMEGA * (0.5 * TS - (n + 0.5) * h);
        const double vd = cos(angle) * ud - sin(angle) * uq, vq = sin(angle) * ud + cos(angle) * uq;
        double d = i[0], q = i[1];
        for (int pass = 0; pass < 3; pass++) { /* implicit midpoint rule */
            const double sd = (vd - RS * d + OMEGA * LQ * q) / LD, sq = (vq - RS * q - OMEGA * (LD * d + PSI_F)) / LQ;
            d = i[0] + 0.5 * h * sd;
            q = i[1] + 0.5 * h * sq;
        }
        i[0] = 2 * d - i[0];
        i[1] = 2 * q - i[1];
    }
}

int main(void)
{
    const float nominal[4] = {0.7f, 7e-3f, 9e-3f, 0.16f};
    const double truth[4] = {RS, LD, LQ, PSI_F};
    fluxfit_rls rls;
    fluxfit_ekf ekf;
    fluxfit_estimate estimate;
    double i[2] = {0, 0};
    int failed = 0;

    fluxfit_rls_init(&rls, nominal);
    fluxfit_rls_begin(&rls, 0, 0);
    for (int k = 0; k < 10000; k++) {
        /* A controller of 100 Hz whose references step every 20 ms. */
        const double id = (k / 200) % 2 ? -2 : 0, iq = (k / 400) % 2 ? 9 : 5;
        const float ud = (float)(628 * LD * (id - i[0]) - OMEGA * LQ * i[1]);
        const float uq = (float)(628 * LQ * (iq - i[1]) + OMEGA * (LD * i[0] + PSI_F));
        motor(i, ud, uq);
        const int32_t changed = fluxfit_rls_advance(&rls, ud, uq, (float)OMEGA, (float)TS, (float)i[0], (float)i[1]);
        if (k == 1500) {
            fluxfit_rls_estimate(&rls, &estimate);
            fluxfit_ekf_init(&ekf, estimate.value, 10, 0, 1);
            fluxfit_ekf_begin(&ekf, (float)i[0], (float)i[1]);
        } else if (k > 1500) {
            if (changed)
                fluxfit_ekf_note_excitation(&ekf, fluxfit_rls_is_excited(&rls));
            fluxfit_ekf_advance(&ekf, ud, uq, (float)OMEGA, (float)TS, (float)i[0], (float)i[1]);
        }
    }
    for (int who = 0; who < 2; who++) {
        if (who == 0)
            fluxfit_rls_estimate(&rls, &estimate);
        else
            fluxfit_ekf_estimate(&ekf, &estimate);
        printf("%s", who == 0 ? "rls" : "ekf");
        for (int j = 0; j < 4; j++) {
            printf(" %.6g", estimate.value[j]);
            failed |= !(fabs(estimate.value[j] / truth[j] - 1) < 0.01);
        }
        printf("\n");
    }
    return failed;
}
