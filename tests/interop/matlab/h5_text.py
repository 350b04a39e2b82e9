"""Prints what a file holds, for h5_contents.m: of each dataset and of each attribute of the root its path ("/@name" of an
attribute), a line that says the type, one of reversed dimensions, then a value on each line.

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
