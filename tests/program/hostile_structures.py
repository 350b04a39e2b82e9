"""HDF5 files made to harm whoever opens them. Each is a result of poesy with one part replaced.

structures() lists them. Each structure is of one of these sorts:

    outside   links to other files: must be refused with the rule in the message
    tree      too deep, or not only groups and datasets: must be refused with the rule in the message
    shape     any other part that differs from what poesy writes; what is shown then must come from this file
    text      another study or mechanism (hostile_texts.py): refused, or shown with a warning that it was changed
"""

import ctypes
import ctypes.util
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

import h5py
import numpy as np

MARK = "TOP-SECRET-4242424242"  # the content of the secret files; no output may contain it
MARKED_NUMBER = 4242424242.0
NUMBERS = ["sensitivity/local", "sensitivity/global", "sensitivity/count", "poses/alpha", "factors/sigma",
           "tolerances/index", "run/wall_seconds", "solver/not_converged"]
TEXTS = ["study/text", "factors/name", "factors/unit", "responses/description", "factor", "run/host"]
TARGETS = [*NUMBERS, *TEXTS]
GROUPS = ["sensitivity", "poses", "run", "study"]
BIG = 1 << 29  # number of elements: 4 GiB of doubles


@dataclass(frozen=True)
class Structure:
    name: str
    sort: str
    change: Callable  # called with the open h5py.File and the Outside


class Outside:
    """Files beside the hostile ones that these try to read."""

    def __init__(self, folder):
        self.text = Path(folder) / "secret.txt"
        self.text.write_text(MARK * 40000)
        self.numbers = Path(folder) / "secret.bin"
        self.numbers.write_bytes(np.full(20000, MARKED_NUMBER).tobytes())
        self.file = Path(folder) / "secret.h5"
        with h5py.File(self.file, "w") as secret:
            secret["number"] = np.full((12, 60, 3), MARKED_NUMBER)
            secret["text"] = MARK
            secret["texts"] = [MARK] * 60


def clear(file, path):
    if path in file:
        del file[path]


def replaced(path, make):
    """A change that puts something else in a path's place. make(file, path, outside, old dataset's shape)"""
    def change(file, outside):
        shape = file[path].shape if isinstance(file[path], h5py.Dataset) else ()
        clear(file, path)
        make(file, path, outside, shape)
    return change


def each(title, sort, paths, make):
    return [Structure(f"{title} {path}", sort, replaced(path, make)) for path in paths]


def create(file, path, space, kind, properties):
    h5py.h5d.create(file.id, path.encode(), kind, space, properties)


def simple(shape):
    return h5py.h5s.create_simple(shape) if shape else h5py.h5s.create(h5py.h5s.SCALAR)


# Values that are stored outside of the file


def external(kind, name, pieces=1):
    def make(file, path, outside, shape):
        properties = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        size = int(np.prod(shape, dtype=int)) * kind.get_size()
        for piece in range(pieces):
            length = -(-size // pieces)
            properties.set_external(str(getattr(outside, name, name)).encode(), piece * length, length)
        create(file, path, simple(shape), kind, properties)
    return make


def virtual(source, dataset):
    def make(file, path, outside, shape):
        layout = h5py.VirtualLayout(shape=shape or (1,), dtype="f8")
        name = str(getattr(outside, source, source))
        layout[...] = h5py.VirtualSource(name, dataset, shape=shape or (1,))
        file.create_virtual_dataset(path, layout, fillvalue=7.0)
    return make


def external_link(source, target):
    def make(file, path, outside, _):
        file[path] = h5py.ExternalLink(str(getattr(outside, source, source)), target)
    return make


def soft_link(target):
    def make(file, path, _, __):
        file[path] = h5py.SoftLink(target)
    return make


class LinkClass(ctypes.Structure):
    """H5L_class_t of HDF5 1.10: a kind of link that a program registers."""
    Traverse = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_char_p, ctypes.c_int64, ctypes.c_void_p, ctypes.c_size_t,
                                ctypes.c_int64)
    _fields_ = [("version", ctypes.c_int), ("id", ctypes.c_int), ("comment", ctypes.c_char_p),
                ("create", ctypes.c_void_p), ("move", ctypes.c_void_p), ("copy", ctypes.c_void_p),
                ("traverse", Traverse), ("delete", ctypes.c_void_p), ("query", ctypes.c_void_p)]


TRAVERSE = LinkClass.Traverse(lambda *_: -1)


def own_link(file, path, outside, _):
    number = 187
    library = ctypes.CDLL(ctypes.util.find_library("hdf5_serial") or ctypes.util.find_library("hdf5"))
    assert library.H5Lregister(ctypes.byref(LinkClass(version=0, id=number, traverse=TRAVERSE))) >= 0
    value = str(outside.text).encode()
    assert library.H5Lcreate_ud(ctypes.c_int64(file.id.id), path.encode(), number, value,
                                ctypes.c_size_t(len(value)), ctypes.c_int64(0), ctypes.c_int64(0)) >= 0


def filtered(number):
    """Chunks that pass through a filter of this number, whose plugin whoever reads would load."""
    def make(file, path, _, shape):
        properties = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        properties.set_chunk(shape)
        properties.set_filter(number, h5py.h5z.FLAG_OPTIONAL, (1, 2, 3))
        create(file, path, simple(shape), h5py.h5t.NATIVE_DOUBLE, properties)
        file[path][...] = 1.0
    return make


def outside_structures():
    """All that leads out of the file."""
    byte, double = h5py.h5t.NATIVE_UINT8, h5py.h5t.NATIVE_DOUBLE
    return [
        *each("external bytes", "outside", TARGETS, external(byte, "text")),
        *each("external doubles", "outside", NUMBERS, external(double, "numbers")),
        *each("external pieces", "outside", NUMBERS[:4], external(double, "numbers", 3)),
        *each("external by a relative path", "outside", NUMBERS[:2], external(byte, "secret.txt")),
        *each("external from above", "outside", NUMBERS[:2], external(byte, "../../../../etc/passwd")),
        *each("external device", "outside", NUMBERS[:2], external(byte, "/dev/zero")),
        *each("external FIFO", "outside", NUMBERS[:2], external(byte, "fifo.h5")),
        *each("external absent file", "outside", NUMBERS[:2], external(byte, "absent")),
        *each("virtual", "outside", NUMBERS, virtual("file", "number")),
        *each("virtual of itself", "outside", NUMBERS[:3], virtual(".", "sensitivity/mean")),
        *each("virtual circle", "outside", NUMBERS[:2], virtual(".", "sensitivity/local")),
        *each("virtual FIFO", "outside", NUMBERS[:3], virtual("fifo.h5", "x")),
        *each("external link to numbers", "outside", NUMBERS, external_link("file", "number")),
        *each("external link to text", "outside", TEXTS, external_link("file", "texts")),
        *each("external link to a group", "outside", GROUPS, external_link("file", "/")),
        *each("external link to itself", "outside", GROUPS[:2], external_link("r.h5", "/")),
        *each("external link to a FIFO", "outside", [*GROUPS, "sensitivity/local"], external_link("fifo.h5", "/")),
        *each("external link to a device", "outside", ["sensitivity"], external_link("/dev/zero", "/")),
        *each("link of its own kind", "outside", ["sensitivity", "sensitivity/local", "study/text"], own_link),
        *[one for number in (7, 255, 256, 305, 32001, 32015, 65535)
          for one in each(f"filter {number}", "outside", NUMBERS[:2], filtered(number))],
    ]


# Links


def group_inside(path, target):
    def change(file, _):
        file[path] = file[target]
    return change


def two_groups(file, _):
    file["sensitivity/a/b"] = 1.0
    file["sensitivity/a/c"] = file["sensitivity/a"]
    file["run/a"] = file["sensitivity/a"]


def doubled(levels):
    """Two ways from each level to the next: 2 to the power of `levels` paths."""
    def change(file, _):
        below = file.create_group("sensitivity/g0")
        for level in range(1, levels):
            above = file.create_group(f"run/g{level}")
            above["a"] = above["b"] = below
            below = above
        file["sensitivity/top"] = below
    return change


def nested(levels):
    def change(file, _):
        group = file["sensitivity"]
        for _ in range(levels):
            group = group.create_group("g")
    return change


def committed(file, path, _, __):
    file[path] = np.dtype([("a", "f8"), ("b", "i4")])


def tree_structures():
    return [
        *each("soft link to a dataset", "tree", NUMBERS[:3], soft_link("/sensitivity/mean")),
        *each("soft link to a group", "tree", GROUPS, soft_link("/solver")),
        *each("soft link to nothing", "tree", [*GROUPS, *NUMBERS[:2]], soft_link("/nothing/here")),
        *each("soft link to itself", "tree", GROUPS[:2], lambda file, path, *_: soft_link("/" + path)(file, path, 0, 0)),
        *each("soft link to the root", "tree", GROUPS, soft_link("/")),
        *each("soft link upwards", "tree", NUMBERS[:2], soft_link("..")),
        *each("committed type", "tree", [*NUMBERS[:3], *TEXTS[:3], "sensitivity"], committed),
        Structure("soft circle of two", "tree",
                  lambda file, _: (file.__setitem__("a", h5py.SoftLink("/b")), file.__setitem__("b", h5py.SoftLink("/a")))),
        Structure("group inside itself", "tree", group_inside("sensitivity/x", "sensitivity")),
        Structure("root inside a group", "tree", group_inside("sensitivity/x", "/")),
        Structure("root inside the root", "tree", group_inside("x", "/")),
        Structure("root inside the run", "tree", group_inside("run/x", "/")),
        Structure("group with two names", "tree", group_inside("sensitivity/x", "poses")),
        Structure("circle of two", "tree", two_groups),
        Structure("two to the power of 20 paths", "tree", doubled(20)),
        Structure("two to the power of 200 paths", "tree", doubled(200)),
        *[Structure(f"nested {levels} deep", "tree", nested(levels)) for levels in (20, 300, 3000)],
    ]


# Types and shapes


def of_type(make_dtype, value=None):
    def make(file, path, _, shape):
        dtype = make_dtype() if callable(make_dtype) else make_dtype
        file.create_dataset(path, shape=shape, dtype=dtype, data=None if value is None else np.full(shape, value, dtype))
    return make


def references(kind):
    def make(file, path, _, shape):
        dataset = file.create_dataset(path, shape=shape, dtype=kind)
        one = file["poses"].ref
        if shape and kind is h5py.ref_dtype:
            dataset[(0,) * len(shape)] = one
    return make


def of_shape(make_shape, **options):
    def make(file, path, _, shape):
        file.create_dataset(path, shape=make_shape(shape), dtype="f8", **options)
    return make


def no_space(file, path, _, __):
    file[path] = h5py.Empty("f8")


def bomb(elements, **options):
    """Much that takes no room in the file."""
    def make(file, path, _, __):
        file.create_dataset(path, shape=(elements,), dtype="f8", **options)
    return make


def compressed(mebibytes, layers=1):
    def make(file, path, _, __):
        properties = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        properties.set_chunk((1 << 20,))
        for _ in range(layers):
            properties.set_deflate(9)
        length = mebibytes << 17
        create(file, path, simple((length,)), h5py.h5t.NATIVE_DOUBLE, properties)
        dataset = file[path]
        for begin in range(0, length, 1 << 20):
            dataset[begin:begin + (1 << 20)] = 0.0
    return make


def attribute_instead(file, path, _, shape):
    group, _, name = path.rpartition("/")
    file[group or "/"].attrs[name] = np.zeros(shape[:1] or (1,))


def group_instead(file, path, _, __):
    file.create_group(path)["x"] = 1.0


def dataset_instead(file, path, _, __):
    file[path] = np.zeros(3)


def many_names(file, _):
    """A MiB that is read 800 times by whoever follows each name."""
    file["sensitivity/x"] = np.zeros(1 << 17)
    for k in range(800):
        file[f"sensitivity/again_{k}"] = file["sensitivity/x"]


def attribute(name, value):
    def change(file, _):
        del file.attrs[name]
        if value is not None:
            file.attrs[name] = value
    return change


def attribute_of(path, name, value):
    def change(file, _):
        file[path].attrs[name] = value
    return change


def many(count, make):
    def change(file, _):
        for k in range(count):
            make(file, k)
    return change


def hostile_names(name):
    def change(file, _):
        file["sensitivity"].create_group(name)
        file["sensitivity"].attrs[name.replace("\0", "")] = name
        file["factors/name"][0] = name
        file["responses/unit"][0] = name
        file.attrs["title"] = name
    return change


def bad_references(file, _):
    """Scales that lead nowhere, which poesy has no need of."""
    dataset = file["sensitivity/local"]
    del dataset.attrs["DIMENSION_LIST"]
    dataset.attrs.create("DIMENSION_LIST", np.zeros(9), dtype="f8")


SOME = ["sensitivity/local", "poses/alpha", "study/text", "factors/name"]
TYPES = {
    "int8": "i1", "boolean": "?", "float16": "f2", "long double": "g", "big endian": ">f8", "complex": "c16",
    "text of fixed length": "S20", "opaque": "V7", "array": "(2,3)f8", "compound": [("a", "f8"), ("b", "S3")],
    "list": lambda: h5py.vlen_dtype("f8"), "enumeration": lambda: h5py.enum_dtype({"A": 0, "B": 1}),
    "text": lambda: h5py.string_dtype(), "uint64": "u8",
}
SHAPES = {
    "scalar": lambda shape: (), "empty": lambda shape: (0,), "one more": lambda shape: (*shape[:-1], (shape or (0,))[-1] + 1),
    "one less": lambda shape: tuple(max(0, n - 1) for n in shape), "another axis": lambda shape: (*shape, 2),
    "reversed": lambda shape: shape[::-1], "32 axes": lambda shape: (1,) * 32, "a million": lambda shape: (1000000,),
}


def shape_structures():
    return [
        *[one for title, dtype in TYPES.items() for one in each(title, "shape", SOME, of_type(dtype))],
        *each("references", "shape", SOME, references(h5py.ref_dtype)),
        *each("references to regions", "shape", SOME, references(h5py.regionref_dtype)),
        *[one for title, shape in SHAPES.items() for one in each(title, "shape", SOME[:3], of_shape(shape))],
        *each("no space", "shape", SOME, no_space),
        *each("huge, nothing stored", "shape", [*SOME, "pose"], bomb(BIG, chunks=(1 << 16,))),
        *each("huge chunks", "shape", SOME, bomb(BIG, chunks=(1 << 28,))),
        *each("a million chunks", "shape", SOME[:2], bomb(1 << 20, chunks=(1,))),
        *each("endless", "shape", SOME[:2], bomb(1 << 40, chunks=(1 << 20,))),
        *each("compressed bomb of 64 MiB", "shape", SOME[:2], compressed(64)),
        *each("compressed bomb of 512 MiB", "shape", SOME[:1], compressed(512)),
        *each("bomb compressed twice", "shape", SOME[:2], compressed(128, 2)),
        *each("attribute in place of a dataset", "shape", [*SOME, "pose", "response"], attribute_instead),
        *each("group in place of a dataset", "shape", [*SOME, "pose", "response"], group_instead),
        *each("dataset in place of a group", "shape", GROUPS, dataset_instead),
        Structure("dataset with 800 names", "tree", many_names),
        *[Structure(f"attribute {name} is {what}", "shape", attribute(name, value))
          for name in ("filetype", "version", "kind", "model", "content_sha256")
          for what, value in (("a number", 3.5), ("a list", np.arange(5)), ("empty", h5py.Empty("f8")),
                              ("long", "x" * 60000), ("missing", None))],
        *[Structure(f"unit of alpha is {what}", "shape", attribute_of("poses/alpha", "unit", value))
          for what, value in (("a number", 1.0), ("a list", ["m", "rad"]), ("no unit", "\x1b[2J"), ("empty", ""))],
        Structure("coordinates of poses that are elsewhere", "shape",
                  attribute_of("poses", "coordinates", ["../run/host", "../../x", "/"])),
        Structure("400 groups", "shape", many(400, lambda file, k: file["sensitivity"].create_group(f"g{k}"))),
        Structure("900 attributes", "shape", many(900, lambda file, k: file["run"].attrs.__setitem__(f"a{k}", k))),
        Structure("scales that lead nowhere", "shape", bad_references),
        *[Structure(f"hostile name {k}", "shape", hostile_names(name))
          for k, name in enumerate(["..", "a\nb,c", "=1+1|cmd", "\x1b]0;x\x07", "<script>", "x" * 30000, "\u202e\u009b"])],
    ]


def structures():
    """All of them; their names are unique."""
    found = [*outside_structures(), *tree_structures(), *shape_structures()]
    assert len({one.name for one in found}) == len(found)
    return found
