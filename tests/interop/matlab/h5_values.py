"""Prints a dataset, or an attribute, for h5_values.m.

usage: h5_values.py FILE OBJECT [ATTRIBUTE]
"""

import sys

import h5py
import numpy as np


def main(path, name, attribute=""):
    with h5py.File(path) as file:
        values = np.asarray(file[name].attrs[attribute] if attribute else file[name][()])
    numbers = values.dtype.kind in "fiu"
    print("number" if numbers else "text")
    print(*reversed(values.shape))
    for value in values.ravel():
        print(repr(value.item()) if numbers else value.decode() if isinstance(value, bytes) else value)


if __name__ == "__main__":
    main(*sys.argv[1:])
