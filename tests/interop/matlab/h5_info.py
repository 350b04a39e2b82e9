"""Prints a line for each group at the root of a file, for h5info.m: its path, then the names of its datasets.

usage: h5_info.py FILE
"""

import sys

import h5py


def main(path):
    with h5py.File(path) as file:
        for group in file.values():
            if isinstance(group, h5py.Group):
                print(group.name, *(name for name, thing in group.items() if isinstance(thing, h5py.Dataset)))


if __name__ == "__main__":
    main(*sys.argv[1:])
