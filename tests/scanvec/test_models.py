"""Cost models, the ledger's times, exclusive access, further machines' loads, calibration, pictures."""

import csv

import jax.numpy as jnp
import numpy as np
import pytest

import scanvec as sv
import scanvec.plot

MODELS = (sv.EREW_PRAM, sv.CRCW_PRAM, sv.SCAN, sv.CM2, sv.CM5, sv.HYPERCUBE, sv.MESH2D)


def program(cm: sv.Simulated, n: int = 100) -> np.ndarray:
    v = cm.vector(np.random.default_rng(3).integers(0, 50, n))
    for _ in range(2):
        with cm.phase("sort"):
            order = sv.rank(v)
        with cm.phase("look up"):
            v = sv.get(v, order)
    copies, _ = sv.distribute(v, v % 3)
    return copies.to_numpy()


@pytest.mark.parametrize("model", MODELS, ids=repr)
def test_every_model_times_every_step(model):
    cm = sv.Simulated(16, model=model)
    program(cm)
    ledger = cm.ledger
    assert all(model.seconds(e, 16) > 0 for e in ledger.entries)
    assert ledger.seconds == pytest.approx(sum(row.seconds for row in ledger.by_phase().values()))
    assert ledger.seconds == pytest.approx(sum(row.seconds for row in ledger.table("operation")))
    assert repr(cm) == f"Simulated(processors=16, model=scanvec.{model.name})"


@pytest.mark.parametrize("model", MODELS, ids=repr)
def test_every_constant_says_where_it_comes_from(model):
    for constant in model.constants.values():
        assert constant.origin in ("sourced", "calibrated", "convention", "estimate")
        assert constant.source
    for name, constant in model.constants.items():
        assert f"{constant.origin}" in str(model)
        assert name in str(model)


def test_time_needs_a_model():
    cm = sv.Simulated(4)
    program(cm)
    with pytest.raises(ValueError, match="no cost model.*model=scanvec.CM5"):
        _ = cm.ledger.seconds
    assert cm.ledger.under(sv.CM5).seconds > 0
    assert "seconds" not in str(cm.ledger)
    with pytest.raises(ValueError, match="must be a scanvec model.*'CM5'"):
        sv.Simulated(4, model="CM5")


@pytest.mark.parametrize("processors", [1, 2, 7, 32, 1000])
def test_loads_on_further_machines_are_those_of_runs_on_them(processors):
    one = sv.Simulated(5, also=(3, processors))
    other = sv.Simulated(processors)
    assert np.array_equal(program(one), program(other))
    assert list(one.ledgers) == [5, *dict.fromkeys((3, processors))]
    assert one.ledgers[processors] == other.ledger


def test_exclusive_access_is_reported_with_primitive_and_phase():
    cm = sv.Simulated(4, model=sv.EREW_PRAM)
    v = cm.vector(np.arange(8))
    with cm.phase("exclusive"):
        sv.permute(v, cm.vector(np.arange(8)[::-1]))
        sv.get(v, v)
    with cm.phase("everyone reads one"):
        sv.get(v, cm.vector(np.zeros(8, int)))
    with cm.phase("some write one"):
        where = cm.vector(np.arange(8) < 3)
        sv.send(v, cm.vector(np.zeros(8, int)), sv.ADD, into=v, where=where)
    assert [(c.phase, c.primitive, c.step, c.accesses) for c in cm.ledger.conflicts] == [
        ("everyone reads one", "get", 2, 8),
        ("some write one", "send", 3, 3),
    ]
    assert "read by 8 elements at once" in str(cm.ledger.conflicts[0])
    assert "in phase 'some write one': one place was written by 3" in str(cm.ledger.conflicts[1])


def test_exclusive_access_can_be_enforced():
    cm = sv.Simulated(4, model=sv.EREW_PRAM, on_conflict="raise")
    v = cm.vector(np.arange(8))
    with (
        cm.phase("p"),
        pytest.raises(sv.ConcurrentAccessError, match="get.*in phase 'p'.*exclusive") as error,
    ):
        sv.get(v, cm.vector(np.zeros(8, int)))
    assert error.value.conflict.accesses == 8
    assert not cm.ledger.entries
    with pytest.raises(ValueError, match="'report' or 'raise', got 'ignore'"):
        sv.Simulated(4, on_conflict="ignore")


def test_concurrent_access_is_no_conflict_elsewhere():
    cm = sv.Simulated(4, model=sv.CRCW_PRAM, on_conflict="raise")
    v = cm.vector(np.arange(8))
    sv.get(v, cm.vector(np.zeros(8, int)))
    assert not cm.ledger.conflicts


@pytest.mark.parametrize(
    ("function", "arguments", "operations"),
    [
        (jnp.add, 2, 1),
        (lambda a, b: a * b + a, 2, 2),
        (lambda a: jnp.where(a > 0, a, -a), 1, 3),
        (lambda a: a, 1, 1),
    ],
)
def test_operations_are_those_of_the_function(function, arguments, operations):
    cm = sv.Simulated(4)
    v = cm.vector(np.arange(8.0))
    cm.map(function, *[v] * arguments)
    assert [e.operations for e in cm.ledger.entries] == [operations]
    # under a context one more selects the result
    cm.map(jnp.add, v, v, where=cm.vector(np.arange(8) > 3), otherwise=0.0)
    assert cm.ledger.entries[-1].operations == 2


def test_by_iteration():
    cm = sv.Simulated(4, model=sv.SCAN)
    program(cm)
    rows = cm.ledger.by_iteration("sort", "look up")
    assert len(rows) == 2
    assert sum(r.steps for r in rows) == sum(cm.ledger.by_phase()[p].steps for p in ("sort", "look up"))
    assert [r.steps for r in cm.ledger.by_iteration("look up")] == [1, 1]


def test_csv(tmp_path):
    cm = sv.Simulated(4, model=sv.CM5)
    program(cm)
    cm.ledger.to_csv(tmp_path / "ledger.csv")
    with open(tmp_path / "ledger.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == cm.ledger.steps
    assert sum(int(r["messages"]) for r in rows) == cm.ledger.messages
    assert sum(float(r["seconds"]) for r in rows) == pytest.approx(cm.ledger.seconds)
    assert [r["phase"] for r in rows] == [e.phase for e in cm.ledger.entries]


def test_loads_of_processors():
    cm = sv.Simulated(4)
    v = cm.vector(np.arange(5))  # on three processors: 2, 2, 1
    with cm.phase("one"):
        sv.get(v, cm.vector(np.zeros(5, int)))
    with cm.phase("two"):
        _ = v + 1
    assert cm.ledger.held("one").tolist() == cm.ledger.held("two").tolist() == [2, 2, 1, 0]
    assert cm.ledger.held().tolist() == [4, 4, 2, 0]
    assert {phase: load.tolist() for phase, load in cm.ledger.handled.items()} == {"one": [3, 2, 1, 0]}


def test_calibration_finds_the_constants_that_made_the_times():
    truth = sv.CM5.calibrated("a test", issue=3e-5, element=2e-6, packet=1e-5)
    ledgers = []
    for n in (10, 100, 1000, 3000):
        cm = sv.Simulated(4, model=truth)
        program(cm, n)
        ledgers.append(cm.ledger)
    found = sv.calibrate(
        sv.CM5, ledgers, [x.seconds for x in ledgers], ["issue", "element", "packet"], "test"
    )
    assert found.values == pytest.approx(truth.values)
    assert found.constants["issue"].origin == "calibrated"
    assert found.constants["combine"].origin == "sourced"
    with pytest.raises(ValueError, match="4 ledgers, 1 times"):
        sv.calibrate(sv.CM5, ledgers, [1.0], ["issue"], "test")
    with pytest.raises(ValueError, match="no constant 'weight'"):
        sv.calibrate(sv.CM5, ledgers, [1.0] * 4, ["weight"], "test")


def test_pictures(tmp_path):
    cm = sv.Simulated(8, model=sv.CM5)
    program(cm)
    axes = sv.plot.time_by_primitive(cm.ledger)
    heights = sum(bar.get_height() for bar in axes.patches)
    assert heights == pytest.approx(cm.ledger.seconds)
    axes.figure.savefig(tmp_path / "a.png")
    assert (tmp_path / "a.png").read_bytes()[:4] == b"\x89PNG"
    axes = sv.plot.time_by_iteration(cm.ledger, "sort", "look up")
    rows = cm.ledger.by_iteration("sort", "look up")
    assert sum(bar.get_height() for bar in axes.patches) == pytest.approx(sum(r.seconds for r in rows))
    axes = sv.plot.load_balance(cm.ledger, ax=sv.plot.new_axes())
    elements = axes.lines[0].get_ydata()
    assert elements.mean() == pytest.approx(1)
    with pytest.raises(ValueError, match="no phase 'none'; it has sort, look up"):
        sv.plot.time_by_iteration(cm.ledger, "none")
