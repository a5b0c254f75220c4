"""The corpus, continued: tables whose names only resemble those of a log. What is proposed for them has to be right, for it is pasted.

make.py calls write(make), with itself, as it does with tools.py.
"""

import numpy as np


def write(make):
    for part in (suffixes,):
        part(make)


def columns(make, *names):
    """The motor's columns, t, ud, uq, id, iq, omega_e, under other names."""
    return dict(zip(names, make.part(make.FAST).values()))


def refuse(make, file, says, log, *words, **more):
    make.put(file, make.table(log))
    make.refuse(file, says, *words, **more)


def suffixes(make):
    numbered = columns(make, "data.time", "data.vd1", "data.vq1", "data.id1", "data.iq1", "data.speed1")
    numbered |= {"data.id1_ref": np.full(len(numbered["data.time"]), -1.0), "data.iq1_ref": np.full(len(numbered["data.time"]), 2.0)}
    refuse(make, "names_numbered.csv", "a number behind every name, and references beside", numbered, "'data.vd1' may be ud", "'data.vq1' may be uq",
           "'data.id1' may be id", "'data.iq1' may be iq", "'data.speed1' may be omega_e", line=1)
