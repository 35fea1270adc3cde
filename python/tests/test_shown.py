# SPDX-License-Identifier: GPL-3.0-or-later
"""What notebooks, figures and pandas see."""

import builtins
import pickle
import sys

import numpy as np
import pytest

import mesofit
from mesofit import _plot
from mesofit._progress import Progress


@pytest.fixture
def matplotlib():
    module = pytest.importorskip("matplotlib")
    module.use("agg")
    from matplotlib import pyplot
    yield pyplot
    pyplot.close("all")


def test_results_and_tables_show_themselves(fitted, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    shown = fitted._repr_html_()
    assert f"<b>fit: {fitted.status}</b>" in shown and "pressure" in shown and "±" in shown
    assert "<img" not in shown
    table = fitted["rdf"]
    assert "<th>r [lambda]</th>" in table._repr_html_() and "<table" in fitted.potential._repr_html_()
    only = fitted.potential
    assert only.columns == only.table.columns and only.units == only.table.units
    assert only.columns[:2] == ("r", "phi") and only.units[0] == "lambda"
    assert np.array_equal(only, only.table.values, equal_nan=True) and len(only.to_dict()) > 3
    assert np.array_equal(only.to_dict()["force"], only["force"], equal_nan=True)
    assert only.values is only.table.values and "phi" in only and "omega" not in only
    assert dict(only.items()).keys() == only.keys() == {""}
    assert repr(table).startswith("<Table rdf: ") and "fit in" in repr(fitted)
    with pytest.raises(ImportError, match="pip install matplotlib"):
        fitted.potential.plot()


def test_figures_are_drawn(fitted, simulated, matplotlib):
    ax = fitted.potential.plot()
    assert ax.get_xlabel() == "r / lambda" and ax.get_ylabel() == "Φ(r) / k_B T_0"
    assert len(ax.lines) == 1 and len(ax.collections) == 1
    line = ax.lines[0].get_xydata()
    assert np.array_equal(line[:, 1], fitted.potential["phi"], equal_nan=True)
    assert ax.lines[0].get_color() == "#0072b2"
    compared = fitted["rdf"].plot()
    assert [text.get_text() for text in compared.get_legend().get_texts()] == ["result", "target"]
    assert len(fitted.plot().axes) >= 3
    # The well fills the figure, and the core does not.
    low, high = ax.get_ylim()
    depth = -np.nanmin(fitted.potential["phi"])
    assert high <= 3 * depth * (1 + 1e-12) and 0 < ax.get_xlim()[0] < line[np.nanargmin(line[:, 1]), 0]
    waves = mesofit.Table("structure_factor", ("q", "S", "vectors"), ("", "", ""), np.ones((3, 3)))
    assert len(waves.plot().lines) == 1  # how many vectors a bin has is no curve
    assert "<img src=" in simulated._repr_html_()
    with pytest.raises(mesofit.InputError):
        mesofit.Table("one", ("a",), ("",), np.zeros((3, 1))).plot()


def test_curves_of_a_mixture_have_names(matplotlib):
    tables = ("potential_A-A", "potential_A-B", "potential_A-A_history", "potential_flat",
              "potential_now_A-A", "potential_history")
    assert mesofit.Curves._parts("potential", tables) == {"A-A": "potential_A-A",
                                                         "A-B": "potential_A-B"}
    table = mesofit.Table("potential_A-A", ("r", "phi"), ("nm", "kJ/mol"),
                          np.array([[0.1, 5.0], [0.2, -1], [0.3, 0]]))
    curves = mesofit.Curves("potential", {"A-A": table, "A-B": table})
    assert len(curves.plot().lines) == 2
    assert curves["B-A"] is curves["A-B"] and "B-A" in curves and "B-C" not in curves
    with pytest.raises(mesofit.InputError, match="there are 2"):
        curves.table
    with pytest.raises(mesofit.InputError, match="A-A, A-B"):
        curves["B-B"]


def test_pairs_of_a_mixture_have_one_colour_in_all_panels(tmp_path, matplotlib):
    r = np.linspace(0.1, 2, 20)
    for k, pair in enumerate(("2-2", "2-1", "1-1")):
        g, phi = 1 - np.exp(-r / (k + 1)), (k + 1) * (r**-2 - 2 * r**-1)
        for name, heading, columns in (("rdf", "r target result", (r, g, g)),
                                       ("potential", "r phi phi_error", (r, phi, 0 * r))):
            np.savetxt(tmp_path / f"{name}_{pair}.tsv", np.column_stack(columns), delimiter="\t",
                       header=heading.replace(" ", "\t"))
    (tmp_path / "summary.json").write_text("{}")
    result = mesofit.open(tmp_path)
    g, phi = result.plot().axes
    colours = {line.get_label(): line.get_color() for line in phi.lines}
    assert set(colours) == {"1-1", "2-1", "2-2"} and len(set(colours.values())) == 3
    assert colours.items() <= {line.get_label(): line.get_color() for line in g.lines}.items()
    assert len(g.lines) == 6 and phi.get_ylim()[0] < -3  # the deepest well, of 1-1
    assert np.array_equal(result["rdf_1-2"].values, result["rdf_2-1"].values)
    with pytest.raises(mesofit.InputError, match="no table 'rdf_1-3'"):
        result["rdf_1-3"]


def test_numbers_are_shown_with_their_errors():
    assert _plot._number(1.23456, 0.012) == "1.235 ± 0.012"
    assert _plot._number(1234.56, 25.0) == "1235 ± 25"
    assert _plot._number(1.5, None) == _plot._number(1.5, float("nan")) == "1.5"


def test_pandas_has_names_and_units(simulated):
    pytest.importorskip("pandas")
    frame = simulated["rdf"].to_pandas()
    assert list(frame.columns) == ["r", "g", "g_error"] and frame.attrs["units"]["r"] == "lambda"
    assert np.array_equal(frame["g"], simulated["rdf"]["g"])


def test_columns_are_views_of_one_memory(simulated):
    table = simulated["rdf"]
    assert np.shares_memory(table["g"], simulated.table("rdf").values)
    assert table.to_dict()["g"].base is not None and "g" in table and "h" not in table
    copy = pickle.loads(pickle.dumps(table))
    assert not np.shares_memory(copy.values, table.values)


def test_progress_is_shown_where_it_is_wanted(capsys):
    progress = Progress(True)
    progress.tell(30, 100, 10.0, "steps", "step 30", True)
    progress.say("a line")
    progress.end()
    said = capsys.readouterr().err
    assert "30 %  step 30  10 steps/s  7 s left" in said and "a line\n" in said
    quiet = Progress(False)
    quiet.tell(30, 100, 10.0, "steps", "step 30", True)
    quiet.say("a line")
    assert capsys.readouterr().err == ""


def test_broken_stream_of_progress_ends_no_run(monkeypatch, run_file):
    def fail(self, line):
        raise BrokenPipeError
    monkeypatch.setattr(Progress, "say", fail)
    from conftest import SCENE
    run = mesofit.simulate(SCENE, progress=True)
    assert run.status == "ok"


def test_open_of_the_package_is_not_pythons():
    assert mesofit.open is not builtins.open
