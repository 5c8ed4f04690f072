"""Records: results whose fields say what they are, and the forms in which they are handed out."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import MISSING, field, fields
from functools import cached_property
from types import MappingProxyType, MethodType
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, TypeAlias

import numpy as np

from ..errors import InvalidValue, Mistake, note_data
from ..version import __version__
from .alike import has_same_fields, hash_of_fields
from .arguments import names_arguments
from .nearest import ValuesByName, no_attribute_of
from .notebook import Card, Row, Shown, words_of
from .plain_data import plain_data

if TYPE_CHECKING:
    import pandas
    import xarray
    from numpy.typing import ArrayLike, NDArray

__all__ = [
    *("NOTES", "VERSION", "Column", "Entry", "MappedRecord", "Record", "StateRecord"),
    *("TableRecord", "Variable", "column", "declared_columns", "flags_of", "with_names"),
]

MOST_SHOWN = 6
"""States that a notebook shows; of more the first and the last."""

Entry: TypeAlias = "str | tuple[str, str | Callable[..., object] | tuple[Entry, ...]]"
"""A key of plain data, and where its value is from.

A name alone is both. Else the value is at a dotted path, whose methods are called; or made by a
function of the record; or a dict of entries of its own. Under the key "" stand the items of a
mapping, each with a key of its own. A key that comes again stands where it comes last.
"""

INSIDE = frozenset(
    {
        *("in_dict", "not_in_dict", "in_columns", "along", "more_columns"),
        *("variables", "coordinates", "attributes"),
    }
)
"""Names by which records are made and rooms read them; nobody else is shown them."""

VERSION: Entry = ("version", lambda record: __version__)
"""The version of the library."""
NOTES: Entry = ("notes", lambda record: [note_data(warning) for warning in record.warnings])
"""The warnings taken apart, for programs that read no sentences."""


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
        """What the column is, in the words of a data set."""
        return {"units": self.unit, "long_name": self.meaning, "symbol": self.symbol}

    @property
    def attributes(self) -> dict[str, object]:
        """Attributes of the column in a data set: its labels, and what its codes mean."""
        return {**self.labels}


NOTHING_SAID = Column("", "", "")


def flags_of(words: Sequence[str]) -> dict[str, object]:
    """Attributes of a variable of codes 0, 1, 2 ... that say what each means (CF conventions).

    >>> flags_of(["ok", "jump"])
    {'flag_values': [0, 1], 'flag_meanings': 'ok jump'}
    """
    return {"flag_values": list(range(len(words))), "flag_meanings": " ".join(words)}


class Variable(NamedTuple):
    """What a data set holds under one name: values along dimensions, and their labels."""

    dims: tuple[str, ...]
    values: ArrayLike
    labels: Mapping[str, object] = MappingProxyType({})

    @property
    def array(self) -> NDArray[np.generic]:
        """The values as an array."""
        return np.asarray(self.values)

    @property
    def unit(self) -> str:
        """SI, "" where nothing is said."""
        return str(self.labels.get("units", ""))

    @property
    def meaning(self) -> str:
        """In words."""
        return str(self.labels.get("long_name", ""))


def column(
    symbol: str, unit: str, meaning: str, *, default: object = MISSING, repr: bool = True
) -> Any:
    """A field of a result that is a column."""
    about = {"column": Column(symbol, unit, meaning)}
    return field(default=default, repr=repr, metadata=about)


def declared_columns(kind: type) -> Mapping[str, Column]:
    """The columns that a class declares, by name."""
    every = {item.name: item.metadata.get("column") for item in fields(kind)}
    return {name: column for name, column in every.items() if column is not None}


class Record(Shown):
    """A result: a frozen dataclass that is handed out as plain data, and shown in a notebook.

    >>> from dataclasses import dataclass
    >>> @dataclass(frozen=True)
    ... class Worn(Record):
    ...     in_dict = ("depth", ("times", (("first", "history.start"),)), ("", "history.more"))
    ...     depth: float
    ...     history: object
    >>> from types import SimpleNamespace
    >>> Worn(float("nan"), SimpleNamespace(start=0.0, more={"sigma": (1.0, 2.0)})).to_dict()
    {'depth': None, 'times': {'first': 0.0}, 'sigma': [1.0, 2.0]}
    """

    __slots__ = ()
    in_dict: ClassVar[tuple[Entry, ...]] = ()
    """What `to_dict` hands out; every field where nothing is said."""
    not_in_dict: ClassVar[tuple[str, ...]] = ("contact",)
    """Fields that `to_dict` leaves out of every field."""

    def __eq__(self, other: object) -> bool:
        """Whether the other is of this kind and holds the same values; NaN is the same as NaN."""
        return has_same_fields(self, other) if type(other) is type(self) else NotImplemented

    def __hash__(self) -> int:
        return hash_of_fields(self)

    def __dir__(self) -> list[str]:
        """What a user reads: without the names by which its forms are made."""
        return sorted({*object.__dir__(self)} - INSIDE)

    if not TYPE_CHECKING:  # which would take every name for an attribute

        def __getattr__(self, name: str) -> object:
            """No attribute: an error that asks for the name that was probably meant."""
            kind = type(self)
            if name.startswith("_") or hasattr(kind, name):  # a property that raised, a copy
                return object.__getattribute__(self, name)
            names = (option for option in dir(self) if not option.startswith("_"))
            outputs = getattr(self, "outputs", ()) if hasattr(kind, "outputs") else ()
            raise AttributeError(no_attribute_of(kind.__name__, name, names, outputs))

    def to_dict(self) -> dict[str, Any]:
        """Everything, ready for JSON: None for what is not a finite number, lists for arrays."""
        names = (item.name for item in fields(self))  # type: ignore[arg-type]
        kept = (name for name in names if name not in self.not_in_dict)
        return _plain_entries(self, self.in_dict or tuple(kept))

    def _cards(self) -> Iterator[Card]:
        """A table for notebooks: a row for each number or word that `to_dict` hands out."""
        columns = declared_columns(type(self))
        rows = [
            Row(about.symbol or name, _words_of_plain(value, about.unit), about.meaning)
            for name, value in self.to_dict().items()
            for about in (columns.get(name, NOTHING_SAID),)
        ]
        yield Card(type(self).__name__, rows, getattr(self, "warnings", ()))


def _plain_entries(record: Record, entries: tuple[Entry, ...]) -> dict[str, object]:
    """Plain data of a record."""
    out: dict[str, object] = {}
    for entry in entries:
        key, source = (entry, entry) if isinstance(entry, str) else entry
        if isinstance(source, str):
            value = plain_data(_value_at(record, source))
        elif isinstance(source, tuple):
            value = _plain_entries(record, source)
        else:
            value = plain_data(source(record))
        for name, plain in ({key: value} if key else value).items():
            out.pop(name, None)
            out[name] = plain
    return out


def _value_at(record: object, path: str) -> object:
    """The value at a dotted path; methods on the way are called."""
    for name in path.split("."):
        value = getattr(record, name)
        record = value() if isinstance(value, MethodType) else value
    return record


def with_names(path: str) -> Callable[[Record], object]:
    """A source of an `Entry`: one named tuple, or some, as dicts; None stays."""

    return lambda record: _as_dicts(_value_at(record, path))


def _as_dicts(value: object) -> object:
    if hasattr(value, "_asdict"):
        return value._asdict()
    return [_as_dicts(item) for item in value] if isinstance(value, (list, tuple)) else value


class MappedRecord(Record, Mapping[str, Any]):
    """A record that is read by attribute, and indexed as its plain data.

    As a mapping it is equal to whatever has the same plain data.
    """

    __eq__ = Mapping.__eq__
    __hash__ = None  # type: ignore[assignment]

    @cached_property
    def _data(self) -> dict[str, object]:
        return ValuesByName(self.to_dict())

    def __getitem__(self, key: str) -> Any:
        return self._data[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._data)

    def __len__(self) -> int:
        return len(self._data)


class TableRecord(Record):
    """A result that is handed out as labelled data and as a table too.

    They hold what a subclass declares with `column`, or what its `variables` are.
    """

    __slots__ = ()
    in_columns: ClassVar[tuple[str, ...]] = ()
    """Dimensions along which a table has columns, not rows: ``name[place]``."""
    along: ClassVar[str] = "state"
    """Dimension of the declared columns, and the column of its places, where there is one."""
    more_columns: ClassVar[Mapping[str, Column]] = MappingProxyType({})
    """Columns that come last, each an attribute of the record."""

    def variables(self) -> Mapping[str, Variable]:
        """What there is along the dimensions, by name."""
        out: dict[str, Variable] = {}
        for name, about in {**declared_columns(type(self)), **self.more_columns}.items():
            value = getattr(self, name)
            values = np.asarray(np.nan if value is None else value)
            if name != self.along:
                out[name] = Variable((self.along,)[: values.ndim], values, about.attributes)
        return out

    def coordinates(self) -> Mapping[str, Variable]:
        """The places along the dimensions, and what is said of each place."""
        about = declared_columns(type(self)).get(self.along)
        if about is None:
            return {}
        return {self.along: Variable((self.along,), getattr(self, self.along), about.attributes)}

    def attributes(self) -> Mapping[str, object]:
        """Attributes of a data set that hold for all of it."""
        return {"warnings": "\n".join(getattr(self, "warnings", ()))}

    @names_arguments
    def to_dataset(self, *, title: str = "") -> xarray.Dataset:
        """The result as labelled data; states lie along the dimension ``state``.

        Parameters
        ----------
        title : str, optional
            What the data are of; kept with them.

        Returns
        -------
        xarray.Dataset
            Every column with ``units``, ``long_name`` and ``symbol``; title and warnings as
            attributes, of a result that knows its contact inputs, version and citations too. What
            each of several populations carries has the dimension ``population`` too. The column
            ``status_code`` says in ``flag_meanings`` what its numbers mean.

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

        attributes = {"title": title or getattr(self, "title", ""), **self.attributes()}
        return xarray.Dataset(self.variables(), coords=self.coordinates(), attrs=attributes)

    def to_dataframe(self) -> pandas.DataFrame:
        """The result as a pandas table, one state a row; units and symbols in ``attrs``.

        Returns
        -------
        pandas.DataFrame
            Every column; of what has places beside each other, as populations, one for each:
            ``population_A_sa[dust]``. ``attrs["units"]``, ``attrs["symbol"]`` and
            ``attrs["long_name"]`` say of each what it is.

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
            import pandas  # noqa: F401
        except ImportError:
            raise ImportError(
                "a table of states needs pandas; install it with pip install pandas, or take "
                "to_dataset()"
            ) from None
        data = self.to_dataset()
        for dim in (dim for dim in self.in_columns if dim in data.dims):
            along = [name for name, values in data.data_vars.items() if dim in values.dims]
            single = {
                f"{name}[{place}]": data[name].sel({dim: place}, drop=True)
                for name in along
                for place in data[dim].values
            }
            data = data.drop_vars(along).drop_dims(dim).assign(single)
        table: pandas.DataFrame = data.to_dataframe()
        for key in ("units", "symbol", "long_name"):
            table.attrs[key] = {name: data[name].attrs.get(key, "") for name in table.columns}
        return table

    def _cards(self) -> Iterator[Card]:
        """A table for notebooks: a row for each column, the first and the last places."""
        every = {**self.coordinates(), **self.variables()}
        dims = [dim for variable in every.values() for dim in variable.dims]
        dim = self.along if self.along in dims else dims[0]
        shown = {name: one for name, one in every.items() if one.dims in ((), (dim,))}
        cells = {name: _cells(np.atleast_1d(one.array), one.unit) for name, one in shown.items()}
        width = max(map(len, cells.values()))
        rows = [
            Row(
                str(one.labels.get("symbol") or name),
                cells[name] + [""] * (width - len(cells[name])),
                one.meaning,
            )
            for name, one in shown.items()
        ]
        count = next(np.size(one.values) for one in shown.values() if one.dims)
        places = f"{count} values of {dim}"
        if dim == "state":
            places = "1 state" if count == 1 else f"{count} states"
        yield Card(f"{type(self).__name__}, {places}", rows, getattr(self, "warnings", ()))


class StateRecord(TableRecord):
    """A result with columns, one number of each for every state.

    A subclass declares them with `column`; ``outputs``, where it has such a field, holds more
    of them by name. As plain data a word that is empty is None, as a number that is not finite.
    """

    __slots__ = ()
    in_dict: ClassVar[tuple[Entry, ...]] = (("", "_plain_columns"),)

    @property
    def notes(self) -> tuple[str, ...]:
        """The same as ``warnings``: sentences with ``code``, ``effect`` and ``action``."""
        return tuple(getattr(self, "warnings", ()))

    @names_arguments
    def about(self, name: str) -> Column:
        """Symbol, unit and meaning of a column."""
        columns = {**declared_columns(type(self)), **self.more_columns}
        if name not in columns:
            raise InvalidValue(
                f"name = {name!r} must be one of {', '.join(columns)}", code=Mistake.OPTION
            )
        return columns[name]

    def columns(self) -> dict[str, NDArray[Any]]:
        """Every column as a 1-D array, those of the outputs behind, and `more_columns` last.

        One that a result does not have, which is None, is left out.
        """
        stored = {name: getattr(self, name) for name in declared_columns(type(self))}
        every = stored | dict(getattr(self, "outputs", {}))
        every |= {name: getattr(self, name) for name in self.more_columns}
        return {name: np.ravel(v) for name, v in every.items() if v is not None}

    def _plain_columns(self) -> dict[str, list[object]]:
        """The columns as plain data."""
        columns = plain_data(self.columns()).items()
        return {
            name: [None if value == "" else value for value in values] for name, values in columns
        }

    def variables(self) -> Mapping[str, Variable]:
        """The columns, along ``state``."""
        return {
            name: Variable(("state",), values, self.about(name).attributes)
            for name, values in self.columns().items()
        }


def _words_of_plain(value: object, unit: str) -> list[str]:
    """Plain data in words: each of few, else how many there are."""
    if not isinstance(value, (dict, list)):
        return [words_of(value, unit)]
    inner = list(value.values() if isinstance(value, dict) else value)
    if len(inner) <= MOST_SHOWN and not any(isinstance(item, (dict, list)) for item in inner):
        return [words_of(item, unit) for item in inner]
    return [f"{len(inner)} values"]


def _cells(values: NDArray[Any], unit: str) -> list[str]:
    """Values of some states in words."""
    words = [words_of(value, unit) for value in values[:MOST_SHOWN]]
    if len(values) <= MOST_SHOWN:
        return words
    half = MOST_SHOWN // 2
    return [*words[:half], "…", *(words_of(v, unit) for v in values[-half:])]
