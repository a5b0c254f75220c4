"""What an identification gives."""

import html
import json
import math
import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from fluxfit import _fluxfit

PARAMETERS = ("rs", "ld", "lq", "psi_f")
SYMBOLS = {"rs": "R_s", "ld": "L_d", "lq": "L_q", "psi_f": "psi_f"}
# Prefixes of units, from the largest factor that a value may be written with.
PREFIXES = ((1.0, ""), (1e-3, "m"), (1e-6, "u"))
COLOURS = {"identified": "#1a7f37", "weak": "#9a6700", "not-identifiable": "#cf222e"}


@dataclass(frozen=True)
class Estimate:
    """One parameter: its value in SI units, with a 95 % interval and a verdict.

    `value`, `interval` and `standard_error` are `None` where the verdict is `not-identifiable`; `reason` says why the verdict is not
    better, `remedy` what to measure or to state.
    """

    name: str
    value: "float | None"
    unit: str
    interval: "tuple[float, float] | None"
    standard_error: "float | None"
    verdict: str
    reason: "str | None"
    remedy: "str | None"

    @classmethod
    def _of(cls, name: str, entry: Mapping[str, Any]) -> "Estimate":
        interval = entry["ci95"]
        return cls(
            name=name,
            value=entry["value"],
            unit=entry["unit"],
            interval=None if interval is None else (interval[0], interval[1]),
            standard_error=entry["standard_error"],
            verdict=entry["verdict"],
            reason=entry["reason"],
            remedy=entry["remedy"],
        )

    def _cells(self) -> "tuple[str, str, str, str, str]":
        """Symbol, value, unit, interval and verdict, as they are shown."""
        symbol = SYMBOLS.get(self.name, self.name)
        verdict = self.verdict.replace("-", " ")
        if self.value is None or self.interval is None:
            return symbol, "-", "", "", verdict
        factor, prefix = next(((f, p) for f, p in PREFIXES if abs(self.value) >= f), PREFIXES[-1])
        low, high = self.interval
        half = (high - low) / 2 / factor
        decimals = max(0, 1 - math.floor(math.log10(half))) if half > 0 else 6
        shown = [f"{number / factor:.{min(decimals, 12)}f}" for number in (self.value, low, high)]
        return symbol, shown[0], prefix + self.unit, f"{shown[1]} .. {shown[2]}", verdict

    def __repr__(self) -> str:
        symbol, value, unit, interval, verdict = self._cells()
        return f"<{symbol} {value} {unit}, 95 % {interval}, {verdict}>" if interval else f"<{symbol}: {verdict}>"


class Identification:
    """The answer of `fluxfit.identify`.

    `rs` (ohm), `ld`, `lq` (H) and `psi_f` (Wb, peak per phase) are the parameters; `to_dict()` is the whole answer, the JSON document of
    `fluxfit identify --json`.
    """

    def __init__(self, answer: "_fluxfit.Answer", call: str) -> None:
        self._answer = answer
        self._call = call

    @cached_property
    def _document(self) -> "dict[str, Any]":
        document: dict[str, Any] = json.loads(self._answer.document())
        return document

    @cached_property
    def parameters(self) -> "dict[str, Estimate]":
        """All four, by name."""
        return {name: Estimate._of(name, self._document["parameters"][name]) for name in PARAMETERS}

    @property
    def rs(self) -> Estimate:
        """Stator resistance, ohm."""
        return self.parameters["rs"]

    @property
    def ld(self) -> Estimate:
        """Inductance of the d axis, H."""
        return self.parameters["ld"]

    @property
    def lq(self) -> Estimate:
        """Inductance of the q axis, H."""
        return self.parameters["lq"]

    @property
    def psi_f(self) -> Estimate:
        """Flux linkage of the magnets, Wb, peak per phase."""
        return self.parameters["psi_f"]

    @property
    def model(self) -> str:
        """The model that answered: `steady` or `output-error`."""
        return str(self._document["model"])

    @property
    def warnings(self) -> "list[str]":
        """What limits the whole answer, one sentence each."""
        return [warning["message"] for warning in self._document["warnings"]]

    @property
    def nuisance(self) -> "dict[str, Any]":
        """The voltage timing and the faults of the drive that were identified beside the motor."""
        nuisance: dict[str, Any] = self._document["nuisance"]
        return nuisance

    @property
    def notes(self) -> "list[str]":
        """What was read as what, and what was inferred."""
        return self._answer.notes()

    @property
    def covariance(self) -> "np.ndarray[Any, np.dtype[np.float64]]":
        """Covariance of the errors of rs, ld, lq and psi_f in SI units, shape (4, 4); NaN where a parameter is not identifiable."""
        diagnostics = self._document["diagnostics"]
        errors = np.array([self._document["parameters"][name]["standard_error"] for name in PARAMETERS], dtype=float)
        correlation = np.array(diagnostics["correlation"], dtype=float)
        return np.asarray(correlation * np.outer(errors, errors))

    @property
    def is_complete(self) -> bool:
        """Whether every parameter is identified."""
        return all(estimate.verdict == "identified" for estimate in self.parameters.values())

    def to_dict(self) -> "dict[str, Any]":
        """The JSON document (schema `fluxfit.identification/1`) as a new dictionary."""
        document: dict[str, Any] = json.loads(self._answer.document())
        return document

    def to_json(self) -> str:
        """The JSON document, the same bytes as the command prints."""
        return self._answer.document()

    def to_pandas(self) -> Any:
        """A DataFrame with a row for each parameter, indexed by its name. Needs pandas."""
        import pandas as pd

        rows = [
            {
                "value": estimate.value,
                "unit": estimate.unit,
                "low": estimate.interval[0] if estimate.interval else None,
                "high": estimate.interval[1] if estimate.interval else None,
                "standard_error": estimate.standard_error,
                "verdict": estimate.verdict,
                "reason": estimate.reason,
                "remedy": estimate.remedy,
            }
            for estimate in self.parameters.values()
        ]
        return pd.DataFrame(rows, index=pd.Index(PARAMETERS, name="parameter"))

    def report(self, path: "str | os.PathLike[str]") -> None:
        """Writes the report, one HTML page that opens offline.

        Raises `FileError` if it cannot be written, `RequestError` if the name is none of a page.
        """
        self._answer.report(path, self._call)

    def export(self, target: str, path: "str | os.PathLike[str]") -> None:
        """Writes the file of another tool: `vesc`, `moteus`, `mcsdk` or `matlab`.

        Raises `RequestError` where the answer does not carry it: a parameter is not identified, or the pole pairs are not known.
        """
        self._answer.export(target, path)

    def plot(self, ax: Any = None) -> Any:
        """Draws each value with its 95 % interval, in percent of the value; returns the axes. Needs matplotlib (`fluxfit[plot]`)."""
        import matplotlib.pyplot as plt

        if ax is None:
            _, ax = plt.subplots(figsize=(6, 2.4), layout="constrained")
        for place, estimate in enumerate(self.parameters.values()):
            symbol, value, unit, _, verdict = estimate._cells()
            colour = COLOURS.get(estimate.verdict, "black")
            if estimate.value and estimate.interval:
                half = 50 * (estimate.interval[1] - estimate.interval[0]) / abs(estimate.value)
                ax.errorbar([0], [place], xerr=[[half], [half]], fmt="o", color=colour, capsize=4)
            ax.annotate(f"{symbol}  {value} {unit}  {verdict}", (0, place), xytext=(0, 7), textcoords="offset points", ha="center", color=colour)
        ax.set(yticks=range(len(PARAMETERS)), yticklabels=[SYMBOLS[name] for name in PARAMETERS], ylim=(-0.5, 3.9))
        ax.set_xlabel("95 % interval, % of the value")
        ax.invert_yaxis()
        return ax

    def _title(self) -> str:
        identified = sum(estimate.verdict == "identified" for estimate in self.parameters.values())
        log = self._document["log"]
        return f"{identified} of 4 identified ({self.model}, {log['rows']} rows, {log['duration_s']:.3g} s)"

    def __repr__(self) -> str:
        cells = [estimate._cells() for estimate in self.parameters.values()]
        widths = [max(len(row[column]) for row in cells) for column in range(5)]
        lines = [f"Identification: {self._title()}"]
        for row in cells:
            line = f"  {row[0]:{widths[0]}}  {row[1]:>{widths[1]}} {row[2]:{widths[2]}}  {row[3]:{widths[3]}}  {row[4]}"
            lines.append(line.rstrip())
        for estimate in self.parameters.values():
            if estimate.verdict != "identified" and estimate.reason:
                lines.append(f"{SYMBOLS[estimate.name]}: {estimate.reason}.")
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        rows = []
        for estimate in self.parameters.values():
            symbol, value, unit, interval, verdict = map(html.escape, estimate._cells())
            said = html.escape(". ".join(text for text in (estimate.reason, estimate.remedy) if text))
            colour = COLOURS.get(estimate.verdict, "inherit")
            rows.append(
                f'<tr title="{said}"><th style="text-align:left">{symbol}</th><td style="text-align:right">{value}</td>'
                f'<td style="text-align:left">{unit}</td><td>{interval}</td><td style="color:{colour};text-align:left">{verdict}</td></tr>'
            )
        warnings = "".join(f"<li>{html.escape(warning)}</li>" for warning in self.warnings)
        return (
            f"<div><b>{html.escape(self._title())}</b><table><thead><tr><th></th><th>value</th><th></th><th>95 % interval</th>"
            f"<th>verdict</th></tr></thead><tbody>{''.join(rows)}</tbody></table>{f'<ul>{warnings}</ul>' if warnings else ''}</div>"
        )
