"""Writes files that are not results, or are results of other versions, next to the examples.

usage: make_strangers.py EXAMPLES
"""

import pathlib
import sys

import h5py


def main(examples):
    strangers = (("newer", "poesy-result", [2, 0]), ("older", "poesy-result", [0, 9]), ("stranger", "something-else", [1, 0]))
    for name, filetype, version in strangers:
        with h5py.File(pathlib.Path(examples) / f"{name}.h5", "w") as file:
            file.attrs["filetype"] = filetype
            file.attrs["version"] = version
    h5py.File(pathlib.Path(examples) / "nameless.h5", "w").close()


if __name__ == "__main__":
    main(*sys.argv[1:])
