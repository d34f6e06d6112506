"""Loops over surfels and over the rays of a packet run in vectors, where the processor has them: read off its code."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import llvmlite.binding as llvm
import numba
import pytest
from numba import types

from jaart.core.kernels import abreast, blocks, moments, packet, records, sums
from jaart.core.kernels.call import EVALUATE

NEAR, X, _, _, WEIGHTS, _ = EVALUATE.args
LANES = types.uint64
PACKET = types.Array(types.float64, 1, "C")
LOOPS: dict[str, tuple[Any, tuple[Any, ...], int]] = {
    "sums with the Gaussian weight": (sums.gaussian_sums, (NEAR, X, types.float64), 20),
    "Σθ(p - x)": (sums.offset_sums, (NEAR, X, WEIGHTS), 3),
    "Σθn": (sums.normal_sums, (NEAR, WEIGHTS), 3),
    "covariance": (sums.covariance_sums, (NEAR, X, WEIGHTS), 6),
    "rays that enter": (packet.enter, (PACKET, *(types.float64,) * 3, LANES), 6),
    "rays that step": (packet.step, (PACKET, *(types.float64,) * 4, LANES), 6),
    "searches that begin": (abreast.base_on, (PACKET, LANES), 3),
    "searches that step": (abreast.step, (PACKET, *(types.float64,) * 8, LANES), 12),
    "moments": (moments.sum_to_fourth, (PACKET, LANES, LANES, LANES), 10),
}
#: Loops with a choice in each lane, for which vectors need masks or blends of whole registers.
CHOOSING = ("rays that step", "searches that begin", "searches that step")
ARM = ("aarch64", "arm64")


def machine() -> str:
    """The processor's family."""
    return str(llvm.get_process_triple().split("-")[0])


def packed() -> str:
    """A pattern of instructions that multiply vectors of doubles on this machine; skips where none is known."""
    if machine() in ("x86_64", "amd64") and llvm.get_host_cpu_features().get("avx2"):
        return r"v(?:mul|fmadd\d+|fmsub\d+|fnmadd\d+|fnmsub\d+)pd\s.*%[yz]mm"
    if machine() in ARM:
        return r"(?:fmul|fmla|fmls)\s+v\d+\.2d"
    pytest.skip(f"no vectors of doubles are known on {machine()}")


def code_of(function: Any, signature: tuple[Any, ...], flags: Any) -> str:
    """The machine code of a function compiled for a signature."""
    fresh = numba.njit(function, nogil=True, fastmath=flags, error_model="numpy", _nrt=False, no_cpython_wrapper=True,
                       no_cfunc_wrapper=True)
    fresh.compile(signature)
    (code,) = fresh.inspect_asm().values()
    return str(code)


def chain(a: records.Array) -> float:
    """A loop in which each step needs the last: it cannot be a vector."""
    total = 1.0
    for i in range(a.shape[0]):
        total = total * a[i] + 1.0
    return total


def all_codes() -> dict[str, str]:
    """The machine code of all loops."""
    codes = {name: code_of(kernel.py_func, signature, kernel.targetoptions["fastmath"])
             for name, (kernel, signature, _) in LOOPS.items()}
    ahead = code_of(blocks.fetch_centre.py_func, (types.int64,), {"contract"})
    return codes | {"chain": code_of(chain, (PACKET,), {"contract"}), "ahead": ahead}


@pytest.fixture(scope="module")
def codes() -> dict[str, str]:
    """The machine code of all loops, compiled in a process of its own: code that nobody calls is not kept here."""
    script = "import json; from tests.core.test_machine_code import all_codes; print(json.dumps(all_codes()))"
    root = Path(__file__).parents[2]
    done = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True, cwd=root,
                          env={**os.environ, "PYTHONPATH": str(root)})
    return dict(json.loads(done.stdout))


@pytest.mark.parametrize("name", LOOPS)
def test_loops_are_compiled_to_vectors(name: str, codes: dict[str, str]) -> None:
    if name in CHOOSING and machine() in ARM:
        pytest.skip("the compiler keeps such loops scalar on some of these processors")
    assert len(re.findall(packed(), codes[name])) >= LOOPS[name][2]


def test_a_loop_in_which_each_step_needs_the_last_is_none(codes: dict[str, str]) -> None:
    """What the pattern finds is not there in a loop that cannot be a vector: the check can fail."""
    assert codes["chain"] and not re.findall(packed(), codes["chain"])


def test_what_will_be_read_is_fetched_ahead(codes: dict[str, str]) -> None:
    if machine() not in ("x86_64", "amd64", *ARM):
        pytest.skip(f"how memory is fetched ahead is not known on {machine()}")
    assert len(re.findall(r"\b(?:prefetcht0|prfm)\b", codes["ahead"])) == 3
