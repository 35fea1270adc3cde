# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures by matplotlib, with the colours of the program's (plots/style.gp), and what notebooks
show."""

from __future__ import annotations

import base64
import html
import io
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ._errors import InputError
from ._library import Array
from ._table import Curves, Table

if TYPE_CHECKING:
    from ._result import Result

INK, FAINT, GRID = "#222222", "#8a8a8a", "#e4e4e4"
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#aa4499", "#e69f00", "#56b4e9", "#882255", "#7a7a1f")

#: Columns that follow the first one and are worth a line, before all others.
_SYMBOLS = {"r": "r", "phi": "Φ(r)", "omega": "ω(r)", "g": "g(r)", "time": "t", "q": "q",
            "S": "S(q)", "msd": "MSD", "vacf": "VACF"}
_MOST_LINES = 8


def _pyplot() -> Any:
    try:
        from matplotlib import pyplot
    except ImportError:
        raise ImportError("figures need matplotlib: pip install matplotlib") from None
    return pyplot


def _axes(ax: Any, size: tuple[float, float] = (5.0, 3.4)) -> Any:
    if ax is not None:
        return ax
    return _pyplot().subplots(figsize=size, layout="constrained")[1]


def _style(ax: Any, table: Table, y: str) -> None:
    for side in ("top", "right"):
        ax.spines[side].set_visible(False)
    ax.grid(color=GRID, linewidth=0.5)
    ax.set_axisbelow(True)
    unit = table.unit(0)
    ax.set_xlabel(_SYMBOLS.get(table.columns[0], table.columns[0]) + (f" / {unit}" if unit else ""))
    ax.set_ylabel(y)


def _band(ax: Any, x: Array, y: Array, error: Array, colour: str) -> None:
    ax.fill_between(x, y - error, y + error, color=colour, alpha=0.22, linewidth=0)


def _draw_compared(table: Table, ax: Any, part: str, colour: str) -> None:
    """The result, and the target as points on it, each with its band; of a pair of types both in
    its colour."""
    x = table[0]
    for name, own, style in (("result", COLOURS[0], "-"), ("target", INK, ".")):
        own = colour if part else own
        told = any(line.get_label() == "target" for line in ax.lines)  # by another pair's points
        label = part if part and name == "result" else None if told else name
        ax.plot(x, table[name], style, color=own, linewidth=1.4, markersize=3, label=label)
        if name + "_error" in table:
            _band(ax, x, table[name], table[name + "_error"], own)
    # g ends at 1, and the place below is free.
    ax.legend(frameon=False, loc="lower right" if table.name.startswith("rdf") else "best")


def _window(table: Table, column: str) -> tuple[float, float] | None:
    """Heights that show the well of a potential, not its core."""
    y = table[column][np.isfinite(table[column])]
    depth = -float(y.min()) if len(y) else 0.0
    if column != "phi" or depth < 1e-4 * float(np.abs(y).max(initial=0.0)):
        return None
    return -1.5 * depth, 3 * depth


def draw_table(table: Table, ax: Any = None, part: str = "", colour: str = "") -> Any:
    """Lines of a table over its first column; a column "x_error" is the band of "x". That of a
    pair of types, `part`, may have a colour."""
    if len(table.columns) < 2:
        raise InputError(f"{table.name}: a table of one column is no figure")
    ax = _axes(ax)
    x = table[0]
    values = [name for name in table.columns[1:]
              if "error" not in name and name not in ("force", "vectors")]
    if "target" in table and "result" in table:
        _draw_compared(table, ax, part, colour)
    else:
        if "phi" in values or "omega" in values:
            values = values[:1]
        first = len(ax.lines)
        for k, name in enumerate(values[:_MOST_LINES]):
            own = colour or COLOURS[(first + k) % len(COLOURS)]
            ax.plot(x, table[name], color=own, linewidth=1.6,
                    label=part or _SYMBOLS.get(name, name))
            if name + "_error" in table:
                _band(ax, x, table[name], table[name + "_error"], own)
        if len(values) > 1 or part:
            ax.legend(frameon=False)
        window = _window(table, values[0]) if values else None
        if window is not None:
            low, high = window if ax.get_autoscaley_on() else ax.get_ylim()  # of other pairs
            ax.set_ylim(min(low, window[0]), max(high, window[1]))
            begin = 0.9 * float(x[table[values[0]] < 2 * ax.get_ylim()[1]].min())  # not the core
            ax.set_xlim(left=begin if first == 0 else min(ax.get_xlim()[0], begin))
    name = values[0] if values else table.columns[1]
    unit = table.unit(name)
    label = _SYMBOLS.get(name, name)
    if name == "target":
        label = _SYMBOLS["g"] if table.name.startswith("rdf") else table.name
    _style(ax, table, label + (f" / {unit}" if unit else ""))
    return ax


#: What a person looks at first.
_FIRST = ("rdf", "potential", "omega", "history", "bond_lengths", "msd", "structure_factor")


def _panels(result: "Result") -> dict[str, dict[str, str]]:
    """What makes a figure of the result, at most four: names of tables by pairs of types."""
    found = {first: Curves._parts(first, result.tables) for first in _FIRST}
    return dict([(first, parts) for first, parts in found.items() if parts][:4])


def _draw_history(table: Table, ax: Any) -> None:
    for k, column in enumerate(column for column in ("error", "noise") if column in table):
        ax.semilogy(table[0], table[column], "o-", color=COLOURS[k], label=column, markersize=3)
    ax.legend(frameon=False)
    ax.xaxis.get_major_locator().set_params(integer=True)
    _style(ax, table, "error")


def draw_result(result: "Result") -> Any:
    """A figure of what there is: g with its target, Φ, ω, errors by iteration. A pair of types has
    one colour in all panels."""
    panels = _panels(result)
    if not panels:
        raise InputError(f"{result.folder}: no table that makes a figure")
    pairs = list(dict.fromkeys(part for parts in panels.values() for part in parts))
    pyplot = _pyplot()
    rows, columns = math.ceil(len(panels) / 2), min(2, len(panels))
    figure, axes = pyplot.subplots(rows, columns, figsize=(4.6 * columns, 3.2 * rows),
                                   squeeze=False, layout="constrained")
    for ax in axes.flat[len(panels):]:
        ax.set_visible(False)
    for ax, (first, parts) in zip(axes.flat, panels.items()):
        for part, name in list(parts.items())[:_MOST_LINES]:
            if name == "history":
                _draw_history(result.table(name), ax)
            else:
                colour = COLOURS[pairs.index(part) % len(COLOURS)] if part else ""
                draw_table(result.table(name), ax, part, colour)
        ax.set_title(first, fontsize="medium")
    return figure


def _number(value: float, error: float | None) -> str:
    if error is None or not math.isfinite(error) or error <= 0:
        return f"{value:.5g}"
    digits = max(0, 1 - math.floor(math.log10(error)))
    return f"{value:.{digits}f} ± {error:.{digits}f}" if digits < 12 else f"{value:.5g} ± {error:.2g}"


def _figure_html(result: "Result") -> str:
    """The figure as an image, or nothing where there is no matplotlib."""
    try:
        figure = draw_result(result)
    except (ImportError, InputError):
        return ""
    image = io.BytesIO()
    figure.savefig(image, format="png", dpi=110)
    _pyplot().close(figure)
    return f'<img src="data:image/png;base64,{base64.b64encode(image.getvalue()).decode()}">'


def show_result(result: "Result") -> str:
    """Verdict, numbers with their errors, and the figure."""
    summary = result.summary
    reason = f": {html.escape(result.reason)}" if result.reason else ""
    rows = []
    for key, value in summary.items():
        if isinstance(value, (int, float)) and not isinstance(value, bool) and not (
                "error" in key or key in ("threads", "seed")):
            rows.append(f"<tr><td>{html.escape(key)}</td>"
                        f"<td>{_number(value, summary.get(key + '_error'))}</td></tr>")
    return (f"<div><b>{html.escape(result.kind)}: {html.escape(result.status)}</b>{reason}"
            f"<br><small>{html.escape(str(result.folder))}</small></div>{_figure_html(result)}"
            f"<details><summary>numbers</summary><table>{''.join(rows)}</table></details>")
