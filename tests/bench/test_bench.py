"""The benchmark: that it compares like with like and says what it found. No test here looks at a time."""

from __future__ import annotations

import contextlib
import json
import math
import os
import subprocess
import sys

import numpy as np
import pytest

from bench import ROOT, AbsentError, agreement, machine, memory, processes, shade, table, worker
from bench.inputs import LEAST_COSINE, LEAST_ROUGHNESS, inputs
from bench.table import Row
from bench.worker import CONTENDERS, Worker, WorkerError

POINTS = 7  # no multiple of a texture's width


def exercise(l, v, n, albedo, metalness, roughness):  # noqa: E741
    """The model as exercise 7 writes it, for one point, in double precision."""

    def dot(a, b):
        return sum(p * q for p, q in zip(a, b, strict=True))

    H = [p + q for p, q in zip(l, v, strict=True)]
    h = [p / math.sqrt(dot(H, H)) for p in H]
    NoL, NoV, NoH, LoH = dot(n, l), dot(n, v), dot(n, h), dot(l, h)
    a2 = roughness**4
    D = a2 / (math.pi * (NoH * NoH * (a2 - 1) + 1) ** 2)
    V = 0.5 / (NoL * math.sqrt(NoV * NoV * (1 - a2) + a2) + NoV * math.sqrt(NoL * NoL * (1 - a2) + a2))
    radiance = []
    for color in albedo:
        F0 = 0.04 * (1 - metalness) + color * metalness
        F = F0 + (1 - F0) * (1 - LoH) ** 5
        radiance.append((D * V * F + (1 - F) * (1 - metalness) * color / math.pi) * NoL)
    return radiance


@pytest.mark.parametrize("contender", CONTENDERS)
def test_a_contender_computes_the_model(contender, tmp_path):
    with contextlib.closing(Worker(contender)) as process:
        try:
            process.hello()
        except AbsentError as absent:
            pytest.skip(str(absent))
        process.ask(count=POINTS, save=str(tmp_path / "result.npy"))
    expected = [exercise(*(array[k].tolist() for array in inputs(POINTS))) for k in range(POINTS)]
    result = np.load(tmp_path / "result.npy")
    assert result.dtype == np.float32
    np.testing.assert_allclose(result, expected, rtol=1e-4)  # the vectors are unit to float32's rounding only


def test_the_inputs_are_lit_unit_vectors_and_materials():
    x = inputs(1000)
    for vectors in (x.l, x.v, x.n):
        np.testing.assert_allclose(np.linalg.norm(vectors, axis=1), 1, atol=1e-6)
    assert np.einsum("ij,ij->i", x.n, x.l).min() >= LEAST_COSINE
    assert np.einsum("ij,ij->i", x.n, x.v).min() >= LEAST_COSINE
    for scalars in (x.albedo, x.metalness, x.roughness):
        assert 0 <= scalars.min() and scalars.max() <= 1
    assert x.roughness.min() >= np.float32(LEAST_ROUGHNESS)
    assert all(array.dtype == np.float32 and array.flags.c_contiguous for array in x)
    assert x.nbytes == 1000 * 14 * 4
    assert all(map(np.array_equal, x, inputs(1000)))


@pytest.mark.parametrize(
    ("change", "agrees"),
    [
        (lambda r: r, True),
        (lambda r: r * np.float32(1 + 0.5 * agreement.TOLERANCE), True),
        (lambda r: r * np.float32(1 + 2 * agreement.TOLERANCE), False),
        (lambda r: np.where(r > 2, np.float32(np.nan), r), False),
        (lambda r: np.where(r > 2, np.float32(np.inf), r), False),
        (lambda r: r + np.float32(1e-6), False),  # where the reference is 0
        (lambda r: r.astype(np.float64), False),
        (lambda r: r[:-1], False),
    ],
)
def test_agreement(change, agrees):
    reference = np.array([[0, 1, 2], [3, 4, 5]], np.float32)
    assert agreement.agrees(change(reference), reference) is agrees


def test_equal_infinities_agree():
    assert agreement.disagreement(*[np.array([np.inf, 0], np.float32)] * 2) == 0


class StubWorker:
    """A contender that gives what it was told to."""

    def __init__(self, result):
        self._result = result

    def ask(self, *, count, save):
        if self._result is None:
            raise WorkerError("it failed")
        np.save(save, self._result)


def test_who_disagrees_or_fails_is_not_timed(tmp_path):
    right = np.ones((4, 3), np.float32)
    workers = {name: StubWorker(result) for name, result in
               {"harness": right, "numpy": right, "numba": 2 * right, "moderngl, textures": None}.items()}  # fmt: skip
    errors = {}
    notes = dict(shade._checked(workers, 4, tmp_path, errors))
    assert list(workers) == ["harness", "numpy"]
    assert notes == {"numpy": "agrees exactly"}
    assert str(errors["numba"]) == "DISAGREES with the harness by 1, not within 0.00015"
    assert str(errors["moderngl, textures"]) == "it failed"


def test_a_missing_package_is_said(monkeypatch):
    monkeypatch.setitem(sys.modules, "numba", None)
    monkeypatch.delitem(sys.modules, "bench.shade_numba", raising=False)
    with pytest.raises(AbsentError, match="^numba is not installed: pip install"):
        worker._serve("numba")


def test_a_contender_that_does_not_start_says_why():
    with contextlib.closing(Worker("abacus")) as process:
        with pytest.raises(WorkerError, match="abacus"):
            process.hello()
        with pytest.raises(WorkerError, match="ended with exit code"):
            process.ask(calls=1)


def test_memory_is_inputs_outputs_and_what_is_beyond():
    nothing_extra = memory.Usage(inputs=200, outputs=100, before=1000, peak=1100)
    assert (nothing_extra.extra, nothing_extra.ratio) == (0, 1)
    inputs_copied_twice = memory.Usage(inputs=200, outputs=100, before=1000, peak=1500)
    assert inputs_copied_twice.extra == 400
    assert inputs_copied_twice.ratio == pytest.approx(700 / 300)


def test_memory_reads_the_kernels_numbers():
    assert memory.resident("Name:\tpython\nVmHWM:\t    2048 kB\nVmRSS:\t    1024 kB\n") == (1 << 20, 2 << 20)


def test_a_process_that_fails_is_no_time():
    with pytest.raises(processes.ProcessError, match="exit code 1: ZeroDivisionError"):
        processes.seconds([sys.executable, "-c", "1/0"], os.environ, lambda _: True)
    with pytest.raises(processes.ProcessError, match="what it made is wrong"):
        processes.seconds([sys.executable, "-c", "print(1)"], os.environ, lambda out: float(out) == 2)


def test_a_row_knows_its_median_and_its_aim():
    row = Row("shade", "harness", "ns", (3.0, 1.0, 2.0), aim=2.0)
    assert (row.median, row.met) == (2, True)
    assert Row("shade", "harness", "ns", (3.0,), aim=2.0).met is False
    assert Row("shade", "rival", "ns", (3.0,), aim=2.0, aim_is="above").met is True
    assert Row("shade", "rival", "ns", (2.0,), aim=2.0, aim_is="above").met is False
    assert Row("shade", "rival", note="not installed", aim=2.0).met is None
    assert Row("shade", "rival", "ns", (3.0,)).met is None


@pytest.mark.parametrize(
    ("value", "shown"), [(None, ""), (0.04567, "0.0457"), (1.0, "1.00"), (12.345, "12.3"), (1234.5, "1234")]
)
def test_numbers_have_three_digits(value, shown):
    assert table.number(value) == shown


ROWS = [
    Row("shade, N = 10", "harness", "ns", (1.0, 2.0, 30.0), ratio=1.0, aim=2.0),
    Row("shade, N = 10", "rival", note="not installed"),
    Row("render", "warm", "s", (0.5,), aim=0.25, note="a | b"),
]


def test_text_is_aligned():
    assert table.text(ROWS) == (
        "measured       of       unit  median    min    max  n  x harness  aim            met  note\n"
        "---------------------------------------------------------------------------------------------------\n"
        "shade, N = 10  harness  ns      2.00   1.00   30.0  3       1.00  at most 2.00   yes\n"
        "shade, N = 10  rival                                                                  not installed\n"
        "\n"
        "render         warm     s      0.500  0.500  0.500  1             at most 0.250  NO   a | b\n"
    )


def test_markdown_is_a_table():
    lines = table.markdown(ROWS).splitlines()
    assert len({len(line) for line in lines}) == 1
    assert lines[0].startswith("| measured      | of      | unit | median |")
    assert lines[1].startswith("| ------------- | ------- | ---- | -----: |")
    assert lines[-1].endswith(r"| a \| b        |")


def test_the_machine_is_named():
    assert machine.cpu("processor\t: 0\nmodel name\t: Fast 9000\n") == "Fast 9000"
    versions = machine.versions("llvmpipe (LLVM 15), 4.5 (Core Profile) Mesa 22.3.6")
    assert versions["mesa"] == "22.3.6"
    assert versions["numpy"] == np.__version__
    assert set(versions) == {"python", "numpy", "numba", "moderngl", "mesa"}


def test_other_programs_are_seen():
    assert machine.busy_seconds("cpu  100 20 30 9999 999 4 5 41 0 0\ncpu0 1 2 3\n", 100) == 2
    others = machine.Others()
    assert others.share() is None or 0 <= others.share()
    quiet = machine.describe("llvmpipe", 0.0)
    assert "NOT QUIET" not in machine.text(quiet)
    assert "NOT QUIET: other programs used 20% of" in machine.text(quiet | {"others": 0.2})


def test_a_quick_run_has_all_rows(tmp_path):
    files = tmp_path / "table.md", tmp_path / "table.json"
    done = subprocess.run(
        [sys.executable, "-m", "bench", "--quick", "--markdown", files[0], "--json", files[1]],
        capture_output=True,
        text=True,
        cwd=ROOT,
    )
    assert (done.returncode, done.stderr) == (0, ""), done.stdout
    data = json.loads(files[1].read_text())
    assert set(data) >= {"machine", "cpu", "cores", "renderer", "versions", "rows"}
    assert [(row["measured"], row["of"]) for row in data["rows"]] == [
        *(("shade, N = 1 000", name) for name in CONTENDERS),
        *(("shade, N = 20 000", name) for name in CONTENDERS),
        ("memory, N = 100 000", "total"),
        ("memory, N = 100 000", "extra"),
        ("render 320x180", "cold"),
        ("render 320x180", "warm"),
        ("import and first call", "cold"),
        ("import and first call", "warm"),
    ]
    for row in data["rows"]:
        assert row["samples"] or row["absent"], row
        assert row["measured"] in done.stdout and row["measured"] in files[0].read_text()
