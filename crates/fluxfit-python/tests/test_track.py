"""track: a log, blocks or samples in; the lines of the command out."""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import fluxfit


def by_command(*words: str) -> "list[Any]":
    run = subprocess.run([sys.executable, "-m", "fluxfit", "-q", "track", *words, "--json"], capture_output=True, text=True, check=False)
    assert run.returncode in (0, 1), run.stderr
    return [json.loads(line) for line in run.stdout.splitlines()]


def test_the_items_are_the_lines_of_the_command(rig: Path, columns: "dict[str, Any]") -> None:
    assert list(fluxfit.track(rig)) == by_command(str(rig))
    words = ["--every", "50ms", "--method", "mras", "--start", "rs=1", "--voltage-timing", "1"]
    expected = by_command(str(rig), *words)
    assert list(fluxfit.track(columns, every=np.float64(0.05), method="mras", start={"rs": 1.0}, voltage_timing=1)) == expected


def test_samples_and_blocks_of_any_length_give_the_same(rig: Path) -> None:
    log = fluxfit.read_log(rig)
    expected = list(fluxfit.track(log))
    for length in (1, 777):
        blocks = ({name: log[name][row : row + length] for name in log} for row in range(0, log.rows, length))
        assert list(fluxfit.track(blocks)) == expected
    samples = ({name: float(log[name][row]) for name in log} for row in range(log.rows))
    assert list(fluxfit.track(samples)) == expected


def test_an_item_is_told_as_soon_as_it_is_due(rig: Path) -> None:
    log = fluxfit.read_log(rig)
    taken: list[int] = []

    def samples() -> Any:
        for row in range(log.rows):
            taken.append(row)
            yield {name: log[name][row] for name in log}

    found = fluxfit.track(samples(), every="0.2s")
    assert next(found)["rows"] == 1 and len(taken) == 1
    assert next(found)["t"] == pytest.approx(0.2, abs=1e-3) and len(taken) < 2100


def test_arrays_hold_the_true_values_of_a_simulated_drive() -> None:
    log = fluxfit.simulate()
    assert log.truth is not None
    now = fluxfit.track(log).to_arrays()
    for name in ("lq", "psi_f"):
        assert now[name].shape == now["t"].shape and now[name][-1] == pytest.approx(log.truth[name], rel=0.05)
        assert now[f"{name}_low"][-1] < now[name][-1] < now[f"{name}_high"][-1] and now[f"{name}_verdict"][-1] == "identified"
    assert np.isnan(now["ld_low"][0]) and now["steps"].tolist() == [item["steps"] for item in fluxfit.track(log)]


def test_a_saved_state_goes_on_to_the_same_bits(rig: Path, tmp_path: Path) -> None:
    log = fluxfit.read_log(rig)
    half = [{name: log[name][rows] for name in log} for rows in (slice(None, 5000), slice(5000, None))]
    first = fluxfit.track(iter(half[:1]))
    list(first)
    first.save_state(tmp_path / "state.json")
    *_, last = fluxfit.track(iter(half[1:]), resume=tmp_path / "state.json")
    *_, whole = fluxfit.track(log)
    assert last == whole


def test_an_alarm_is_that_of_the_command(rig: Path) -> None:
    # Of the true 0.958 ohm, 0.8 ohm plus 10 % is exceeded; psi_f stays.
    words = ["track", str(rig), "--voltage-timing", "centered", "--start", "rs=0.8,ld=5mH,lq=12mH,psi_f=0.18", "--json"]
    words += ["--alarm", "rs=+10%,psi_f=20%"]
    run = subprocess.run([sys.executable, "-m", "fluxfit", *words], capture_output=True, text=True, check=False)
    assert run.returncode == 3, run.stderr
    keywords: dict[str, Any] = {
        "voltage_timing": "centered",
        "start": {"rs": 0.8, "ld": "5mH", "lq": "12mH", "psi_f": 0.18},
        "alarm": {"rs": "+10%", "psi_f": "20%"},
    }
    found = fluxfit.track(rig, **keywords)
    assert found.alarms == []
    items = list(found)
    assert items == [json.loads(line) for line in run.stdout.splitlines()]
    (alarm,) = found.alarms
    assert (alarm.parameter, alarm.start) == ("rs", 0.8) and alarm.value == pytest.approx(0.958, rel=0.03)
    assert f"[alarm]: {alarm}" in " ".join(run.stderr.split()) and alarm.sentence.startswith("R_s is 0.9")
    assert next(item for item in items if item["t"] == alarm.t)["rs"]["value"] == alarm.value
    # Of samples, it is told with the item in which it is.
    log = fluxfit.read_log(rig)
    samples = fluxfit.track(({name: log[name][row] for name in log} for row in range(log.rows)), **keywords)
    assert next(item for item in samples if samples.alarms)["t"] == alarm.t
    with pytest.raises(fluxfit.RequestError, match="not a parameter"):
        fluxfit.track(log, alarm={"x": "1%"})


def test_refusals(rig: Path, columns: "dict[str, Any]") -> None:
    wrong: list[tuple[type[fluxfit.Error], Any, dict[str, Any], str]] = [
        (fluxfit.FileError, "missing.csv", {}, "there is no such file"),
        (fluxfit.RequestError, rig, {"method": "x"}, "no estimator 'x'"),
        (fluxfit.RequestError, rig, {"every": 0.0}, "above zero"),
        (fluxfit.RequestError, iter([{"t": 0.0}]), {}, "the rows have no ud"),
        (fluxfit.RequestError, iter([columns | {"iq": columns["iq"][1:]}]), {}, "iq has 8999 rows, and t 9000"),
    ]
    for kind, data, keywords, sentence in wrong:
        with pytest.raises(kind, match=sentence) as caught:
            list(fluxfit.track(data, **keywords))
        assert "--" not in str(caught.value)
