"""Checks any result file of poesy with h5py and xarray only: units, descriptions, named axes, content hash.

usage: check_structure.py RESULT.h5
"""

import hashlib
import struct
import sys

import h5py
import numpy as np
import xarray

BOOKKEEPING = {"CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST"}


def datasets(group):
    for name in group:
        thing = group[name]
        if isinstance(thing, h5py.Dataset):
            yield thing
        else:
            yield from datasets(thing)


def groups(parent, path=""):
    for name in parent:
        if isinstance(parent[name], h5py.Group):
            yield path + name
            yield from groups(parent[name], path + name + "/")


def check_labels(file):
    for dataset in datasets(file):
        where = dataset.name
        assert isinstance(dataset.attrs["unit"], str) and dataset.attrs["unit"], where
        assert isinstance(dataset.attrs["description"], str) and dataset.attrs["description"], where
        if h5py.h5ds.is_scale(dataset.id):
            continue
        for axis, length in enumerate(dataset.shape):
            assert len(dataset.dims[axis]) == 1, f"{where}: axis {axis} has no dimension scale"
            assert dataset.dims[axis][0].shape == (length,), where


def check_xarray(path, file):
    """Every group opens with labelled coordinates for all axes that its group shows."""
    for group in groups(file):
        with xarray.open_dataset(path, engine="h5netcdf", group=group) as opened:
            opened.load()
            for name in [name for name in file[group] if isinstance(file[group][name], h5py.Dataset)]:
                assert name in opened.variables, f"xarray does not see /{group}/{name}"
            if group in ("sensitivity", "sensitivity/history", "solver", "evaluate", "errors", "monte_carlo", "coupling",
                         "sobol", "sobol/aggregated", "sobol/vector", "monte_carlo/main_effect", "machines/largest", "machines/rms", "yield",
                         "allocation", "allocation/stages", "allocation/curve", "allocation/certificate", "limits"):
                for dimension in opened.dims:
                    assert dimension in opened.coords, f"/{group} shows no names for {dimension}"


class Hash:
    """The definition in engine/storage/content_hash.h, once more."""

    def __init__(self, file):
        self.sha = hashlib.sha256()
        self.object("/", file)

    def number(self, value):
        self.sha.update(struct.pack("<Q", value))

    def text(self, value):
        value = value.encode() if isinstance(value, str) else value
        self.number(len(value))
        self.sha.update(value)

    def value(self, values):
        values = np.asarray(values)
        kind = {"f": "float", "i": "int", "u": "uint"}.get(values.dtype.kind, "text")
        self.text(kind)
        self.number(0 if kind == "text" else values.dtype.itemsize)
        self.number(values.ndim)
        for length in values.shape:
            self.number(length)
        if kind == "text":
            for text in values.ravel():
                self.text(text)
            return
        values = values.astype(values.dtype.newbyteorder("<"))
        if kind == "float":
            values[np.isnan(values)] = np.nan
            assert values.size == 0 or np.array(np.nan).view("u8") == 0x7FF8000000000000
        self.sha.update(values.tobytes())

    def object(self, path, thing):
        group = isinstance(thing, h5py.Group)
        self.text(path)
        self.text("group" if group else "dataset")
        if not group:
            self.value(thing[()])
        left_out = BOOKKEEPING | ({"content_sha256"} if path == "/" else set())
        names = sorted((name for name in thing.attrs if name not in left_out), key=str.encode)
        self.number(len(names))
        for name in names:
            self.text(name)
            self.value(thing.attrs[name])
        if group:
            for name in sorted(thing, key=str.encode):
                child = path.rstrip("/") + "/" + name
                if child != "/run":
                    self.object(child, thing[name])


def main(path):
    with h5py.File(path, "r") as file:
        assert file.attrs["filetype"] == "poesy-result"
        assert list(file.attrs["version"]) == [1, 0]
        for name in ("poesy_version", "git_commit", "kind", "model", "title"):
            assert isinstance(file.attrs[name], str) and file.attrs[name], name
        assert file["study/text"].asstr()[()].startswith(("#", "format"))
        for name in ("created", "host", "cpu", "threads", "ranks", "wall_seconds", "checkpoint_seconds", "all_samples", "samples_per_second", "solves"):
            assert file["run"][name].shape == (), name
        for name in ("hdf5", "tbb", "eigen", "boost", "openssl", "compiler"):
            assert file["run"].attrs["version_" + name], name
        check_labels(file)
        check_xarray(path, file)
        assert Hash(file).sha.hexdigest() == file.attrs["content_sha256"]


if __name__ == "__main__":
    main(*sys.argv[1:])
