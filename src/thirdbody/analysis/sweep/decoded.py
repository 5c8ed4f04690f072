"""The data of a folder as those in memory: words for codes, made when they are used."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from xarray import Variable
from xarray.backends import BackendArray
from xarray.core.indexing import IndexingSupport, LazilyIndexedArray, explicit_indexing_adapter

from ...equilibrium.columns import CODE, MODE_OF_CODE
from ...equilibrium.status import FIELD_SENTENCES, SENTENCES, STATUS_CODE
from .folder import Folder
from .plan import Plan

if TYPE_CHECKING:
    import xarray
    from xarray.core.indexing import ExplicitIndexer

__all__ = ["open_as_in_memory"]

Place = tuple[int | slice | NDArray[np.intp], ...]
Codes = NDArray[np.int8 | np.int16]
Decode = Callable[[Codes], NDArray[np.generic]]


class _Decoded(BackendArray):  # type: ignore[misc, unused-ignore]
    """Array whose values are made of those of another when they are asked for."""

    def __init__(self, stored: Variable, dtype: np.dtype, decode: Decode):
        self.shape, self.dtype = stored.shape, dtype
        self.stored, self.decode = stored, decode

    def __getitem__(self, key: ExplicitIndexer) -> NDArray[np.generic]:
        return explicit_indexing_adapter(key, self.shape, IndexingSupport.OUTER, self._read)

    def _read(self, place: Place) -> NDArray[np.generic]:
        return np.asarray(self.decode(np.asarray(self.stored[place].values)), self.dtype)


def open_as_in_memory(folder: Folder, plan: Plan) -> xarray.Dataset:
    """The data of a finished folder, with the variables, types and attributes of those in memory.

    Of states that share a code, `status` is the sentence that all of them share.
    """
    data, summary = folder.open(), folder.finished_summary
    sentences = SENTENCES
    if plan.contact.asperity_law.of_surface:
        sentences = FIELD_SENTENCES
    if summary is not None and not summary["unsolved"]:
        sentences = SENTENCES[:1]
    made = {}
    if "mode" in data.data_vars:
        made["mode"] = _put_in_words(data["mode"].variable, MODE_OF_CODE.tolist())
    if "iterations" in data.data_vars:
        stored, kind = data["iterations"].variable, np.dtype(np.int64)
        made["iterations"] = _make_lazy(stored, kind, _keep_values)
    if "status" in data.data_vars:
        codes = data["status"].variable
        made["status"] = _put_in_words(codes, sentences.tolist())
        made[CODE] = codes.copy(deep=False)
        made[CODE].attrs, made[CODE].encoding = STATUS_CODE.attributes, {}
    return data.assign(made)


def _look_up(table: NDArray[np.str_], codes: Codes) -> NDArray[np.str_]:
    return table.take(codes)


def _keep_values(values: Codes) -> Codes:
    return values


def _put_in_words(codes: Variable, words: Sequence[str]) -> Variable:
    """Codes as the words that they stand for."""
    table = np.array(words)
    return _make_lazy(codes, table.dtype, partial(_look_up, table))


def _make_lazy(stored: Variable, dtype: np.dtype, decode: Decode) -> Variable:
    """A variable made of a stored one, without what its attributes say of codes."""
    attrs = {name: value for name, value in stored.attrs.items() if not name.startswith("flag_")}
    return Variable(stored.dims, LazilyIndexedArray(_Decoded(stored, dtype, decode)), attrs)
