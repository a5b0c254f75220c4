"""The other verbs and the console script."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import fluxfit

from conftest import LOGS


def test_a_log_is_read_in_si(rig: Path, columns: dict[str, np.ndarray]) -> None:
    log = fluxfit.read_log(rig)
    assert log.rows == 9000 and set(log) >= {"t", "ud", "uq", "id", "iq", "omega_e"}
    for name in log:
        assert (log[name] == columns[name]).all(), name
    assert "9000 rows" in repr(log)


def test_inspection(rig: Path) -> None:
    document = fluxfit.inspect(rig)
    assert document["schema"].startswith("fluxfit.inspection/")


def test_validation_of_an_identification(rig: Path) -> None:
    found = fluxfit.identify(LOGS / "paper_rig_ideal.csv")
    truth = {"rs": 0.958, "ld": 5.25e-3, "lq": 12e-3, "psi_f": 0.1827}
    for motor in (found, found.to_dict(), truth):
        assert fluxfit.validate(rig, motor).outcome == "agrees"
    assert fluxfit.validate(rig, truth | {"lq": 14e-3}).outcome != "agrees"


def test_a_comparison(rig: Path) -> None:
    study = fluxfit.compare(rig, methods=["tgfpa", "fpa"], runs=3, iterations=20)
    assert [entry["method"] for entry in study.methods] == ["tgfpa", "fpa"]
    assert "tgfpa" in repr(study)


def test_a_simulation_is_that_of_the_command(tmp_path: Path) -> None:
    scenario = tmp_path / "rig.toml"
    template = subprocess.run([sys.executable, "-m", "fluxfit", "simulate", "--template"], capture_output=True, text=True, check=True)
    scenario.write_text(template.stdout)
    subprocess.run([sys.executable, "-m", "fluxfit", "-q", "simulate", str(scenario), "-o", str(tmp_path / "rig.csv")], check=True)
    written, simulated = fluxfit.read_log(tmp_path / "rig.csv"), fluxfit.simulate(scenario)
    for name in written:
        assert np.allclose(written[name], simulated[name], rtol=1e-6, atol=1e-9), name
    assert simulated.truth == json.loads((tmp_path / "rig.truth.json").read_text())
    assert (fluxfit.simulate(template.stdout)["iq"] == simulated["iq"]).all()
    with pytest.raises(fluxfit.DataError, match="key"):
        fluxfit.simulate({"duration": 1, "motors": {}})


def test_a_scenario_as_dictionary() -> None:
    scenario = {
        "duration": "0.3 s",
        "motor": {"rs": 1, "ld": "10 mH", "lq": 0.02, "psi_f": 0.2, "pole_pairs": 3},
        "mechanics": {"kind": "dyno"},
        "inverter": {"u_dc": 300, "carrier": 5e3},
        "control": {"current_bandwidth": 100, "max_current": 10},
        "schedule": {"speed": "600 rpm", "iq": 3, "id": [{"at": 0.15, "to": -1}]},
    }
    log = fluxfit.simulate(scenario)
    assert log.truth is not None and log.truth["pole_pairs"] == 3
    assert abs(log["iq"][-1] - 3) < 0.5 and abs(log["id"][-1] + 1) < 0.5


def test_the_console_script(rig: Path) -> None:
    run = subprocess.run([sys.executable, "-m", "fluxfit", "--version"], capture_output=True, text=True, check=False)
    assert (run.returncode, run.stdout.strip()) == (0, f"fluxfit {fluxfit.__version__}")
    missing = subprocess.run([sys.executable, "-m", "fluxfit", "identify", "missing.csv"], capture_output=True, text=True, check=False)
    assert missing.returncode == 2 and "there is no such file" in missing.stderr
    open_one = subprocess.run(
        [sys.executable, "-m", "fluxfit", "identify", str(LOGS / "id_zero_two_loads.csv"), "--model", "steady", "-q"],
        capture_output=True,
        check=False,
    )
    assert open_one.returncode == 1
