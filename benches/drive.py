"""Compares fluxfit's drive simulator with motulator 0.5.0, an independent one, on the paper's rig with switched PWM. Prints Markdown.

    drive.py [directory of fluxfit-benches' binaries]      default target/release

fluxfit is measured before and after motulator, in the same run, and the faster of the two counts, because other work only slows a run. Exit status 1 if a limit is exceeded.
"""

import json
import subprocess
import sys
import time

import motulator.drive.control.sm as control
import numpy as np
from motulator.drive import model, utils
from motulator.drive.control._common import SpeedController

SECONDS = 0.1  # simulated by motulator; up to speed under load, as the rig
SAMPLE_PERIOD, U_DC = 1e-4, 310.0
INERTIA, FRICTION, LOAD = 0.003, 0.008, 10.0
OMEGA_E = 4 * 1000 * 2 * np.pi / 60
CURRENT_BANDWIDTH, SPEED_BANDWIDTH = 2 * np.pi * 200, 2 * np.pi * 20
MAX_CURRENT = 20

MILLISECONDS_LIMIT = 12.0
FACTOR = 800.0
CORES = 1.8


def motulator_seconds(pwm):
    """Wall time of one simulated second."""
    motor = utils.SynchronousMachinePars(n_p=4, R_s=0.958, L_d=5.25e-3, L_q=12e-3, psi_f=0.1827)
    mechanics = model.StiffMechanicalSystem(J=INERTIA, B_L=FRICTION, tau_L=lambda t: LOAD)
    drive = model.Drive(model.VoltageSourceConverter(u_dc=U_DC), model.SynchronousMachine(motor), mechanics)
    if pwm:
        drive.pwm = model.CarrierComparison()
    reference = control.CurrentReferenceCfg(motor, nom_w_m=2 * np.pi * 75, max_i_s=MAX_CURRENT)
    controller = control.CurrentVectorControl(
        motor, reference, T_s=SAMPLE_PERIOD, J=INERTIA, alpha_c=CURRENT_BANDWIDTH, sensorless=False
    )
    controller.speed_ctrl = SpeedController(INERTIA, SPEED_BANDWIDTH)
    controller.ref.w_m = lambda t: OMEGA_E * min(t / 0.15, 1)
    start = time.perf_counter()
    model.Simulation(drive, controller).simulate(t_stop=SECONDS)
    return (time.perf_counter() - start) / SECONDS


def main():
    binaries = sys.argv[1] if len(sys.argv) > 1 else "target/release"

    def fluxfit():
        return json.loads(subprocess.run([f"{binaries}/drive"], check=True, capture_output=True, text=True).stdout)

    before = fluxfit()
    peer = {"averaged": motulator_seconds(False), "switched": motulator_seconds(True)}
    after = fluxfit()
    print("| one simulated second of the paper's rig, 10 kHz | fluxfit, ms | motulator 0.5.0, s | times |\n|---|--:|--:|--:|")
    factors = {}
    for kind in ("averaged", "switched"):
        ours = min(run[f"{kind}_ms_per_second"] for run in (before, after))
        factors[kind] = 1e3 * peer[kind] / ours
        print(f"| {kind} | {ours:.2f} | {peer[kind]:.2f} | {factors[kind]:.0f} |")
    ours = min(run["switched_ms_per_second"] for run in (before, after))
    one, both = (min(run[f"draws_seconds_{threads}"] for run in (before, after)) for threads in ("one_thread", "all_threads"))
    print(f"\n{before['draws']} noise draws of 0.2 s: {one:.2f} s on one thread, {both:.2f} s on {before['threads']}: {one / both:.2f} times")
    kept = ours <= MILLISECONDS_LIMIT and factors["switched"] >= FACTOR and one / both >= CORES * before["threads"] / 2
    sys.exit(0 if kept else 1)


if __name__ == "__main__":
    main()
