"""What may import what, beyond the contracts in pyproject.toml: seen from a fresh process, and line by line."""

import ast
import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
HEAVY = ("PySide6", "qtpy", "pyvista", "pyvistaqt", "vtkmodules", "matplotlib")


def loaded_by(code: str, folder: Path) -> set[str]:
    """Top-level packages that a fresh process has loaded after the code."""
    code += "\nimport sys; print('LOADED', *{name.partition('.')[0] for name in sys.modules})"
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run([sys.executable, "-c", code], cwd=folder, env=environment, capture_output=True, text=True,
                          check=True)
    return set(done.stdout.rpartition("LOADED")[2].split())


def test_importing_all_of_core_loads_no_window_and_no_plotting(tmp_path):
    loaded = loaded_by("""
import importlib, pkgutil, jaart.core
names = [m.name for m in pkgutil.walk_packages(jaart.core.__path__, "jaart.core.")]
assert len(names) > 20, names
for name in names:
    importlib.import_module(name)
""", tmp_path)
    assert "numba" in loaded
    assert loaded.isdisjoint(HEAVY)


def test_a_headless_render_loads_no_window_and_no_plotting(tmp_path):
    loaded = loaded_by("""
from jaart.__main__ import main
assert main(["render", "standard", "--size", "16x16", "--output", "p.png", "--hits", "h.npz"]) == 0
assert main(["trace", "standard", "--pixel", "8,8", "--size", "16x16", "--output", "t.json"]) == 0
assert main(["info", "standard"]) == 0
assert main(["plan", "standard"]) == 0
""", tmp_path)
    assert loaded.isdisjoint(HEAVY)
    assert {p.name for p in tmp_path.iterdir()} == {"p.png", "h.npz", "t.json"}


@pytest.mark.parametrize("arguments", [["settings"], ["settings", "radius"], ["--version"], ["--help"],
                                       ["render", "--help"], ["render", "standard", "--size", "wide"]], ids=" ".join)
def test_what_needs_no_scene_loads_no_numbers(arguments, tmp_path):
    loaded = loaded_by(f"from jaart.__main__ import main; main({arguments!r})", tmp_path)
    assert "typer" in loaded
    assert loaded.isdisjoint({*HEAVY, "numpy", "numba", "scipy"})


def test_the_package_alone_loads_nothing_heavy(tmp_path):
    loaded = loaded_by("import jaart; assert 'render' in dir(jaart)", tmp_path)
    assert loaded.isdisjoint({*HEAVY, "numpy", "numba", "scipy", "typer"})


def test_the_package_alone_loads_one_module(tmp_path):
    code = "import sys, importlib, typing; before = set(sys.modules); import jaart; " \
           "assert set(sys.modules) - before == {'jaart'}, set(sys.modules) - before"
    assert "jaart" in loaded_by(code, tmp_path)


def test_kernels_import_math_numpy_numba_and_each_other():
    files = sorted((ROOT / "jaart/core/kernels").glob("*.py"))
    assert len(files) > 5
    for path in files:
        strangers = {name for name in imported(path) if not allowed(name)}
        # how kernels are compiled and cached is no kernel
        assert not strangers or path.name == "jit.py", f"{path.name} imports {strangers}"


def allowed(name: str) -> bool:
    first = name.partition(".")[0]
    return name.startswith("jaart.core.kernels") or first in {
        "__future__", "math", "typing", "collections", "numpy", "numba", "llvmlite"}


def imported(path: Path) -> set[str]:
    names = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path.name}: a relative import"
            names.add(node.module or "")
    return names


def test_every_package_is_shipped():
    listed = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]["packages"]
    found = {".".join(p.parent.relative_to(ROOT).parts) for p in (ROOT / "jaart").rglob("__init__.py")}
    assert set(listed) == found | {"jaart.resources"}
