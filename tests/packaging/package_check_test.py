#!/usr/bin/env python3
"""Plants faults in what package_check.py looks at: it must find each, and none in what is right."""

import gzip
import tempfile
import unittest
from pathlib import Path

import package_check
from bare_root import Fault

NEEDS = """    GNU C library (glibc) 2.35 or newer
    GNU C++ library with GLIBCXX_3.4.30 and CXXABI_1.3.13 (of GCC 12, which built it, or newer)
    these shared libraries of the machine, under these very names:
        libtbb.so.12
        libhdf5_serial.so.103
    and these, which it brings along:
        none
"""
MODELS = "3-prs    3-PRS\n\nfiles of mechanisms\n" + "".join(f"  /usr/share/poesy/mechanisms/{n}/{n}.toml\n" for n in "abcdef")


class PackageCheckTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)

    def expect_fault(self, words, function, *arguments):
        with self.assertRaises(Fault) as raised:
            function(*arguments)
        self.assertIn(words, str(raised.exception))

    def install(self, manual=b".TH POESY 1\n"):
        for name in package_check.INSTALLED:
            file = self.root / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(gzip.compress(manual) if name.endswith(".1.gz") else b"text")

    def test_files(self):
        self.install()
        package_check.check_files(self.root)
        self.install(b"a page without a title\n")
        self.expect_fault("has no title", package_check.check_files, self.root)
        for name in package_check.INSTALLED:
            self.install()
            (self.root / name).write_bytes(b"")
            self.expect_fault(f"/{name} is missing or empty", package_check.check_files, self.root)
            (self.root / name).unlink()
            self.expect_fault(f"/{name} is missing or empty", package_check.check_files, self.root)

    def test_removed(self):
        package_check.check_removed(self.root)
        (self.root / "usr/include/poesy").mkdir(parents=True)
        self.expect_fault("leave /usr/include/poesy", package_check.check_removed, self.root)

    def test_gallery(self):
        package_check.check_gallery(MODELS, "/usr")
        self.expect_fault("not the gallery in /root", package_check.check_gallery, MODELS, "/root")
        self.expect_fault("names 5 files", package_check.check_gallery, MODELS[:MODELS.rindex("  /")], "/usr")

    def test_needs_of_the_tarball(self):
        package_check.check_needs(NEEDS, "libhdf5")
        package_check.check_needs(NEEDS.replace("libtbb.so.12\n        libhdf5_serial.so.103", "none"), "none")
        self.expect_fault("which glibc", package_check.check_needs, NEEDS.replace("2.35", ""), "libhdf5")
        self.expect_fault("C++ library", package_check.check_needs, NEEDS.replace("GLIBCXX_3.4.30", ""), "libhdf5")
        self.expect_fault("name none", package_check.check_needs, NEEDS, "none")
        self.expect_fault("name libhdf5", package_check.check_needs, NEEDS.replace("libhdf5_serial", "lib"), "libhdf5")

    def test_one_package_of_a_name(self):
        for name in ("poesy_1_amd64.deb", "libpoesy-dev_1_amd64.deb"):
            (self.root / name).touch()
        self.assertEqual(package_check.only_one(self.root, "poesy_*.deb").name, "poesy_1_amd64.deb")
        self.expect_fault("0 files", package_check.only_one, self.root, "poesy-*.tar.gz")
        (self.root / "poesy_2_amd64.deb").touch()
        self.expect_fault("2 files", package_check.only_one, self.root, "poesy_*.deb")

    def test_version_of_the_build(self):
        cache = self.root / "CMakeCache.txt"
        cache.write_text("CMAKE_PROJECT_NAME:STATIC=poesy\nCMAKE_PROJECT_VERSION:STATIC=0.1.0\n", encoding="utf-8")
        self.assertEqual(package_check.version_of(self.root), "0.1.0")
        cache.write_text("A:STRING=CMAKE_PROJECT_VERSION:STATIC=0.1.0\n", encoding="utf-8")
        self.expect_fault("not a build folder", package_check.version_of, self.root)


if __name__ == "__main__":
    unittest.main()
