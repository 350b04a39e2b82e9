"""Doxygen writes the reference of the libraries without a warning, and warns about public members without a comment."""

import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
NOT_RUN = 77

HEADER = """\
#pragma once
namespace poesy {
/// Documented.
struct Thing {
  int said;  ///< documented
  int unsaid;

 private:
  int own_;
};
}  // namespace poesy
"""


def warnings(output, *settings):
    """What doxygen warns of with the project's settings and these besides."""
    configuration = "\n".join(["@INCLUDE = engine/Doxyfile", f"OUTPUT_DIRECTORY = {output}", *settings])
    done = subprocess.run(["doxygen", "-"], input=configuration, cwd=ROOT, capture_output=True, text=True, timeout=600, check=False)
    return done.stderr.splitlines() + ([] if done.returncode == 0 else [f"exit code {done.returncode}"])


class Reference(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)

    def test_nothing_is_warned_of(self):
        found = warnings(self.folder)
        self.assertEqual(found, [], "\n".join(found))
        pages = self.folder / "html"
        self.assertIn("One way for the data", (pages / "index.html").read_text(encoding="utf-8"))
        self.assertTrue((pages / "classpoesy_1_1Model.html").exists())

    def test_a_public_member_without_a_comment_is_found(self):
        (self.folder / "thing.h").write_text(HEADER, encoding="utf-8")
        found = warnings(self.folder, f"INPUT = {self.folder}", "USE_MDFILE_AS_MAINPAGE =")
        self.assertEqual(len(found), 1, found)
        self.assertIn("unsaid", found[0])


if __name__ == "__main__":
    if shutil.which("doxygen") is None:
        print("doxygen is not installed")
        sys.exit(NOT_RUN)
    unittest.main(argv=[sys.argv[0], "-v"])
