"""minimize and Search: any function, the same bits in every way."""

from typing import Any

import numpy as np
import pytest

import fluxfit

BOUNDS = [(-2.0, 2.0), (-1.0, 3.0)]


def valley(x: Any) -> Any:
    """Rosenbrock's, lowest at (1, 1)."""
    return 100 * (x[..., 1] - x[..., 0] ** 2) ** 2 + (1 - x[..., 0]) ** 2


def test_all_ways_give_the_same_bits() -> None:
    whole = fluxfit.minimize(valley, BOUNDS, vectorized=True)
    assert np.abs(whole.x - 1).max() < 1e-3 and whole.fun == whole.history[-1] and len(whole.history) == 301
    one_by_one = fluxfit.minimize(valley, BOUNDS)
    in_processes = fluxfit.minimize(valley, BOUNDS, workers=2, iterations=300)
    mapped = fluxfit.minimize(valley, BOUNDS, workers=map)
    search = fluxfit.Search(BOUNDS)
    while (points := search.ask()) is not None:
        assert points.shape == (50, 2) and np.array_equal(np.asarray(search.ask()), points)
        search.tell(valley(points))
    for other in (one_by_one, in_processes, mapped, search.result()):
        assert (other.x == whole.x).all() and other.fun == whole.fun and other.nfev == whole.nfev == 15050


@pytest.mark.parametrize("method", fluxfit.methods())
def test_every_method_runs(method: str) -> None:
    found = fluxfit.minimize(lambda x: (x**2).sum(axis=1), [(-1, 2)] * 3, method, vectorized=True, iterations=30, seed=5)
    assert found.fun < 1 and found.success


def test_the_callback_stops_and_the_target_too() -> None:
    seen: list[float] = []

    def enough(x: Any, cost: float) -> bool:
        seen.append(cost)
        return len(seen) == 4

    found = fluxfit.minimize(valley, BOUNDS, vectorized=True, callback=enough)
    assert (found.nit, found.success, found.fun) == (4, False, seen[-1])
    assert fluxfit.minimize(valley, BOUNDS, vectorized=True, target=1e-2).nit < 300


def test_bounds_of_scipy_and_its_result() -> None:
    optimize = pytest.importorskip("scipy.optimize")
    found = fluxfit.minimize(valley, optimize.Bounds([-2, -1], [2, 3]), vectorized=True)
    assert isinstance(found, optimize.OptimizeResult) and found.fun < 1e-6


def test_refusals() -> None:
    wrong: list[dict[str, Any]] = [
        {"bounds": [(1, 0)]},
        {"bounds": [1, 2]},
        {"bounds": [(0, 1)], "method": "x"},
        {"bounds": [(0, 1)], "population": 1},
    ]
    for keywords in wrong:
        with pytest.raises(fluxfit.RequestError):
            fluxfit.minimize(lambda x: x[:, 0], vectorized=True, **keywords)
    with pytest.raises(ZeroDivisionError):
        fluxfit.minimize(lambda x: 1 / 0, BOUNDS)
    with pytest.raises(ValueError, match="one for each row"):
        fluxfit.minimize(lambda x: x[:3, 0], BOUNDS, vectorized=True)
    search = fluxfit.Search(BOUNDS)
    with pytest.raises(fluxfit.RequestError, match="nothing was asked"):
        search.tell([1.0])
    search.ask()
    with pytest.raises(fluxfit.RequestError, match="tell one for each"):
        search.tell([1.0])
    with pytest.raises(fluxfit.RequestError):
        fluxfit.Search(BOUNDS, population=1).ask()
