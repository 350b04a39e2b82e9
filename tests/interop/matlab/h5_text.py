"""Prints the content of an HDF5 file for h5_contents.m. For each dataset and each attribute of the root: its path
("/@name" for an attribute), a line with the type, a line with the dimensions in reverse order, then each value on a
line.

usage: h5_text.py FILE
"""

import sys

import h5py
import numpy as np


def line(value):
    text = value.decode() if isinstance(value, bytes) else str(value)
    return text.replace("\\", "\\\\").replace("\n", "\\n")


def show(path, values):
    values = np.asarray(values)
    numbers = values.dtype.kind in "fiu"
    print(path)
    print("number" if numbers else "text")
    print(*reversed(values.shape))
    for value in values.ravel():
        print(repr(value.item()) if numbers else line(value))


def show_all(group, path):
    for name, thing in group.items():
        if isinstance(thing, h5py.Group):
            show_all(thing, f"{path}/{name}")
        else:
            show(f"{path}/{name}", thing[()])


def main(path):
    with h5py.File(path) as file:
        for name, value in file.attrs.items():
            show(f"/@{name}", value)
        show_all(file, "")


if __name__ == "__main__":
    main(*sys.argv[1:])
