"""Records: results whose fields say what they are, and the forms in which they are handed out."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field, fields
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np

from ..errors import InvalidValue, Mistake
from . import notebook
from .arguments import names_arguments
from .plain_data import plain_data

if TYPE_CHECKING:
    import pandas
    import xarray
    from numpy.typing import NDArray

__all__ = ["Column", "MappedRecord", "Record", "StateRecord", "column", "declared_columns"]

MOST_SHOWN = 6
"""States that a notebook shows; of more the first and the last."""


class Column(NamedTuple):
    """One number of every state.

    Examples
    --------
    >>> import thirdbody as tb
    >>> tb.outputs.Friction.columns["mu"]
    Column(symbol='μ', unit='1', meaning='coefficient of friction')
    """

    symbol: str
    """As in figures."""
    unit: str
    """SI, "1" for none."""
    meaning: str
    """In words."""

    @property
    def labels(self) -> dict[str, str]:
        """Attributes of the column in a data set."""
        return {"units": self.unit, "long_name": self.meaning, "symbol": self.symbol}


def column(symbol: str, unit: str, meaning: str) -> Any:
    """A field of a result that is a column."""
    return field(metadata={"column": Column(symbol, unit, meaning)})


def declared_columns(kind: type) -> Mapping[str, Column]:
    """The columns that a class declares, by name."""
    every = {item.name: item.metadata.get("column") for item in fields(kind)}
    return {name: column for name, column in every.items() if column is not None}


class Record:
    """A result: a frozen dataclass that is handed out as plain data."""

    __slots__ = ()
    not_in_dict: ClassVar[tuple[str, ...]] = ("contact",)
    """Fields that `to_dict` leaves out."""

    def to_dict(self) -> dict[str, object]:
        """Every field, ready for JSON: None for what is not a finite number, lists for arrays."""
        names = (item.name for item in fields(self))  # type: ignore[arg-type]
        kept = (name for name in names if name not in self.not_in_dict)
        return {name: plain_data(getattr(self, name)) for name in kept}


class MappedRecord(Record, Mapping[str, Any]):
    """A record that is read by attribute, and indexed as its plain data."""

    @cached_property
    def _data(self) -> dict[str, Any]:
        return self.to_dict()

    def __getitem__(self, key: str) -> Any:
        return self._data[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._data)

    def __len__(self) -> int:
        return len(self._data)


class StateRecord(Record):
    """A result with columns, one number of each for every state.

    A subclass declares them with `column`; ``outputs``, where it has such a field, holds more
    of them by name.
    """

    __slots__ = ()
    warnings: tuple[str, ...] = ()

    @names_arguments
    def about(self, name: str) -> Column:
        """Symbol, unit and meaning of a column."""
        columns = declared_columns(type(self))
        if name not in columns:
            raise InvalidValue(
                f"name = {name!r} must be one of {', '.join(columns)}", code=Mistake.OPTION
            )
        return columns[name]

    def columns(self) -> dict[str, NDArray[Any]]:
        """Every column as a 1-D array, those of the outputs last."""
        stored = {name: getattr(self, name) for name in declared_columns(type(self))}
        every = stored | dict(getattr(self, "outputs", {}))
        return {name: np.atleast_1d(values) for name, values in every.items()}

    def to_dict(self) -> dict[str, object]:
        """Every column as a list, ready for JSON: None for what is not a finite number."""
        return plain_data(self.columns())

    def attributes(self) -> dict[str, str]:
        """Attributes of a data set that hold for all its states."""
        return {"warnings": "\n".join(self.warnings)}

    def more_variables(self) -> tuple[dict[str, object], dict[str, object]]:
        """Variables of a data set beside the columns, and their coordinates."""
        return {}, {}

    def to_dataset(self, *, title: str = "") -> xarray.Dataset:
        """The states as labelled data, one along the dimension ``state``.

        Parameters
        ----------
        title : str, optional
            What the data are of; kept with them.

        Returns
        -------
        xarray.Dataset
            Every column with ``units``, ``long_name`` and ``symbol``; title and warnings as
            attributes, of an `Equilibrium` inputs, version, engine and citations too. What each of
            several populations carries has the dimension ``population`` too.

        Examples
        --------
        >>> import thirdbody as tb
        >>> steel = tb.materials["S45C"]
        >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
        ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
        >>> data = tb.solve(contact, pressure=[1e6, 5e6]).to_dataset(title="Two loads")
        >>> data.A_t.dims, data.pressure.units, data.title
        (('state',), 'Pa', 'Two loads')
        """
        import xarray

        data = {n: ("state", v, self.about(n).labels) for n, v in self.columns().items()}
        more, coords = self.more_variables()
        attributes = {"title": title} | self.attributes()
        return xarray.Dataset(data | more, coords=coords, attrs=attributes)

    def to_dataframe(self) -> pandas.DataFrame:
        """The states as a pandas table, one a row; units and symbols in ``attrs``.

        Returns
        -------
        pandas.DataFrame
            Every column. ``attrs["units"]``, ``attrs["symbol"]`` and ``attrs["long_name"]`` say
            of each what it is.

        Raises
        ------
        ImportError
            Pandas is not installed.

        Examples
        --------
        >>> import thirdbody as tb
        >>> steel = tb.materials["S45C"]
        >>> contact = tb.Contact(surfaces=tb.MaterialPair(steel, steel),
        ...                      roughness=tb.Roughness(sigma=100e-9, R=2.8e-6))
        >>> table = tb.solve(contact, pressure=[1e6, 5e6]).to_dataframe()
        >>> table["mode"].tolist(), table.attrs["units"]["pressure"]
        (['s-s', 's-s'], 'Pa')
        """
        try:
            import pandas
        except ImportError:
            raise ImportError(
                "a table of states needs pandas; install it with pip install pandas, or take "
                "to_dataset()"
            ) from None
        columns = self.columns()
        table = pandas.DataFrame(columns)
        table.index.name = "state"
        for key in ("units", "symbol", "long_name"):
            table.attrs[key] = {name: self.about(name).labels[key] for name in columns}
        return table

    def _repr_html_(self) -> str:
        """A table for notebooks: a row for each column, the first and the last states."""
        columns = {name: (self.about(name), values) for name, values in self.columns().items()}
        rows = [
            notebook.Row(column.symbol or name, _cells(values, column.unit), column.meaning)
            for name, (column, values) in columns.items()
        ]
        count = len(next(iter(self.columns().values())))
        states = "1 state" if count == 1 else f"{count} states"
        return notebook.card(f"{type(self).__name__}, {states}", rows, self.warnings)


def _cells(values: NDArray[Any], unit: str) -> list[str]:
    """Values of some states in words."""
    words = [notebook.words_of(value, unit) for value in values[:MOST_SHOWN]]
    if len(values) <= MOST_SHOWN:
        return words
    half = MOST_SHOWN // 2
    return [*words[:half], "…", *(notebook.words_of(v, unit) for v in values[-half:])]
