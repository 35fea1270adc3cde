# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of results: columns with names and units."""

from __future__ import annotations

import html
import re
from collections.abc import Container, ItemsView, Iterator, KeysView
from typing import Any

import numpy as np

from ._errors import InputError
from ._library import Array


class Table:
    """Numbers in columns, as a table of a folder has them.

    Attributes
    ----------
    name : str
    columns : tuple of str
        Names of the columns.
    units : tuple of str
        Of each column; "" of pure numbers.
    values : array, shape (rows, columns)
        Read-only, without a copy of what the library has read.
    comment : str
        What stands above the heading of the file.

    Notes
    -----
    ``table["g"]`` or ``table[1]`` is a column, shape (rows,); InputError where there is none.
    ``len(table)`` is its rows, ``numpy.asarray(table)`` its values.
    """

    def __init__(self, name: str, columns: tuple[str, ...], units: tuple[str, ...],
                 values: Array, comment: str = "") -> None:
        self.name, self.columns, self.units = name, columns, units
        self.values, self.comment = values, comment

    def _number(self, column: str | int) -> int:
        if isinstance(column, (int, np.integer)):
            if not -len(self.columns) <= column < len(self.columns):
                raise InputError(f"{self.name}: there is no column {column}")
            return int(column)
        if column not in self.columns:
            raise InputError(f"{self.name}: no column \"{column}\"; there are "
                             f"{', '.join(self.columns)}")
        return self.columns.index(column)

    def __getitem__(self, column: str | int) -> Array:
        """A column, by its name or its number from 0 on: shape (rows,)."""
        return self.values[:, self._number(column)]

    def __contains__(self, column: object) -> bool:
        return column in self.columns

    def __len__(self) -> int:
        return len(self.values)

    def __array__(self, dtype: Any = None, copy: Any = None) -> Array:
        return np.array(self.values, dtype=dtype) if copy else np.asarray(self.values, dtype=dtype)

    def unit(self, column: str | int) -> str:
        """Unit of a column.

        Parameters
        ----------
        column : str or int

        Returns
        -------
        str
            "" of pure numbers.

        Raises
        ------
        InputError
            There is no such column.
        """
        return self.units[self._number(column)]

    def label(self, column: str | int) -> str:
        """A column with its unit, as "r [nm]".

        Parameters
        ----------
        column : str or int

        Returns
        -------
        str

        Raises
        ------
        InputError
            There is no such column.
        """
        number = self._number(column)
        unit = self.units[number]
        return self.columns[number] + (f" [{unit}]" if unit not in ("", "1") else "")

    def to_dict(self) -> dict[str, Array]:
        """Columns by their names.

        Returns
        -------
        dict of str to array, shape (rows,)
        """
        return {name: self.values[:, k] for k, name in enumerate(self.columns)}

    def to_pandas(self) -> Any:
        """A DataFrame of pandas, units in its ``attrs["units"]``.

        Returns
        -------
        pandas.DataFrame
            A copy.

        Raises
        ------
        ImportError
            There is no pandas.
        """
        import pandas

        frame = pandas.DataFrame(np.array(self.values), columns=list(self.columns))
        frame.attrs["units"] = dict(zip(self.columns, self.units))
        return frame

    def plot(self, ax: Any = None) -> Any:
        """Draw it with matplotlib.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where; else in a figure of its own.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        ImportError
            There is no matplotlib.
        InputError
            It has one column alone.
        """
        from . import _plot

        return _plot.draw_table(self, ax)

    def __reduce__(self) -> Any:
        return Table, (self.name, self.columns, self.units, np.array(self.values), self.comment)

    def __repr__(self) -> str:
        names = ", ".join(self.label(k) for k in range(min(8, len(self.columns))))
        more = ", …" if len(self.columns) > 8 else ""
        return f"<Table {self.name}: {len(self)} rows of {names}{more}>"

    def _repr_html_(self) -> str:
        most, shown = 8, range(min(len(self.columns), 8))
        rows = list(range(len(self)))
        if len(rows) > most:
            rows = [*rows[: most // 2], -1, *rows[-(most // 2):]]
        head = "".join(f"<th>{html.escape(self.label(k))}</th>" for k in shown)
        body = "".join("<tr>" + "".join(
            f"<td>{'…' if row < 0 else format(self.values[row, k], '.6g')}</td>"
            for k in shown) + "</tr>" for row in rows)
        return (f"<table><caption>{html.escape(self.name)}</caption><tr>{head}</tr>{body}</table>")


#: Names of tables behind that of a curve which are no pair of types.
_OTHERS = re.compile(r"(^|_)(history|flat|lower|upper)$|^now(_|$)")


def named(name: Any, names: Container[str]) -> Any:
    """A name as `names` has it: "rdf_B-A" may be "rdf_A-B"."""
    if not isinstance(name, str) or name in names:
        return name
    tail = "".join(re.findall(r"_(?:history|flat|lower|upper)$", name))
    body = name.removesuffix(tail)
    for begin in [0, *(found.end() for found in re.finditer("_", body))]:
        words = body[begin:].split("-")
        for n in range(1, len(words)):  # types may have such a stroke in their names
            turned = body[:begin] + "-".join(words[n:] + words[:n]) + tail
            if turned in names:
                return turned
    return name


class Curves:
    """Curves of one kind: a table for each pair of types, by the name "A-B"; "" of beads that are
    alike. A single one has its values, columns, units, plot and conversions directly.

    Notes
    -----
    ``curves["A-B"]``, or ``curves["B-A"]``, is a `Table`, and ``for name, table in curves.items()`` has all of them. Of a
    single one ``curves["phi"]`` is a column, shape (rows,), and ``numpy.asarray(curves)`` its
    values.
    """

    def __init__(self, name: str, tables: dict[str, Table]) -> None:
        self.name, self._tables = name, tables

    @staticmethod
    def _parts(name: str, tables: tuple[str, ...]) -> dict[str, str]:
        """Parts by the names of the tables of a curve."""
        found = {}
        for table in tables:
            part = table[len(name) + 1:]
            if table == name or (table.startswith(name + "_") and not _OTHERS.search(part)):
                found[part] = table  # under "" the only one
        return found

    @property
    def table(self) -> Table:
        """The only table; InputError where there are several."""
        if len(self._tables) != 1:
            raise InputError(f"{self.name}: there are {len(self._tables)}: "
                             f"{', '.join(self._tables)}")
        return next(iter(self._tables.values()))

    @property
    def values(self) -> Array:
        """Those of the only table, shape (rows, columns)."""
        return self.table.values

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the columns of the only table, a tuple of str."""
        return self.table.columns

    @property
    def units(self) -> tuple[str, ...]:
        """Units of the columns of the only table, a tuple of str."""
        return self.table.units

    def __array__(self, dtype: Any = None, copy: Any = None) -> Array:
        return self.table.__array__(dtype, copy)

    def to_dict(self) -> dict[str, Array]:
        """Columns of the only table by their names.

        Returns
        -------
        dict of str to array, shape (rows,)

        Raises
        ------
        InputError
            There are several.
        """
        return self.table.to_dict()

    def to_pandas(self) -> Any:
        """The only table as a DataFrame of pandas, units in its ``attrs["units"]``.

        Returns
        -------
        pandas.DataFrame
            A copy.

        Raises
        ------
        ImportError
            There is no pandas.
        InputError
            There are several.
        """
        return self.table.to_pandas()

    def __getitem__(self, part: str) -> Table | Any:
        if named(part, self._tables) in self._tables:
            return self._tables[named(part, self._tables)]
        if len(self._tables) == 1:
            return self.table[part]
        raise InputError(f"{self.name}: no \"{part}\"; there are {', '.join(self._tables)}")

    def __iter__(self) -> Iterator[str]:
        return iter(self._tables)

    def __contains__(self, part: object) -> bool:
        if named(part, self._tables) in self._tables:
            return True
        return len(self._tables) == 1 and part in self.table

    def keys(self) -> KeysView[str]:
        """Names of the pairs of types.

        Returns
        -------
        keys of a dict
        """
        return self._tables.keys()

    def items(self) -> ItemsView[str, Table]:
        """Pairs of types with their tables.

        Returns
        -------
        items of a dict
        """
        return self._tables.items()

    def __len__(self) -> int:
        return len(self._tables)

    def plot(self, ax: Any = None) -> Any:
        """Draw all of them with matplotlib.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where; else in a figure of its own.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        ImportError
            There is no matplotlib.
        """
        from . import _plot

        for part, table in self._tables.items():
            ax = _plot.draw_table(table, ax, part)
        return ax

    def __repr__(self) -> str:
        parts = ", ".join(part or "all beads" for part in self._tables)
        return f"<{self.name} of {parts}>"

    def _repr_html_(self) -> str:
        return "".join(table._repr_html_() for table in self._tables.values())
