"""A coupling study from its template to tables, with the commands of a user."""

import csv

import h5py

from poesy_program import ProgramTest, main

SUBSETS = ["FS", "T", "R", "L", "FS+T", "FS+R", "FS+L", "T+R", "T+L", "R+L", "FS+T+R", "FS+T+L", "FS+R+L", "T+R+L",
           "FS+T+R+L"]


class Coupling(ProgramTest):
    def setUp(self):
        super().setUp()
        template = self.succeeds("template", "3-prs", "coupling", "--full")
        self.study = template.replace('select = "interior"', 'select = "grid"').replace(
            "count = 158", "count = { alpha = 3, beta = 3, z = 2 }")
        self.write("study.toml", self.study)

    def test_check_counts_every_set_of_errors(self):
        self.assertIn("3 sizes x 15 sets of errors x 18 poses = 810 solves", self.succeeds("check", "study.toml"))
        self.write("study.toml", self.study.replace('limbs = "all"', 'limbs = "independent"'))
        self.assertIn("3 sizes x 27 sets of errors x 18 poses = 1458 solves", self.succeeds("check", "study.toml"))

    def test_run_show_export_verify(self):
        self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet")
        self.succeeds("verify", "out.h5")
        shown = self.succeeds("show", "out.h5")
        for text in ("4 sources of errors", "0.1 mm: tip_x [mm]", "0.5 mm: tip_z [mm]", "FS+T+R+L", "cancellation"):
            self.assertIn(text, shown)
        self.succeeds("export", "out.h5", "-d", "tables")
        with open(self.folder / "tables" / "coupling_summary.csv") as file:
            rows = list(csv.reader(file))[1:]
        self.assertEqual([row[0] for row in rows], 3 * SUBSETS)
        with open(self.folder / "tables" / "coupling.csv") as file:
            self.assertEqual(len(file.readlines()), 1 + 3 * 15 * 18)

    def test_the_sum_alone_takes_no_solves(self):
        self.write("sum.toml", self.study.replace('worst_case = "search"', 'worst_case = "sum"'))
        self.assertIn("15 sets of errors x 18 poses = 810 solves\n", self.succeeds("check", "sum.toml"))
        self.assertIn("sum.h5: 810 solves in", self.succeeds("run", "sum.toml", "--quiet"))
        self.succeeds("run", "study.toml", "--quiet")
        with h5py.File(self.folder / "sum.h5") as alone, h5py.File(self.folder / "study.h5") as both:
            for name in ("effect", "first_order_sum", "first_order_sum_max", "cancellation"):
                self.assertEqual(alone["coupling"][name][:].tobytes(), both["coupling"][name][:].tobytes())
            self.assertNotIn("worst_case", alone["coupling"])
            self.assertIn("worst_case", both["coupling"])
        self.assertNotIn("worst case:", self.succeeds("show", "sum.h5"))
        self.succeeds("report", "sum.h5")
        self.succeeds("export", "sum.h5", "-d", "sums")
        self.assertFalse((self.folder / "sums/coupling_corners.csv").exists())

    def test_result_has_the_study_again(self):
        self.succeeds("run", "study.toml", "-o", "out.h5", "--quiet")
        with h5py.File(self.folder / "out.h5") as result:
            first = result.attrs["content_sha256"]
            self.assertEqual(list(result["coupling/effect"].dims[2][0].asstr()), SUBSETS)
            self.assertEqual(result["coupling/effect"].shape[1:], (3, 15, 18))
            self.write("again.toml", result["study/text"].asstr()[()])
        self.succeeds("run", "again.toml", "-o", "again.h5", "--quiet")
        with h5py.File(self.folder / "again.h5") as result:
            self.assertEqual(result.attrs["content_sha256"], first)


if __name__ == "__main__":
    main()
