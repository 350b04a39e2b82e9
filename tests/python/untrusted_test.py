"""Result files made to read other files: the package and results/read_results.py refuse them with a clear message."""

import ctypes
import ctypes.util
import os
import shutil
import signal
import sys
from pathlib import Path

import h5py
from package import ROOT, FolderTest, main, poesy, result

sys.path += [str(ROOT / "results"), str(ROOT / "tests" / "program")]
import read_results  # noqa: E402
from hostile_structures import Outside, external_link, replaced, structures  # noqa: E402

RULE = "a result .*reads nothing but itself; do not trust it"
READERS = ((poesy.read, poesy.DamagedFile), (read_results.read_result, read_results.ResultError))
SOUND = "sensitivity of the 3-prs"
LONGEST = 60  # seconds


def too_long(*_):
    raise AssertionError(f"does not end within {LONGEST} s")


class Untrusted(FolderTest):
    def setUp(self):
        super().setUp()
        self.outside = Outside(self.folder)
        os.mkfifo("fifo.h5")
        signal.signal(signal.SIGALRM, too_long)
        self.addCleanup(signal.alarm, 0)

    def check(self, path, words):
        """Each reader refuses the file with these words, the package first."""
        for (read, error), expected in zip(READERS, words):
            with self.subTest(read.__name__), self.assertRaisesRegex(error, expected):
                signal.alarm(LONGEST)
                read(path)

    def change(self, change):
        shutil.copy(result(SOUND).path, "r.h5")
        with h5py.File("r.h5", "r+") as file:
            change(file, self.outside)

    def test_what_leads_elsewhere_or_is_no_tree(self):
        """Links, external storage, virtual datasets, filters, also of FIFOs; circles, depth, committed types."""
        found = [one for one in structures() if one.sort != "shape" and one.name != "dataset with 800 names"]
        self.assertGreater(len(found), 100)
        for one in found:
            with self.subTest(one.name):
                self.change(one.change)
                self.check("r.h5", (f"^r.h5: /.*, and {RULE}",) * 2)

    def test_the_reason_is_said(self):
        words = {
            "external link to numbers sensitivity/local": "/sensitivity/local is a link to another file, and",
            "soft link to a dataset sensitivity/local": "/sensitivity/local is a soft link, and",
            "link of its own kind sensitivity/local": "/sensitivity/local is a link of another kind, and",
            "external bytes study/text": r"/study/text has its values in other files \(external storage\), and",
            "virtual poses/alpha": "/poses/alpha is a virtual dataset, whose values are elsewhere, and",
            "filter 305 sensitivity/local": "/sensitivity/local needs the filter 305, and",
            "committed type sensitivity": "/sensitivity is neither a group nor a dataset, and",
            "group inside itself": "/sensitivity/x is a group that has two names, or is in itself, and",
            "nested 20 deep": "/sensitivity/g/.* is too deep, and",
            "dataset with 800 names": "/sensitivity/again_.* has too many names, and",
        }
        for one in structures():
            if one.name in words:
                with self.subTest(one.name):
                    self.change(one.change)
                    self.check("r.h5", (words.pop(one.name),))
        self.assertEqual(words, {})

    def test_names_reach_no_terminal_as_they_are(self):
        self.change(lambda file, _: file.__setitem__("sensitivity/\x1b[2J\n\u202ex", h5py.SoftLink("/pose")))
        self.check("r.h5", (r"/sensitivity/\?\[2J\?\?x is a soft link, and", r"/sensitivity/\?\[2J\?\?x is a link"))

    def test_groups_are_looked_at_whenever_the_file_is_opened(self):
        self.change(lambda *_: None)
        found = poesy.read("r.h5")
        self.change(replaced("sensitivity/local", external_link("file", "number")))
        with self.assertRaisesRegex(poesy.DamagedFile, RULE):
            found.to_xarray("sensitivity")

    def test_labels_that_no_link_leads_to(self):
        """An axis finds its labels by a reference, which may lead to what is not in the tree."""

        def hide(file, _):
            storage = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
            storage.set_external(str(self.outside.numbers).encode(), 0, h5py.h5f.UNLIMITED)
            local = file["sensitivity/local"]
            space = h5py.h5s.create_simple(local.shape[:1])
            hidden = h5py.Dataset(h5py.h5d.create(file.id, b"hidden", h5py.h5t.NATIVE_DOUBLE, space, storage))
            hidden.make_scale("hidden")
            local.dims[0].detach_scale(local.dims[0][0])
            local.dims[0].attach_scale(hidden)
            library = ctypes.CDLL(ctypes.util.find_library("hdf5_serial") or ctypes.util.find_library("hdf5"))
            self.assertGreaterEqual(library.H5Oincr_refcount(ctypes.c_int64(hidden.id.id)), 0)  # without a link
            del file["hidden"]

        self.change(hide)
        with self.assertRaisesRegex(poesy.DamagedFile, f"/sensitivity/local has .* labels are not in the tree, and {RULE}"):
            poesy.read("r.h5").to_xarray("sensitivity")

    def test_what_is_no_file(self):
        Path("folder.h5").mkdir()
        kinds = {"fifo.h5": "a FIFO", "/dev/zero": "a device", "folder.h5": "a folder"}
        for path, kind in kinds.items():
            with self.subTest(path):
                self.check(path, (f"^{path}: is {kind}, not a file", f"^{path}: is a folder, a FIFO or a device"))

    def test_sound_results_are_read(self):
        for name in ("sensitivity", SOUND):
            shutil.copy(result(name).path, "sound.h5")
            self.assertIn("sensitivity", poesy.read("sound.h5").to_xarray())
            self.assertIn("sensitivity", read_results.read_result("sound.h5").groups)

    def test_packed_anew_by_hdf5s_own_filters(self):
        def pack(file, _):
            values = file["solver/not_converged"][...]
            del file["solver/not_converged"]
            packed = file.create_dataset("solver/not_converged", data=values, compression="gzip", shuffle=True, fletcher32=True)
            for axis, name in enumerate(("factor", "pose")[: packed.ndim]):
                packed.dims[axis].attach_scale(file[name])

        self.change(pack)
        self.assertIn("not_converged", poesy.read("r.h5").to_xarray("solver"))


if __name__ == "__main__":
    main()
