"""The optimizers of the library, for any function."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np

from fluxfit import _fluxfit
from fluxfit._errors import RequestError
from fluxfit._log import Array

MESSAGES = {
    "iteration-limit": "all iterations were run",
    "target-cost": "the target was reached",
    "close-to-optimum": "the known optimum was reached",
    "interrupted": "the callback stopped the search",
}


class _Result(dict[str, Any]):
    """scipy's OptimizeResult, where scipy is not installed."""

    def __getattr__(self, name: str) -> Any:
        try:
            return self[name]
        except KeyError:
            raise AttributeError(name) from None


def methods() -> "dict[str, str]":
    """Keys and names of the methods.

    >>> methods()["tgfpa"]
    'tGFPA'
    """
    return dict(_fluxfit.methods())


def _box(bounds: Any) -> "tuple[list[float], list[float]]":
    if hasattr(bounds, "lb") and hasattr(bounds, "ub"):  # scipy.optimize.Bounds
        return np.atleast_1d(bounds.lb).tolist(), np.atleast_1d(bounds.ub).tolist()
    pairs = np.asarray(bounds, dtype=float)
    if pairs.ndim != 2 or pairs.shape[1] != 2:
        raise RequestError("bounds must be a pair (lower, upper) for each variable")
    return pairs[:, 0].tolist(), pairs[:, 1].tolist()


def minimize(
    fun: "Callable[..., Any]",
    bounds: Any,
    method: str = "tgfpa",
    *,
    args: "tuple[Any, ...]" = (),
    vectorized: bool = False,
    workers: "int | Callable[..., Iterable[Any]]" = 1,
    callback: "Callable[[Array, float], Any] | None" = None,
    seed: int = 1,
    population: int = 50,
    iterations: int = 300,
    target: "float | None" = None,
) -> Any:
    """Minimizes a function over a box, without derivatives.

    `fun(x, *args)` takes a point of shape (N,) and returns its cost; with `vectorized=True` it takes the points of a generation in rows,
    shape (S, N), and returns their costs, shape (S,). A cost that is not finite counts as worse than any finite one. `bounds` has a pair
    (lower, upper) for each variable, or is scipy's `Bounds`. `workers` is a number of processes (-1: one for each core), or something
    that maps as `map` does. `callback(x, cost)` is called after each iteration and stops the search by returning something true. The same
    seed gives the same bits.

    Returns scipy's `OptimizeResult` (a dictionary with the same attributes, where scipy is not installed): `x`, `fun`, `nfev`, `nit`,
    `success`, `message`, `history` (the best cost after each iteration, the start included).

    Raises `RequestError` for an unknown method or bounds that are no box; what `fun` raises passes through.

    >>> import numpy as np
    >>> def valley(x):
    ...     return 100 * (x[:, 1] - x[:, 0] ** 2) ** 2 + (1 - x[:, 0]) ** 2
    >>> found = minimize(valley, [(-2, 2), (-1, 3)], vectorized=True)
    >>> bool(np.abs(found.x - 1).max() < 1e-3), found.nfev
    (True, 15050)
    """
    lower, upper = _box(bounds)
    pool: Any = None
    batch: Callable[[Array], Any]
    if vectorized:
        batch = (lambda points: fun(points, *args)) if args else fun
    else:
        mapped: Any = map
        if callable(workers):
            mapped = workers
        elif workers != 1:
            import multiprocessing

            pool = multiprocessing.Pool(None if workers == -1 else workers)
            mapped = pool.map
        one = _One(fun, args)
        batch = lambda points: np.fromiter(mapped(one, points), dtype=np.float64, count=len(points))  # noqa: E731

    def told(x: Array, cost: float) -> bool:
        try:
            return bool(callback is not None and callback(x, cost))
        except StopIteration:
            return True

    try:
        found = _fluxfit.minimize(batch, lower, upper, method, population, iterations, seed, target, told if callback else None)
    finally:
        if pool is not None:
            pool.terminate()
    return _result(found)


class _One:
    """A function with its further arguments, which processes can be given."""

    def __init__(self, fun: "Callable[..., Any]", args: "tuple[Any, ...]") -> None:
        self.fun = fun
        self.args = args

    def __call__(self, x: Array) -> float:
        return float(self.fun(x, *self.args))


def _result(found: "dict[str, Any]") -> Any:
    reason = found.pop("stop_reason")
    found |= {"success": reason != "interrupted", "message": MESSAGES[reason], "status": 0 if reason != "interrupted" else 1}
    try:
        from scipy.optimize import OptimizeResult
    except ImportError:
        return _Result(found)
    return OptimizeResult(found)


class Search:
    """A search that is asked for candidates and told their costs: for functions that are evaluated elsewhere.

    `bounds`, `method`, `seed`, `population` and `iterations` as in `minimize`, with the same bits.

    >>> search = Search([(-1, 1), (-1, 1)], iterations=20)
    >>> while (points := search.ask()) is not None:
    ...     search.tell((points**2).sum(axis=1))
    >>> search.result().nit
    20
    """

    def __init__(
        self, bounds: Any, method: str = "tgfpa", *, seed: int = 1, population: int = 50, iterations: int = 300
    ) -> None:
        lower, upper = _box(bounds)
        self._search = _fluxfit.AskTell(lower, upper, method, population, iterations, seed)

    def ask(self) -> "Array | None":
        """The next candidates in rows, shape (S, N); `None` when the search is over. Asked again before it is told, it gives the same."""
        return self._search.ask()

    def tell(self, costs: "Sequence[float] | Array") -> None:
        """The costs of the candidates, shape (S,).

        Raises `RequestError` if nothing was asked, or there is not one cost for each row.
        """
        self._search.tell([float(cost) for cost in costs])

    def result(self) -> Any:
        """What was found, as `minimize` returns it; `None` while the search goes on."""
        found = self._search.result()
        return None if found is None else _result(found)
