"""Refusals: one tree, one sentence, Python's words."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import fluxfit


def refusal(kind: type[Exception], *arguments: Any, **keywords: Any) -> str:
    with pytest.raises(kind) as caught:
        fluxfit.identify(*arguments, **keywords)
    assert isinstance(caught.value, fluxfit.Error)
    sentence = str(caught.value)
    assert "--" not in sentence, sentence
    return sentence


def test_each_kind_has_its_class(tmp_path: Path, rig: Path, steady: fluxfit.Log) -> None:
    assert "there is no such file" in refusal(fluxfit.FileError, tmp_path / "missing.csv")
    assert refusal(OSError, tmp_path / "missing.csv")
    without = {"x1" if name == "uq" else name: values for name, values in steady.items()}
    assert 'mapping={"uq": COLUMN}' in refusal(fluxfit.DataError, without)
    assert refusal(ValueError, without)
    assert "no method" in refusal(fluxfit.RequestError, rig, method="annealing")
    assert "steady" in refusal(fluxfit.RequestError, rig, model="seady")
    assert 'fix={"r": ...}' not in refusal(fluxfit.RequestError, rig, fix={"r": 1})
    assert refusal(fluxfit.RequestError, rig, fix={"rs": -1})
    assert "is no value" in refusal(fluxfit.RequestError, rig, fix={"rs": None})
    assert "standard error" in refusal(fluxfit.RequestError, rig, prior={"rs": 0.96})
    assert "nothing that a log" in refusal(fluxfit.RequestError, 3)


def test_options_become_keywords(steady: fluxfit.Log) -> None:
    stepping = dict(steady) | {"iq": np.linspace(0, 9, 300), "id": np.linspace(-3, 3, 300)}
    sentence = refusal(fluxfit.DataError, stepping, model="steady")
    assert "window=(T0, T1)" in sentence


def test_a_value_that_is_none_is_named(steady: fluxfit.Log) -> None:
    bad = dict(steady) | {"iq": steady["iq"].copy()}
    bad["iq"][41] = np.nan
    assert "row 42, column 'iq'" in refusal(fluxfit.DataError, bad)
    short = dict(steady) | {"iq": steady["iq"][:-1]}
    assert "299 rows" in refusal(fluxfit.DataError, short)
    assert "dimensions" in refusal(fluxfit.DataError, dict(steady) | {"iq": np.zeros((300, 2))})


def test_columns_that_contradict_each_other_are_refused(rig: Path, columns: dict[str, Any]) -> None:
    wrong = columns | {"theta_e": np.rad2deg(columns["theta_e"])}
    sentence = refusal(fluxfit.DataError, wrong)
    assert 'unit={"theta_e": "deg"}' in sentence
    assert fluxfit.identify(wrong, unit={"theta_e": "deg"}).is_complete
