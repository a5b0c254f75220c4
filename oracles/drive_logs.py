#!/usr/bin/env python3
"""Logs of simulated PMSM drives with known truth, by a program that shares nothing with fluxfit's simulator. Needs numpy and numba.

    drive_logs.py --out DIR [--only SUBSTRING]         the 37 situations for each motor of MOTORS
    drive_logs.py --random N --seed S --out DIR        N drawn motors, courses, kinds of logs and faults
    drive_logs.py --check [LOG.csv.gz]                 is the simulator right? ideal logs, and one of another simulator, by least squares

What is simulated
  Motor: the state is the flux linkage in the stator frame, d psi / dt = v - R i: no speed voltage is written down, it follows from the
  rotation of the rotor's flux. The currents follow from the flux in the rotor's frame, with constant inductances or with saturation
  (of a co-energy, so that it is lossless) and with 5th and 7th harmonics of the magnets' flux. Amplitude-invariant transforms, motor
  convention, the d axis on phase a at angle 0.
  Inverter: two levels, three legs, centred carrier, switched edge by edge, min/max injection, one update a period. At each edge both switches
  are off for the dead time; the leg's voltage then follows the sign of the phase current. Close to zero current it rises over a narrow band,
  as with the switches' output capacitance, and so holds a current at zero that would change its sign. Devices may have a voltage drop.
  Controller: PI with decoupling on *measured* currents: sampled at the carrier's turning point (middle of a zero vector, so the ripple is
  sampled in its middle), noise of 0.5 % of the rated current in each phase, 12 bits. Its command of row k acts in the period from row k+1 to
  row k+2; its angle is turned 1.5 periods ahead, to that period's middle. The voltages are limited, with anti-windup.
  Speed: prescribed, as by a dynamometer; piecewise linear with rounded corners.

What a row says: t = k T; id, iq as measured and with the drive's angle; ud, uq the command computed from this row's currents, in the frame
of this row; omega_e, theta_e, u_dc as the drive believes.

Keys of "drive" (those absent have the default): td dead time, s; noise part of the rated current; adc false: no quantization; sched the course;
D duration, s; theta, udc_col false: column absent; lpi, lpu, lpw first-order filters on logged currents, voltages, speed, Hz; dec every
n-th row (mean: averaged over the n); gain, offs of the three current sensors (offs in parts of the rated current); ang_off rad; ang_tau angle late
by, s; ang_load rad per A of i_q; turn periods by which the command is turned ahead (1.5); udc_scale the bus as measured over the bus; sag of
the bus at rated current, unseen by the drive; rs_drift part of R_s at the end; h 5th and 7th harmonic in parts of the EMF; sat saturation of d, q,
and cross, in parts of L at rated current; drop device drop, V; jitter of the time stamps in parts of a period; rotor_held true: the voltage
stands still in the rotor's frame over a period, no switching.
"""
import argparse, gzip, json, math, os, zlib
from dataclasses import dataclass, field, asdict, replace

import numpy as np
from numba import njit

LINEAR_ROWS = 3200  # rows of a log; 8000 of the logs with every 4th row
THETA_START = 0.3


@dataclass
class Motor:
    """A motor and its inverter. SI units, phase peak values."""
    name: str
    rs: float
    ld: float
    lq: float
    psi_f: float
    pole_pairs: int
    u_dc: float
    f_pwm: float
    rated: float        # A
    td: float           # usual dead time, s
    drop: float         # device drop in the situations with drops, V
    omega_top: float = 0.0   # electrical speed of the courses, rad/s; 0: from the voltage
    weakening: float = 0.0   # top speed of the course `fw` over omega_top; 0: from the voltage

    def voltage(self, omega, i_d, i_q):
        return math.hypot(self.rs * i_d - omega * self.lq * i_q,
                          self.rs * i_q + omega * (self.psi_f + self.ld * i_d))

    def with_speeds(self):
        """Speeds at which every operating point needs less than 0.75 (field weakening: 0.85) of u_dc / sqrt 3, dead time included."""
        limit = self.u_dc / math.sqrt(3)
        lost = 4 / math.pi * self.td * self.f_pwm * self.u_dc
        points = [(0, .8), (0, .7), (-.35, .7), (-.3, .7), (-.27, .9), (-.4, .8), (0, -.7), (0, .5)]
        omega = self.omega_top
        if not omega:
            omega = 0.25 * self.f_pwm
            while max(self.voltage(omega, a * self.rated, b * self.rated) for a, b in points) + lost > 0.75 * limit:
                omega *= 0.99
            omega = float(f"{omega:.2g}")
        weak = self.weakening
        if not weak:
            weak = 1.75
            weak_points = [(1, 0, .3), (None, -.75, .3), (None, -.78, .5), (None, -.84, .5), (None, -.85, .25), (None, -.9, .25)]
            while weak > 1.05 and max(self.voltage(omega * weak, a * self.rated, b * self.rated)
                                      for s, a, b in weak_points if s is None) + lost > 0.85 * limit:
                weak -= 0.05
        return replace(self, omega_top=omega, weakening=round(weak, 2))


MOTORS = [
    Motor("servo", 1.2, 6.5e-3, 8e-3, 0.12, 4, 320.0, 10e3, 8.0, 2e-6, 1.5),
    Motor("traction", 9e-3, 110e-6, 300e-6, 0.055, 5, 350.0, 10e3, 300.0, 2.5e-6, 2.0),
    Motor("drone", 60e-3, 18e-6, 18e-6, 1.6e-3, 7, 24.0, 24e3, 25.0, 0.5e-6, 0.35),
    Motor("appliance", 6.0, 35e-3, 60e-3, 0.35, 3, 310.0, 8e3, 2.5, 1.5e-6, 1.5),
    Motor("robot", 0.25, 0.28e-3, 0.32e-3, 9e-3, 14, 48.0, 20e3, 12.0, 0.4e-6, 0.5),
]


# ---------------------------------------------------------------- courses

def course(sched, motor, x):
    """i_d, i_q references in A and the electrical speed at the parts x of the duration (0..1)."""
    rated, top = motor.rated, motor.omega_top
    low = 400 / 1500 * top

    def steps(*pairs):
        """(start, value) ...: piecewise constant."""
        y = np.zeros_like(x)
        for start, value in pairs:
            y[x >= start - 1e-12] = value
        return y * rated

    def ramp(*points):
        return np.interp(x, [p[0] for p in points], [p[1] for p in points])

    if sched == "default":
        i_q = steps((.05, .3), (.25, .8), (.38, .3), (.7, .7), (.8, .4), (.9, -.5))
        i_d = steps((.32, -.4), (.44, 0), (.62, -.35), (.75, 0))
        omega = ramp((0, 0), (.05, 0), (.12, low), (.5, low), (.6, top), (1, top))
    elif sched == "twopoint":
        i_q, i_d, omega = steps((0, .5)), steps((.5, -.4)), ramp((0, .6 * top))
    elif sched == "accel":
        i_q = steps((0, .7), (.55, -.6))
        i_d = steps(*[(.1 * n, -.3 if n % 2 else 0) for n in range(10)])
        omega = ramp((0, .08 * top), (.1, .08 * top), (.5, top), (.6, top), (1, .08 * top))
    elif sched == "slow4":
        i_q, i_d = steps((0, .3), (.5, .7)), steps((.25, -.4), (.75, 0))
        omega = ramp((0, 2 / 15 * top))
    elif sched == "id0":
        i_q, i_d = steps((0, .3), (.2, .8), (.7, .4)), steps()
        omega = ramp((0, low), (.4, low), (.5, top), (1, top))
    elif sched == "mtpa":
        i_q = steps((0, .3), (.2, .8), (.4, .5), (.7, .9))
        i_d = -.3 * i_q
        omega = ramp((0, low), (.1, low), (.5, top), (1, top))
    elif sched == "regen":
        i_q, i_d = steps((0, -.3), (.3, -.7), (.6, -.5)), steps((.15, -.35), (.45, 0))
        omega = ramp((0, .8 * top))
    elif sched == "fw":
        i_q = steps((0, .3), (.6, .5), (.8, .25))
        i_d = ramp((0, 0), (.2, 0), (.5, -.75), (1, -.9)) * rated
        omega = ramp((0, top), (.2, top), (.5, motor.weakening * top), (1, motor.weakening * top))
    else:
        raise ValueError(f"no course {sched}")
    return i_d, i_q, omega


# ---------------------------------------------------------------- the plant and the drive

@njit(cache=True)
def flux_of_currents(i_d, i_q, mp):
    """psi_d (without the magnets), psi_q and their derivatives. mp = ld, lq, sat d, sat q, sat cross, rated."""
    ld, lq, s_d, s_q, s_x, rated = mp[0], mp[1], mp[2], mp[3], mp[4], mp[5]
    c = 0.05 * rated
    r_d, r_q = math.sqrt(i_d * i_d + c * c), math.sqrt(i_q * i_q + c * c)
    l_x = s_x * math.sqrt(ld * lq) / (rated * rated)
    psi_d = ld * i_d * (1 - s_d * (r_d - c) / rated) - l_x * i_d * i_q * i_q
    psi_q = lq * i_q * (1 - s_q * (r_q - c) / rated) - l_x * i_q * i_d * i_d
    l_dd = ld * (1 - s_d * (r_d - c + i_d * i_d / r_d) / rated) - l_x * i_q * i_q
    l_qq = lq * (1 - s_q * (r_q - c + i_q * i_q / r_q) / rated) - l_x * i_d * i_d
    l_dq = -2 * l_x * i_d * i_q
    return psi_d, psi_q, l_dd, l_qq, l_dq


@njit(cache=True)
def currents(psi_a, psi_b, theta, psi_f, h5, h7, mp, linear, guess_d, guess_q):
    """Stator-frame currents and i_d, i_q of the stator-frame flux at an angle of the rotor."""
    c, s = math.cos(theta), math.sin(theta)
    psi_d, psi_q = c * psi_a + s * psi_b - psi_f, c * psi_b - s * psi_a
    if h5 != 0.0 or h7 != 0.0:
        # magnets in the stator frame: psi_f (e^{j th} + h5/5 e^{-5 j th} + h7/7 e^{7 j th}); here in the rotor's frame
        c6, s6 = math.cos(6 * theta), math.sin(6 * theta)
        psi_d -= psi_f * (h5 / 5 + h7 / 7) * c6
        psi_q -= psi_f * (h7 / 7 - h5 / 5) * s6
    if linear:
        i_d, i_q = psi_d / mp[0], psi_q / mp[1]
    else:
        i_d, i_q = guess_d, guess_q
        for _ in range(20):
            f_d, f_q, l_dd, l_qq, l_dq = flux_of_currents(i_d, i_q, mp)
            e_d, e_q = psi_d - f_d, psi_q - f_q
            det = l_dd * l_qq - l_dq * l_dq
            step_d, step_q = (l_qq * e_d - l_dq * e_q) / det, (l_dd * e_q - l_dq * e_d) / det
            i_d, i_q = i_d + step_d, i_q + step_q
            if abs(step_d) + abs(step_q) < 1e-10 * mp[5]:
                break
    return c * i_d - s * i_q, s * i_d + c * i_q, i_d, i_q


@njit(cache=True)
def clip1(x):
    return 1.0 if x > 1.0 else (-1.0 if x < -1.0 else x)


@njit(cache=True)
def leg_voltage(gate, i, u_dc, drop, i_dead, i_knee):
    """Gate 0: lower switch on, 1: upper on, 2: both off (dead time). i flows out of the leg into the motor."""
    if gate == 2:
        v = u_dc * (0.5 - 0.5 * clip1(i / i_dead))
    else:
        v = u_dc * gate
    if drop != 0.0:
        v -= drop * clip1(i / i_knee)
    return v


@njit(cache=True)
def simulate(n, period, id_ref, iq_ref, omega, theta0, rs0, rs_drift, psi_f, h5, h7, mp, linear, u_dc, udc_scale, sag, td, drop,
             noise, adc_step, gain, offs, ang_off, ang_tau, ang_load, turn, rotor_held, alpha):
    """Rows of the drive, one a period: id, iq, ud, uq, omega_e, u_dc, theta_e (unwrapped), and the true i_d, i_q."""
    out = np.zeros((n, 9))
    ld, lq, rated = mp[0], mp[1], mp[5]
    kp_d, kp_q, ki = alpha * ld, alpha * lq, alpha * rs0
    u_max = 0.95 * u_dc / math.sqrt(3.0)
    believed = u_dc * udc_scale
    theta = theta0
    psi_a, psi_b = psi_f * math.cos(theta), psi_f * math.sin(theta)
    if h5 != 0.0 or h7 != 0.0:
        psi_a = psi_f * (math.cos(theta) + h5 / 5 * math.cos(5 * theta) + h7 / 7 * math.cos(7 * theta))
        psi_b = psi_f * (math.sin(theta) - h5 / 5 * math.sin(5 * theta) + h7 / 7 * math.sin(7 * theta))
    g_d = g_q = 0.0
    int_d = int_q = 0.0
    duty = np.full(3, 0.5)        # of the period under way
    next_duty = np.full(3, 0.5)
    held_d = held_q = next_d = next_q = 0.0
    h_max = period / 32
    h_dead = td / 3 if td > 0 else h_max
    i_dead = u_dc * h_dead / (3 * min(ld, lq)) + 1e-6 * rated
    i_knee = 0.005 * rated
    points = np.zeros(14)
    gate = np.zeros(3, np.int64)
    phase = np.zeros(3)
    for k in range(n):
        # ---- sample
        i_a, i_b, g_d, g_q = currents(psi_a, psi_b, theta, psi_f, h5, h7, mp, linear, g_d, g_q)
        phase[0], phase[1], phase[2] = i_a, -0.5 * i_a + 0.8660254037844386 * i_b, -0.5 * i_a - 0.8660254037844386 * i_b
        for x in range(3):
            y = gain[x] * phase[x] + offs[x] * rated + noise[k, x]
            if adc_step > 0.0:
                y = adc_step * math.floor(y / adc_step + 0.5)
                y = min(max(y, -2048 * adc_step), 2047 * adc_step)
            phase[x] = y
        m_a = (2 * phase[0] - phase[1] - phase[2]) / 3
        m_b = (phase[1] - phase[2]) * 0.5773502691896258
        w = omega[k]
        believed_theta = theta + ang_off - ang_tau * w + ang_load * g_q
        c, s = math.cos(believed_theta), math.sin(believed_theta)
        m_d, m_q = c * m_a + s * m_b, c * m_b - s * m_a
        # ---- control
        e_d, e_q = id_ref[k] - m_d, iq_ref[k] - m_q
        u_d = kp_d * e_d + int_d - w * lq * m_q
        u_q = kp_q * e_q + int_q + w * (ld * m_d + psi_f)
        size = math.hypot(u_d, u_q)
        scale = u_max / size if size > u_max else 1.0
        int_d += ki * period * (e_d + (scale - 1) * u_d / kp_d)
        int_q += ki * period * (e_q + (scale - 1) * u_q / kp_q)
        u_d, u_q = scale * u_d, scale * u_q
        out[k, 0], out[k, 1], out[k, 2], out[k, 3] = m_d, m_q, u_d, u_q
        out[k, 4], out[k, 5], out[k, 6], out[k, 7], out[k, 8] = w, believed, believed_theta, g_d, g_q
        # ---- command for the next period
        ahead = believed_theta + turn * period * w
        c, s = math.cos(ahead), math.sin(ahead)
        v_a, v_b = c * u_d - s * u_q, s * u_d + c * u_q
        v0, v1, v2 = v_a, -0.5 * v_a + 0.8660254037844386 * v_b, -0.5 * v_a - 0.8660254037844386 * v_b
        common = -0.5 * (max(v0, v1, v2) + min(v0, v1, v2))
        for x in range(3):
            v = v0 if x == 0 else (v1 if x == 1 else v2)
            next_duty[x] = min(max(0.5 + (v + common) / believed, 0.0), 1.0)
        # in a rotor-held drive the error of the angle still turns the voltage
        err = believed_theta - theta
        next_d, next_q = math.cos(err) * u_d - math.sin(err) * u_q, math.sin(err) * u_d + math.cos(err) * u_q
        if udc_scale != 1.0:
            next_d, next_q = next_d / udc_scale, next_q / udc_scale
        # ---- the period under way
        rs = rs0 * (1 + rs_drift * k / n)
        bus = u_dc * (1 - sag * math.hypot(g_d, g_q) / rated)
        slope = (omega[k + 1] - w) / period
        points[0], points[1] = 0.0, period
        for x in range(3):
            rise, fall = 0.5 * period * (1 - duty[x]), 0.5 * period * (1 + duty[x])
            points[2 + 4 * x], points[3 + 4 * x] = rise, min(rise + td, period)
            points[4 + 4 * x], points[5 + 4 * x] = fall, min(fall + td, period)
        order = np.sort(points)
        if rotor_held:
            order[:] = period
            order[0] = 0.0
        for p in range(13):
            a, b = order[p], order[p + 1]
            if b - a < 1e-13:
                continue
            mid = 0.5 * (a + b)
            dead = False
            for x in range(3):
                rise, fall = 0.5 * period * (1 - duty[x]), 0.5 * period * (1 + duty[x])
                if mid < rise or mid > fall + td:
                    gate[x] = 0
                elif mid > rise + td and mid < fall:
                    gate[x] = 1
                else:
                    gate[x] = 2
                    dead = True
            steps = int(math.ceil((b - a) / (h_dead if dead else h_max)))
            h = (b - a) / steps
            for j in range(steps):
                t0 = a + j * h
                k1a = k1b = k2a = k2b = k3a = k3b = k4a = k4b = 0.0
                for stage in range(4):
                    if stage == 0:
                        t, x_a, x_b = t0, psi_a, psi_b
                    elif stage == 1:
                        t, x_a, x_b = t0 + 0.5 * h, psi_a + 0.5 * h * k1a, psi_b + 0.5 * h * k1b
                    elif stage == 2:
                        t, x_a, x_b = t0 + 0.5 * h, psi_a + 0.5 * h * k2a, psi_b + 0.5 * h * k2b
                    else:
                        t, x_a, x_b = t0 + h, psi_a + h * k3a, psi_b + h * k3b
                    th = theta + w * t + 0.5 * slope * t * t
                    i_a, i_b, g_d, g_q = currents(x_a, x_b, th, psi_f, h5, h7, mp, linear, g_d, g_q)
                    ph0, ph1, ph2 = i_a, -0.5 * i_a + 0.8660254037844386 * i_b, -0.5 * i_a - 0.8660254037844386 * i_b
                    if rotor_held:
                        # no switching: the command as it is; dead time and drops as their mean, by the sign of the phase currents
                        loss = td / period * bus + drop
                        l0, l1, l2 = -loss * clip1(ph0 / i_knee), -loss * clip1(ph1 / i_knee), -loss * clip1(ph2 / i_knee)
                        c, s = math.cos(th), math.sin(th)
                        v_a = c * held_d - s * held_q + (2 * l0 - l1 - l2) / 3
                        v_b = s * held_d + c * held_q + (l1 - l2) * 0.5773502691896258
                    else:
                        l0 = leg_voltage(gate[0], ph0, bus, drop, i_dead, i_knee)
                        l1 = leg_voltage(gate[1], ph1, bus, drop, i_dead, i_knee)
                        l2 = leg_voltage(gate[2], ph2, bus, drop, i_dead, i_knee)
                        v_a, v_b = (2 * l0 - l1 - l2) / 3, (l1 - l2) * 0.5773502691896258
                    f_a, f_b = v_a - rs * i_a, v_b - rs * i_b
                    if stage == 0:
                        k1a, k1b = f_a, f_b
                    elif stage == 1:
                        k2a, k2b = f_a, f_b
                    elif stage == 2:
                        k3a, k3b = f_a, f_b
                    else:
                        k4a, k4b = f_a, f_b
                psi_a += h / 6 * (k1a + 2 * k2a + 2 * k3a + k4a)
                psi_b += h / 6 * (k1b + 2 * k2b + 2 * k3b + k4b)
        theta += w * period + 0.5 * slope * period * period
        for x in range(3):
            duty[x] = next_duty[x]
        held_d, held_q = next_d, next_q
    return out


def first_order(x, cutoff, period):
    """First-order low-pass, starting at the first value."""
    a = 1 - math.exp(-2 * math.pi * cutoff * period)
    y = np.empty_like(x)
    y[0] = x[0]
    for k in range(1, len(x)):
        y[k] = y[k - 1] + a * (x[k] - y[k - 1])
    return y


def run(motor, drive, seed, rows=LINEAR_ROWS):
    """Columns of a log, as a dict of arrays, and the true i_d, i_q of the same rows."""
    period = 1 / motor.f_pwm
    dec = drive.get("dec", 1)
    n = rows * dec
    i_d, i_q, omega = course(drive.get("sched", "default"), motor, np.arange(n) / n)
    smooth = np.ones(16) / 16  # rounded corners of the speed
    omega = np.convolve(np.concatenate([np.full(8, omega[0]), omega, np.full(8, omega[-1])]), smooth, "valid")[:n + 1]
    rng = np.random.default_rng(seed)
    noise = rng.normal(size=(n, 3)) * drive.get("noise", 0.005) * motor.rated
    adc_step = 3.0 * motor.rated / 4096 if drive.get("adc", True) else 0.0
    sat = drive.get("sat", [0.0, 0.0, 0.0])
    h5, h7 = drive.get("h", [0.0, 0.0])
    mp = np.array([motor.ld, motor.lq, sat[0], sat[1], sat[2], motor.rated])
    out = simulate(n, period, i_d, i_q, omega, THETA_START, motor.rs, drive.get("rs_drift", 0.0), motor.psi_f, h5, h7, mp, not any(sat),
                   motor.u_dc, drive.get("udc_scale", 1.0), drive.get("sag", 0.0), drive.get("td", motor.td), drive.get("drop", 0.0), noise,
                   adc_step, np.array(drive.get("gain", [1.0] * 3)), np.array(drive.get("offs", [0.0] * 3)), drive.get("ang_off", 0.0),
                   drive.get("ang_tau", 0.0), drive.get("ang_load", 0.0), drive.get("turn", 1.5), drive.get("rotor_held", False),
                   2 * math.pi * motor.f_pwm / 23)
    log = dict(t=np.arange(n) * period, id=out[:, 0], iq=out[:, 1], ud=out[:, 2], uq=out[:, 3], omega_e=out[:, 4], u_dc=out[:, 5],
               theta_e=out[:, 6])
    for key, names in (("lpi", ("id", "iq")), ("lpu", ("ud", "uq")), ("lpw", ("omega_e",))):
        if key in drive:
            for name in names:
                log[name] = first_order(log[name], drive[key], period)
    true_d, true_q = out[:, 7], out[:, 8]
    if dec > 1:
        reduce = (lambda x: x.reshape(-1, dec).mean(1)) if drive.get("mean") else (lambda x: x[::dec])
        log = {name: reduce(x) for name, x in log.items()}
        true_d, true_q = reduce(true_d), reduce(true_q)
    log["theta_e"] = np.mod(log["theta_e"], 2 * math.pi)
    if "jitter" in drive:
        log["t"] = log["t"] + rng.uniform(-1, 1, len(log["t"])) * drive["jitter"] * period
        log["t"] -= min(log["t"][0], 0)
    if drive.get("udc_col") is False:
        del log["u_dc"]
    if drive.get("theta") is False:
        del log["theta_e"]
    return log, true_d, true_q


def write(out, name, log, about):
    with gzip.open(os.path.join(out, name + ".csv.gz"), "wt", compresslevel=6, newline="\n") as f:
        f.write(",".join(log) + "\n")
        for row in zip(*log.values()):
            f.write(",".join(f"{x:.8g}" for x in row) + "\n")
    with open(os.path.join(out, name + ".json"), "w") as f:
        json.dump(about, f)


# ---------------------------------------------------------------- the 37 situations

def situations(motor):
    """name, drive, further fields. Times and frequencies in the motor's own scale; parts of the rated current as for the e-bike."""
    period = 1 / motor.f_pwm
    long = 10 * LINEAR_ROWS * period
    nt = dict(theta=False, udc_col=False)
    filt = motor.f_pwm / 16
    lag = 4 / (LINEAR_ROWS * period)
    gains = dict(gain=[1.02, .99, 1.0], offs=[.01, -.006, .004])
    unseen, zero = dict(unseen=True), dict(truth_is="at zero current")
    return [
        ("00_ideal", dict(td=0.0, noise=0.0, adc=False), {}),
        ("01_dead", {}, {}),
        ("02_dead_nt", nt, {}),
        ("03_twopoint", dict(sched="twopoint"), {}),
        ("03_twopoint_nt", dict(sched="twopoint", **nt), {}),
        ("04_filter", dict(lpi=filt), {}),
        ("04_filter_both", dict(lpi=filt, lpu=filt), {}),
        ("04_filter_nodead", dict(lpi=filt, td=0.0), {}),
        ("04_filter_nt", dict(lpi=filt, **nt), {}),
        ("05_dec10_mean", dict(dec=10, mean=True, D=long), {}),
        ("05_dec10_slow", dict(dec=10, D=long, sched="slow4"), {}),
        ("05_dec10_slow_nodead", dict(dec=10, D=long, sched="slow4", td=0.0), {}),
        ("05_dec4_accel", dict(dec=4, D=long, sched="accel"), {}),
        ("06_common_gain", dict(gain=[1.03] * 3), unseen),
        ("06_offsets_gains", gains, {}),
        ("06_offsets_gains_nt", dict(theta=False, **gains), {}),
        ("07_angle_delay", dict(ang_tau=.64 * period), {}),
        ("07_angle_load", dict(ang_load=.08 / motor.rated, td=0.0), unseen),
        ("08_bus_3", dict(udc_scale=1.03), unseen),
        ("08_bus_sags", dict(sag=.05, td=0.0), unseen),
        ("09_rs_warms", dict(rs_drift=.2), dict(rs_at_end=1.2 * motor.rs, truth_is="R_s at the start")),
        ("10_harmonics", dict(h=[.03, .02]), {}),
        ("10_harmonics_nt", dict(h=[.04, .025], td=0.0, theta=False), {}),
        ("11_saturates", dict(sat=[.06, .2, .13]), zero),
        ("11_saturates_mtpa", dict(sat=[.05, .2, .15], td=0.0, sched="mtpa"), zero),
        ("12_speed_lags", dict(lpw=lag, sched="accel"), {}),
        ("12_speed_lags_nt", dict(lpw=lag, sched="accel", theta=False), {}),
        ("13_jitter", dict(jitter=.1), {}),
        ("14_id0", dict(sched="id0"), {}),
        ("14_mtpa", dict(sched="mtpa"), {}),
        ("15_regen", dict(sched="regen"), {}),
        ("16_weakening", dict(sched="fw"), {}),
        ("17_angle_offset", dict(ang_off=.06), {}),
        ("18_drops", dict(drop=motor.drop), {}),
        ("18_drops_nt", dict(drop=motor.drop, theta=False), {}),
        ("19_all", dict(gain=[1.01, 1.0, .995], offs=[.004, -.003, .002], h=[.02, .01], ang_tau=.64 / 3 * period, rs_drift=.1,
                        sat=[.03, .1, .05]), zero),
        ("20_one_point_prior", dict(td=0.0, sched="twopoint"), {}),
    ]


def truth_of(motor):
    return {"Rs": motor.rs, "Ld": motor.ld, "Lq": motor.lq, "psi_f": motor.psi_f}


def make_all(out, only):
    for motor in MOTORS:
        motor = motor.with_speeds()
        print(motor, flush=True)
        for name, drive, more in situations(motor):
            name = f"{motor.name}_{name}"
            if only and only not in name:
                continue
            log, _, _ = run(motor, drive, zlib.crc32(name.encode()), 8000 if drive.get("dec") == 4 else LINEAR_ROWS)
            if name.endswith("one_point_prior"):
                log = {key: x[400:1595] for key, x in log.items()}
            write(out, name, log, {"truth": truth_of(motor), **more, "drive": drive, "motor": asdict(motor)})


# ---------------------------------------------------------------- random logs

def draw_motor(rng, name):
    """A motor around one of the classes of MOTORS or the e-bike, whose ripple and resistive voltage are those of a sensible drive."""
    ebike = Motor("ebike", .045, 90e-6, 120e-6, .011, 4, 48.0, 16e3, 50.0, .8e-6, .7)
    base = (MOTORS + [ebike])[rng.integers(len(MOTORS) + 1)]
    around = lambda x, factor: float(f"{x * factor ** rng.uniform(-1, 1):.4g}")
    while True:
        ld = around(base.ld, 2)
        lq = ld if rng.random() < .25 else float(f"{ld * 2.5 ** rng.uniform(0, 1):.4g}")
        f_pwm = float(round(around(base.f_pwm, 1.4), -2))
        m = replace(base, name=name, rs=around(base.rs, 2), ld=ld, lq=lq, psi_f=around(base.psi_f, 1.4), f_pwm=f_pwm,
                    td=float(f"{math.exp(rng.uniform(math.log(.004), math.log(.025))) / f_pwm:.2g}"))
        limit = m.u_dc / math.sqrt(3)
        ripple = m.u_dc / (8 * m.ld * m.f_pwm)
        if m.rs * m.rated < .2 * limit and ripple < .25 * m.rated and m.lq * m.rated < 1.8 * m.psi_f:
            return base.name, m.with_speeds()


def gains_without_common(errors):
    """Gains of three sensors whose mean is one: no log shows a gain that all have in common."""
    a, b, _ = (float(f"{1 + e:.4g}") for e in errors - errors.mean())
    return [a, b, round(3 - a - b, 6)]


def draw_drive(rng, motor):
    """Kind of log, drive and faults."""
    period = 1 / motor.f_pwm
    u = rng.uniform
    part = lambda x: float(f"{x:.3g}")
    kind = str(rng.choice(["every row", "every n-th row", "means", "rotor held"], p=[.49, .17, .17, .17]))
    drive = dict(td=0.0, sched=str(rng.choice(["default", "twopoint", "accel", "slow4", "id0", "mtpa", "regen", "fw"],
                                              p=[.4, .08, .12, .06, .08, .1, .08, .08])))
    if kind in ("every n-th row", "means"):
        drive["dec"] = int(rng.choice([2, 4, 10]))
        drive["D"] = LINEAR_ROWS * drive["dec"] * period
    if kind == "means":
        drive["mean"] = True
    if kind == "rotor held":
        drive["rotor_held"] = True
    faults = {
        "command not turned ahead": lambda: dict(turn=0.0),
        "angle delay": lambda: dict(ang_tau=part(u(.2, 1.2) * period)),
        "angle offset": lambda: dict(ang_off=part(u(.02, .1) * rng.choice([-1, 1]))),
        "offsets and gains": lambda: dict(gain=gains_without_common(u(-.02, .02, 3)), offs=[part(u(-.01, .01)) for _ in range(3)]),
        "filter on currents": lambda: dict(lpi=part(motor.f_pwm / math.exp(u(math.log(8), math.log(40))))),
        "filter on voltages": lambda: dict(lpu=part(motor.f_pwm / math.exp(u(math.log(8), math.log(40))))),
        "filter on currents and voltages": lambda: (lambda f: dict(lpi=f, lpu=f))(part(motor.f_pwm / math.exp(u(math.log(8), math.log(40))))),
        "speed lags": lambda: dict(lpw=part(math.exp(u(math.log(3), math.log(30))) / (LINEAR_ROWS * drive.get("dec", 1) * period))),
        "dead time": lambda: dict(td=motor.td),
        "dead time, no angle": lambda: dict(td=motor.td, theta=False),
        "device drop": lambda: dict(drop=part(u(.3, 1) * motor.drop)),
        "harmonics": lambda: dict(h=[part(u(.005, .04)), part(u(.003, .025))]),
        "R_s drifts": lambda: dict(rs_drift=part(u(.05, .25))),
    }
    names = list(faults)
    count = int(rng.choice([0, 1, 2, 3], p=[.15, .35, .3, .2]))
    chosen = [names[k] for k in rng.choice(len(names), count, replace=False)]
    for one in ("dead time, no angle", "filter on currents and voltages"):  # not with their parts
        if one in chosen:
            chosen = [c for c in chosen if c == one or c not in ("dead time", "filter on currents", "filter on voltages")]
    for c in chosen:
        drive.update(faults[c]())
    return kind, drive, chosen


def make_random(out, count, seed):
    for n in range(count):
        for attempt in range(20):
            rng = np.random.default_rng([seed, n, attempt])
            name = f"random{seed}_{n:03d}"
            family, motor = draw_motor(rng, name)
            kind, drive, faults = draw_drive(rng, motor)
            log, true_d, true_q = run(motor, drive, rng)
            rows = np.arange(len(true_d)) / len(true_d)
            ref_d, ref_q, _ = course(drive["sched"], motor, rows)
            astray = float(np.sqrt(np.mean((true_d - ref_d) ** 2 + (true_q - ref_q) ** 2)) / motor.rated)
            if astray < .25 and np.all(np.isfinite(log["iq"])):   # the control is stable
                break
        more = dict(truth_is="R_s at the start", rs_at_end=motor.rs * (1 + drive["rs_drift"])) if "rs_drift" in drive else {}
        write(out, name, log, {"truth": truth_of(motor), **more, "faults": faults, "kind": kind, "family": family, "drive": drive,
                               "tracking": round(astray, 4), "motor": asdict(motor)})
        print(name, family, kind, drive["sched"], faults, f"tracking {astray:.3f}", flush=True)


# ---------------------------------------------------------------- checks

def check_log(log, truth, label, tolerance=0.02):
    """Least squares with the voltage of row k acting over [k+1, k+2] as a standing vector in the frame 1.5 periods after row k, and least
    squares of the means of steady windows. Errors in %."""
    t, i, u = log["t"], log["id"] + 1j * log["iq"], log["ud"] + 1j * log["uq"]
    w, th = log["omega_e"], log["theta_e"]
    period = t[1] - t[0]
    true = np.array([truth[key] for key in ("Rs", "Ld", "Lq", "psi_f")])
    k = np.arange(5, len(t) - 3)
    stator_u = u[k - 1] * np.exp(1j * (th[k - 1] + 1.5 * period * w[k - 1]))
    e0, e1 = np.exp(1j * th[k]), np.exp(1j * th[k + 1])
    a = np.column_stack([(i[k] * e0 + i[k + 1] * e1) / 2 * period, i[k + 1].real * e1 - i[k].real * e0,
                         1j * (i[k + 1].imag * e1 - i[k].imag * e0), e1 - e0])
    x = np.linalg.lstsq(np.vstack([a.real, a.imag]), np.concatenate([stator_u.real, stator_u.imag]) * period, rcond=None)[0]
    rows, rhs = [], []
    size = 64
    for s in range(size, len(t) - size, size):
        b = slice(s, s + size)
        if np.ptp(w[b]) == 0 and w[s] > 0 and np.ptp(log["id"][b]) + np.ptp(log["iq"][b]) < tolerance * np.abs(i).max():
            d, q, om = log["id"][b].mean(), log["iq"][b].mean(), w[s]
            rows += [[d, 0, -om * q, 0], [q, om * d, 0, om]]
            rhs += [log["ud"][b].mean(), log["uq"][b].mean()]
    y = np.linalg.lstsq(np.array(rows), np.array(rhs), rcond=None)[0]
    fmt = lambda z: " ".join(f"{e:+.3f}" for e in (z / true - 1) * 100)
    print(f"{label:24s} dynamic {fmt(x)}   steady windows ({len(rhs) // 2}) {fmt(y)}   (Rs Ld Lq psi_f, %)", flush=True)


def read_reference(path):
    with gzip.open(path, "rt") as f:
        names = f.readline().strip().split(",")
        data = np.loadtxt(f, delimiter=",")
    return dict(zip(names, data.T))


def check(other):
    if other:
        with open(other.removesuffix(".csv.gz") + ".json") as f:
            check_log(read_reference(other), json.load(f)["truth"], os.path.basename(other))
    ebike = Motor("ebike", .045, 90e-6, 120e-6, .011, 4, 48.0, 16e3, 50.0, .8e-6, .7, 1500.0, 1.75)
    for motor in [ebike] + [m.with_speeds() for m in MOTORS]:
        for label, drive in (("ideal", dict(td=0.0, noise=0.0, adc=False)), ("rotor held", dict(td=0.0, noise=0.0, adc=False, rotor_held=True)),
                             ("noise, adc", dict(td=0.0))):
            log, true_d, true_q = run(motor, drive, 1)
            check_log(log, truth_of(motor), f"{motor.name} {label}", 0.12 if "noise" in label else 0.02)


if __name__ == "__main__":
    args = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    args.add_argument("--out", default="logs", help="folder of the logs")
    args.add_argument("--only", default="", help="only names that contain this")
    args.add_argument("--random", type=int, default=0)
    args.add_argument("--seed", type=int, default=1)
    args.add_argument("--check", nargs="?", const="", metavar="LOG.csv.gz")
    args = args.parse_args()
    if args.check is not None:
        check(args.check)
    else:
        os.makedirs(args.out, exist_ok=True)
        if args.random:
            make_random(args.out, args.random, args.seed)
        else:
            make_all(args.out, args.only)
