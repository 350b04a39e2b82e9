#!/usr/bin/env python3
"""Plants faults in what package_check.py inspects: it must find each fault, and none in correct input."""

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
DEPENDS = "python3 (>= 3.11~), python3 (<< 3.12), python3-numpy (>= 1.24), poesy (= 0.2.0~dev-1), libc6 (>= 2.35)"
FILES = """-rw-r--r-- root/root    1761 2026-11-26 07:42 ./usr/lib/python3/dist-packages/poesy_solver.pyi
-rw-r--r-- root/root 3588376 2026-11-26 07:54 ./usr/lib/python3/dist-packages/poesy_solver.cpython-311-x86_64-linux-gnu.so
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
        (self.root / "usr/include/poesy").rmdir()
        (self.root / package_check.PYTHON_PLACE / "poesy/__pycache__").mkdir(parents=True)
        self.expect_fault("leave /usr/lib/python3/dist-packages/poesy", package_check.check_removed, self.root)

    def test_files_for_python(self):
        compiled = self.root / package_check.PYTHON_PLACE / "poesy/__pycache__/__init__.cpython-311.pyc"
        compiled.parent.mkdir(parents=True)
        compiled.touch()
        for name in package_check.INSTALLED_FOR_PYTHON:
            self.expect_fault(f"/{name} is missing or empty", package_check.check_python_files, self.root)
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            (self.root / name).write_text("text", encoding="utf-8")
        package_check.check_python_files(self.root)
        compiled.unlink()
        self.expect_fault("does not compile", package_check.check_python_files, self.root)

    def test_what_the_package_for_python_depends_on(self):
        def check(depends=DEPENDS, files=FILES):
            package_check.check_python_depends(depends, "0.2.0~dev-1", files)

        check()
        check(DEPENDS.replace("3.11", "3.9").replace("3.12", "3.10"), FILES.replace("-311-", "-39-"))
        for wanted, other in {"poesy (= 0.2.0~dev-1)": "poesy (= 0.2.0-1)", "python3 (>= 3.11~)": "python3 (>= 3.9~)",
                              "python3 (<< 3.12)": "python3 (<< 3.13)"}.items():
            self.expect_fault(f"not depend on {wanted}", check, DEPENDS.replace(wanted, other))
            self.expect_fault(f"not depend on {wanted}", check, DEPENDS.replace(f"{wanted}, ", ""))
        self.expect_fault("not depend on python3 (>= 3.12~)", check, DEPENDS, FILES.replace("-311-", "-312-"))
        self.expect_fault("0 compiled modules", check, DEPENDS, FILES.replace(".so", ".o"))
        self.expect_fault("2 compiled modules", check, DEPENDS, FILES + FILES)

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

    def test_package_for_python_where_the_build_has_the_module(self):
        for name in ("poesy_1_amd64.deb", "libpoesy-dev_1_amd64.deb"):
            (self.root / name).touch()
        names = [file and file.name for file in package_check.debian_packages(self.root, False)]
        self.assertEqual(names, ["poesy_1_amd64.deb", "libpoesy-dev_1_amd64.deb", None])
        self.expect_fault("0 files are named python3-poesy", package_check.debian_packages, self.root, True)
        (self.root / "python3-poesy_1_amd64.deb").touch()
        self.assertEqual(package_check.debian_packages(self.root, True)[2].name, "python3-poesy_1_amd64.deb")
        self.expect_fault("also makes python3-poesy_1", package_check.debian_packages, self.root, False)

    def test_whether_the_build_has_the_module(self):
        cache = self.root / "CMakeCache.txt"
        for text, has in {"POESY_PYTHON_MODULE:BOOL=ON\n": True, "POESY_PYTHON_MODULE:BOOL=OFF\n": False, "": False}.items():
            cache.write_text(f"A:STRING=b\n{text}", encoding="utf-8")
            self.assertEqual(package_check.has_module(self.root), has)

    def test_version_of_the_build(self):
        cache = self.root / "CMakeCache.txt"
        cache.write_text("CMAKE_PROJECT_NAME:STATIC=poesy\nCMAKE_PROJECT_VERSION:STATIC=0.1.0\n", encoding="utf-8")
        self.assertEqual(package_check.version_of(self.root), "0.1.0")
        cache.write_text("A:STRING=CMAKE_PROJECT_VERSION:STATIC=0.1.0\n", encoding="utf-8")
        self.expect_fault("not a build folder", package_check.version_of, self.root)


if __name__ == "__main__":
    unittest.main()
