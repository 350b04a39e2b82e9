"""poesy.figure and `python3 -m poesy figure`: sizes, fonts, a figure for each kind, reproducible bytes, refusals."""

import errno
import os
import re
import shutil
import subprocess
import sys
import unittest.mock
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
from package import PROGRAM, ROOT, STUDIES, FolderTest, main, poesy, result

CALIBRATION = ROOT / "tests" / "data" / "calibration"


class Figures(FolderTest):
    def test_each_kind_has_one(self):
        for name in STUDIES:
            with self.subTest(name):
                drawn = poesy.figure(result(name), "figure.svg")
                axes = drawn.axes[0]
                self.assertEqual(axes.get_title(), "")
                self.assertTrue(axes.get_xlabel())
                texts = [text for text in drawn.findobj(lambda one: hasattr(one, "get_fontsize")) if text.get_text()]
                self.assertEqual({text.get_fontsize() for text in texts}, {8.0})

    def test_of_a_sweep_and_of_a_calibration(self):
        swept = poesy.sweep(STUDIES["machines"], {"geometry.l_A": ["60 mm", "70 mm"]})
        self.assertEqual(poesy.figure(swept).axes[0].get_ylabel(), "yield [%]")
        self.assertEqual(poesy.figure(swept, response="root mean square of gap").axes[0].get_ylabel(), "root mean square of gap [mm]")
        for path in CALIBRATION.iterdir():
            shutil.copyfile(path, self.folder / path.name)
        command = [PROGRAM, "calibrate", "delta-measured.toml", "--measured", "delta-heights.csv", "-o", "machine.h5"]
        subprocess.run(command, check=True, capture_output=True)
        machine = poesy.read("machine.h5")
        axes = poesy.figure(machine).axes[0]
        found = machine.to_xarray("calibration")
        drawn = sorted(float(y) for line in axes.lines if line.get_marker() in ("o", "x") for y in line.get_ydata())
        np.testing.assert_array_equal(drawn, sorted(found["standardised"].values))
        self.assertIn("limit of outliers", [text.get_text() for text in axes.get_legend().get_texts()])

    def test_labels_stay_within_the_figure_and_legends_outside_the_axes(self):
        swept = poesy.sweep(STUDIES["machines"], {"geometry.l_A": ["60 mm", "70 mm"], "analysis.samples": ["100", "200", "300"]})
        for found in (result("identification"), result("coupling"), swept):
            drawn = poesy.figure(found)
            drawn.draw_without_rendering()
            axes = drawn.axes[0]
            for label in filter(lambda one: one.get_text(), (axes.xaxis.label, axes.yaxis.label)):
                box = label.get_window_extent()
                self.assertTrue(drawn.bbox.contains(*box.min) and drawn.bbox.contains(*box.max), (label.get_text(), box))
            if found is swept:
                self.assertGreaterEqual(axes.get_legend().get_window_extent().y0, axes.bbox.y1 - 1.0)

    def test_bars_are_those_of_the_ranking(self):
        found = result("sensitivity")
        axes = poesy.figure(found, response="angular_deformation").axes[0]
        ranked = found.ranking("angular_deformation")[:15]
        self.assertEqual([text.get_text() for text in axes.get_yticklabels()], [row.name for row in ranked])
        np.testing.assert_array_equal([bar.get_width() for bar in axes.patches], [row.effect for row in ranked])
        ends = [line.get_xdata() for line in axes.lines if line.get_marker() == "|"]  # caps of intervals
        np.testing.assert_array_equal(ends, [[row.effect_low for row in ranked], [row.effect_high for row in ranked]])

    def test_the_axis_says_how_many_are_left_out(self):
        found = result("sensitivity")
        ranked = len(found.ranking().rows)
        self.assertGreater(ranked, 15)
        label = poesy.figure(found).axes[0].get_xlabel()
        self.assertTrue(label.endswith(f"the first 15 of {ranked}"), label)  # the label is not wrapped
        axes = poesy.figure(found, top=3).axes[0]
        self.assertEqual(len(axes.patches), 3)
        self.assertIn(f"the first 3 of {ranked}", axes.get_xlabel())

    def test_widths(self):
        for size, expected in (("85mm", 85.0), ("170 mm", 170.0), ("8.5 cm", 85.0), (100, 100.0), ("4in", 101.6)):
            poesy.figure(result("sensitivity"), "figure.svg", size=size)
            width = ElementTree.parse("figure.svg").getroot().get("width")
            self.assertAlmostEqual(float(width.removesuffix("pt")) / 72 * 25.4, expected, places=3)
        poesy.figure(result("sensitivity"), "figure.pdf")
        box = re.search(rb"/MediaBox \[ 0 0 ([\d.]+) ", Path("figure.pdf").read_bytes())
        self.assertAlmostEqual(float(box[1]) / 72 * 25.4, 85.0, places=3)

    def test_the_same_result_gives_the_same_bytes(self):
        for end in ("pdf", "svg", "png"):
            for name in ("a", "b"):
                poesy.figure(result("monte-carlo"), f"{name}.{end}")
            self.assertEqual(Path(f"a.{end}").read_bytes(), Path(f"b.{end}").read_bytes(), end)
        self.assertIn(b"epsilon_1_1_x", Path("a.svg").read_bytes())  # text is stored as text, not as outlines

    def test_the_style_stays_within(self):
        import matplotlib

        before = dict(matplotlib.rcParams)
        poesy.figure(result("sobol"))
        self.assertEqual(dict(matplotlib.rcParams), before)

    def test_refusals(self):
        found = result("sensitivity")
        for wrong in ({"size": "10 mm"}, {"size": "85 pt"}, {"size": "wide"}, {"size": "1.2.3 mm"}, {"path": "figure.jpg"}):
            with self.subTest(wrong), self.assertRaises(poesy.StudyError):
                poesy.figure(found, **wrong)
        with self.assertRaisesRegex(poesy.NotInResult, "no response 'gaps'"):
            poesy.figure(found, response="gaps")
        self.assertEqual(list(self.folder.iterdir()), [])

    def command(self, *words):
        return subprocess.run([sys.executable, "-B", "-m", "poesy", "figure", *words], capture_output=True, text=True, check=False)

    def test_command(self):
        shutil.copyfile(result("sensitivity").path, "study.h5")
        done = self.command("study.h5", "-o", "figure.pdf", "--size", "170mm", "--response", "gap")
        self.assertEqual((done.returncode, done.stdout), (0, "figure.pdf\n"), done.stderr)
        self.assertTrue(Path("figure.pdf").read_bytes().startswith(b"%PDF"))
        for words, code, said in [
            (("none.h5", "-o", "f.pdf"), 3, "poesy: none.h5"),
            (("study.h5", "-o", "f.tif"), 2, ".pdf, .svg, .png"),
            (("study.h5", "-o", "f.pdf", "--response", "x"), 2, "no response 'x'"),
            (("study.h5", "-o", "none/f.pdf"), 3, "poesy: "),
            (("study.h5",), 2, "-o"),
        ]:
            done = self.command(*words)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(said, done.stderr)

    def program(self, *words, python=True, path="bin", named=None):
        """poesy figure, where `python3` is this interpreter, with the package or without."""
        Path("bin").mkdir(exist_ok=True)
        link = Path("bin/python3")
        if not link.is_symlink():
            link.symlink_to(sys.executable)
        environment = {**os.environ, "PATH": path}
        environment.pop("POESY_PYTHON", None)
        if named is not None:
            environment["POESY_PYTHON"] = named
        if not python:
            environment.pop("PYTHONPATH")
        return subprocess.run([PROGRAM, "figure", *words], capture_output=True, text=True, check=False, env=environment)

    def test_command_of_the_program(self):
        shutil.copyfile(result("sensitivity").path, "study.h5")
        words = ("study.h5", "-o", "figure.pdf", "--size", "170mm", "--response", "gap")
        Path("matplotlib.py").write_text("raise SystemExit(99)")  # a module in the current folder must not be imported
        done = self.program(*words)
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "figure.pdf\n", ""))
        Path("matplotlib.py").unlink()
        drawn = Path("figure.pdf").read_bytes()
        self.command("study.h5", "-o", "other.pdf", *words[3:])
        self.assertEqual(drawn, Path("other.pdf").read_bytes())
        self.assertEqual(self.program(*words).returncode, 0)  # replaces its own figure
        self.assertEqual(self.program(*words, path="none", named=sys.executable).returncode, 0)
        done = self.program(*words, "--python", sys.executable, path="none", named="none/python")
        self.assertEqual(done.returncode, 0, done.stderr)
        Path("mine.pdf").write_bytes(b"mine")
        for words, code, said, how in [
            (("none.h5", "-o", "f.pdf"), 3, "none.h5", {}),
            (("study.h5", "-o", "f.tif"), 2, ".pdf, .svg, .png", {}),
            (("study.h5", "-o", "mine.pdf"), 2, "mine.pdf", {}),
            (("study.h5", "-o", "study.h5"), 2, "study.h5", {}),
            (("study.h5", "-o", "f.pdf", "--response", "x"), 2, "no response 'x'", {}),
            (("study.h5", "-o", "f.pdf"), 2, "cannot import poesy; activate the environment of ./quickstart python", {"python": False}),
            (("study.h5", "-o", "f.pdf"), 2, "python3 cannot be started", {"path": "none"}),
            (("study.h5", "-o", "f.pdf", "--python", "none/python"), 2, "none/python cannot be started", {}),
        ]:
            with self.subTest(words=words, how=how):
                done = self.program(*words, **how)
                self.assertEqual(done.returncode, code, done.stderr)
                self.assertIn(said, done.stderr)
                self.assertTrue(done.stderr.startswith("poesy: "))
        self.assertEqual(Path("mine.pdf").read_bytes(), b"mine")
        self.assertFalse(Path("f.pdf").exists())

    def test_a_full_disk_names_the_file(self):
        full = OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        with unittest.mock.patch.object(Path, "write_bytes", side_effect=full):
            with self.assertRaisesRegex(poesy.FileError, r"^full\.pdf: cannot be written \(No space left on device\); make room"):
                poesy.figure(result("sensitivity"), "full.pdf")

    def test_nothing_half_written(self):
        Path("figure.pdf").mkdir()  # a folder, which cannot be replaced
        with self.assertRaises(OSError):
            poesy.figure(result("sensitivity"), "figure.pdf")
        self.assertEqual([path.name for path in self.folder.iterdir()], ["figure.pdf"])


if __name__ == "__main__":
    main()
