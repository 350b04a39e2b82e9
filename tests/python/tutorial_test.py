"""Executes the example of the package's README, which has less than 15 lines, and the notebook."""

import re
import sys
import unittest

import notebook
from matplotlib import pyplot
from package import NOT_RUN, ROOT, FolderTest

PACKAGE = ROOT / "engine" / "python"


class Readme(FolderTest):
    def test_from_import_to_a_picture_in_under_15_lines(self):
        code = re.search(r"```python\n(.*?)```", (PACKAGE / "README.md").read_text(encoding="utf-8"), re.DOTALL)[1]
        self.assertTrue(code.startswith("import poesy\n"))
        self.assertLess(len([line for line in code.splitlines() if line.strip()]), 15)
        names = {}
        exec(code, names)  # noqa: S102  it is what a reader does
        self.addCleanup(pyplot.close, "all")
        self.assertEqual(names["result"].model, "rps3")
        self.assertEqual(len(names["result"].ranking()), 108)
        axes = pyplot.gcf().axes[0]
        self.assertEqual(axes.get_xlabel(), "effect on position [mm]")
        self.assertEqual(len(axes.patches), 20)
        self.assertTrue((self.folder / "ranking.png").read_bytes().startswith(b"\x89PNG"))


class Notebook(unittest.TestCase):
    def test_it_runs_and_shows_what_its_words_say(self):
        cells = [cell for cell in notebook.executed(PACKAGE / "tutorial.ipynb").cells if cell.cell_type == "code"]
        data = [output.get("data", {}) for cell in cells for output in cell.outputs]
        texts = "\n".join(one.get("text/plain", "") for one in data)
        self.assertEqual(sum("image/png" in one for one in data), 5)
        self.assertIn("'not kept'", texts)
        self.assertIn("Tolerances of 36 parts, certified", texts)
        self.assertFalse([output for cell in cells for output in cell.outputs if output.get("name") == "stderr"])

    def test_it_is_kept_without_outputs(self):
        text = (PACKAGE / "tutorial.ipynb").read_text(encoding="utf-8")
        self.assertNotIn("image/png", text)
        self.assertLess(len(text), 12_000)


if __name__ == "__main__":
    absent = notebook.missing()
    if absent:
        print(f"skipped the notebook: {', '.join(absent)} not installed")
    chosen = unittest.defaultTestLoader.loadTestsFromTestCase(Readme)
    if not absent:
        chosen.addTests(unittest.defaultTestLoader.loadTestsFromTestCase(Notebook))
    passed = unittest.TextTestRunner(verbosity=2).run(chosen).wasSuccessful()
    sys.exit(1 if not passed else NOT_RUN if absent else 0)
