"""The examples of the docstrings, of README and of the manual run."""

import doctest
import importlib
import re
import subprocess
import sys
from pathlib import Path

import pytest

from conftest import ROOT

MODULES = ["fluxfit", "fluxfit._api", "fluxfit._fleet", "fluxfit.spark", "fluxfit._identification", "fluxfit._log", "fluxfit._optimize", "fluxfit._toml", "fluxfit._track", "fluxfit._words"]
PAGES = ["README.md", "crates/fluxfit-python/README.md", "docs/python.md"]


@pytest.mark.parametrize("name", MODULES)
def test_docstrings(name: str) -> None:
    assert doctest.testmod(importlib.import_module(name)).failed == 0


@pytest.mark.parametrize("page", PAGES)
def test_pages(page: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    text = (ROOT / page).read_text()
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    if page != "README.md":
        assert blocks
    examples = doctest.DocTestParser().get_doctest("\n".join(blocks), {}, page, page, 0)
    assert doctest.DocTestRunner(optionflags=doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE).run(examples).failed == 0


def test_every_name_is_documented() -> None:
    import fluxfit

    for name in fluxfit.__all__:
        assert getattr(fluxfit, name).__doc__, name
    assert Path(fluxfit.__file__).with_name("py.typed").exists()


@pytest.mark.parametrize("script", sorted((ROOT / "crates/fluxfit-python/gallery").glob("*.py")), ids=lambda path: path.stem)
def test_gallery(script: Path) -> None:
    run = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
