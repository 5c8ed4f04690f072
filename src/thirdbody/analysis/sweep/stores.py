"""Formats in which a sweep lies on disk."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .plan import Arrays, Box, Layout


# -------------------------------------------------------------------------- stores
class _Zarr:
    """A Zarr store of a layout, in which every block has files of its own."""

    def __init__(self, path: Path, layout: Layout):
        import zarr

        self.path, self.layout = path, layout
        self.group = zarr.open_group(path, mode="r+")
        self.arrays = {name: self.group[name] for name in layout.variables}

    @staticmethod
    def create(path: Path, layout: Layout) -> _Zarr:
        import zarr

        group = zarr.create_group(path, attributes=_labels(layout))
        for name, (dims, kind, attrs) in layout.variables.items():
            dtype = np.dtype(kind)
            group.create_array(
                name,
                shape=tuple(layout.sizes[dim] for dim in dims),
                chunks=tuple(layout.chunks[dim] for dim in dims) if dims else "auto",
                dtype=dtype,
                fill_value=np.nan if dtype.kind == "f" else -1,
                dimension_names=dims,
                attributes=attrs,
            )
        for name, (dims, values, attrs) in layout.coords.items():
            text = values.dtype.kind == "U"
            made = group.create_array(
                name,
                shape=values.shape,
                chunks=values.shape,
                dtype="str" if text else values.dtype,
                dimension_names=dims,
                attributes=attrs,
            )
            made[...] = values.astype(object) if text else values
        return _Zarr(path, layout)

    def write(
        self, where: Mapping[str, slice], arrays: Arrays, *, durable: bool = False
    ) -> list[Path]:
        """Write a block; the files that are its own, where it must survive what follows."""
        files = []
        for name, values in arrays.items():
            dims = self.layout.variables[name][0]
            region = tuple(where.get(dim, slice(None)) for dim in dims)
            if not durable:
                self.arrays[name][region] = values
                continue
            file = self._file(name, dims, region)
            files.append(file)
            file.unlink(missing_ok=True)  # what a killed run left there is not read
            self.arrays[name][region] = values
            if file.exists():  # a block of nothing but NaN has no file
                with file.open("rb+") as written:
                    os.fsync(written.fileno())
        return files

    def _file(self, name: str, dims: tuple[str, ...], region: Box) -> Path:
        """The one file that this block has for a variable."""
        steps = (self.layout.chunks[dim] for dim in dims)
        place = (str(s.start // step) for s, step in zip(region, steps, strict=True))
        return self.path.joinpath(name, "c", *place)

    def label(self, attrs: Mapping[str, object]) -> None:
        import zarr

        self.group.attrs.update(dict(attrs))
        with warnings.catch_warnings():
            # readers of Zarr 3 take it or leave it
            warnings.filterwarnings("ignore", message="Consolidated metadata")
            zarr.consolidate_metadata(self.group.store)

    def close(self) -> None:
        pass


class _NetCDF:
    """A NetCDF-4 file of a layout."""

    def __init__(self, path: Path, layout: Layout):
        import h5netcdf

        self.layout = layout
        self.file = h5netcdf.File(path, "w")

    @staticmethod
    def create(path: Path, layout: Layout) -> _NetCDF:
        import h5py

        out = _NetCDF(path, layout)
        out.file.dimensions = dict(layout.sizes)
        for name, (dims, kind, attrs) in layout.variables.items():
            made = out.file.create_variable(
                name,
                dims,
                np.dtype(kind),
                chunks=tuple(layout.chunks[dim] for dim in dims) or None,
                compression="gzip" if dims else None,
                compression_opts=1 if dims else None,
                shuffle=bool(dims),
            )
            made.attrs.update(_with_bytes_of_codes(attrs))
        for name, (dims, values, attrs) in layout.coords.items():
            text = values.dtype.kind == "U"
            made = out.file.create_variable(
                name, dims, h5py.string_dtype() if text else _number(values).dtype
            )
            made[...] = values.astype(object) if text else _number(values)
            made.attrs.update(_with_bytes_of_codes(attrs))
        out.label(_labels(layout))
        return out

    def write(self, where: Mapping[str, slice], arrays: Arrays) -> None:
        for name, values in arrays.items():
            dims = self.layout.variables[name][0]
            region = tuple(where.get(dim, slice(None)) for dim in dims)
            self.file[name][region or ...] = values

    def label(self, attrs: Mapping[str, object]) -> None:
        self.file.attrs.update(_with_bytes_of_codes(attrs))

    def close(self) -> None:
        self.file.close()


def _labels(layout: Layout) -> dict[str, object]:
    """Attributes of the whole, with the names of the inputs as CF has them."""
    return layout.attrs | {"coordinates": " ".join([*layout.coords, *layout.inputs])}


def _number(values: NDArray[Any]) -> NDArray[Any]:
    """NetCDF has no truth values."""
    return values.astype("i1") if values.dtype.kind == "b" else values


def _with_bytes_of_codes(attrs: Mapping[str, object]) -> dict[str, object]:
    """Lists of codes as the bytes that CF asks for."""
    return {
        key: np.array(value, "i1") if isinstance(value, list) else value
        for key, value in attrs.items()
    }
