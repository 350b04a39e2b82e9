"""Mechanisms from files, as their designers use them: reference cases, everything that a study of one goes through, and
a result that is complete without the file."""

import json
import os
from pathlib import Path

import h5py

from poesy_program import ProgramTest, main

DATA = Path(os.environ["POESY_DATA"])
WITHIN = 1e-10

STUDY = """\
format = "poesy-study"
version = 1
[mechanism]
file = "{name}.toml"
[poses]
count = 4
[analysis]
kind = "sensitivity"
factors = "all"
samples = 300
[solver]
{solver}
"""


def table(rows, names):
    lines = [",".join(repr(row.get(name, 0.0)) for name in names) for row in rows]
    return "\n".join([",".join(names), *lines]) + "\n"


def quantities(points):
    return "[" + ", ".join("[" + ", ".join(f'"{value!r} m"' for value in point) + "]" for point in points) + "]"


class MechanismFile(ProgramTest):
    def take(self, name):
        self.write(f"{name}.toml", (DATA / "mechanisms" / f"{name}.toml").read_bytes())

    def study(self, name, solver="", file="study.toml"):
        self.take(name)
        return self.write(file, STUDY.format(name=name, solver=solver))

    def check_cases(self, name, cases, key, solver):
        self.study(name, solver)
        factors = sorted({factor for case in cases for factor in case["errors"]})
        self.write("poses.csv", table([case["pose"] for case in cases], list(cases[0]["pose"])))
        self.write("errors.csv", table([case["errors"] for case in cases], factors))
        self.succeeds("evaluate", "study.toml", "--poses", "poses.csv", "--errors", "errors.csv", "--paired", "-o", "all.h5")
        with h5py.File(self.folder / "all.h5") as result:
            group = result["evaluate"]
            for m, case in enumerate(cases):
                self.assertLess(group["status"][m, 0], 2)
                found = case if key is None else case[key]
                deformations = {name: value for name, value in found.items() if isinstance(value, float)}
                for response, value in {**found["response"], **deformations}.items():
                    self.assertAlmostEqual(group[response][m, 0], value, delta=WITHIN, msg=response)

    def test_reference_cases(self):
        mechanisms = json.loads((DATA / "mechanisms.json").read_text())["mechanisms"]
        for name, mechanism in mechanisms.items():
            cases = mechanism["cases"]
            metrics = {"metric": "platform", "published": "published"} if "metric" in cases[0] else {None: None}
            for key, metric in metrics.items():
                for method in ("newton", "gauss-newton"):
                    solver = f'method = "{method}"\n' + (f'metric = "{metric}"\n' if metric else "")
                    if metric == "platform":
                        solver += f"points = {quantities(mechanism['metric_points'])}\n"
                    with self.subTest(mechanism=name, metric=metric, method=method):
                        self.check_cases(name, cases, key, solver)

    def test_what_was_understood(self):
        self.take("upr2-rpu")
        shown = self.succeeds("models", "upr2-rpu.toml", "-o", "picture.svg")
        self.assertIn("12 joints (3 actuated), rank 9 of 12 loop equations: 3 freedoms, 3 over-constraints", shown)
        self.assertIn("delta_1_0_x", shown)
        picture = (self.folder / "picture.svg").read_text()
        self.assertIn("<svg", picture)
        self.assertIn("</svg>", picture)
        self.succeeds("models", "upr2-rpu.toml", "-o", "picture.svg")  # a picture may be replaced
        self.write("drawing.svg", "<svg>somebody's own</svg>")
        for name, wanted in (("drawing.svg", "would be lost"), ("picture.png", "PICTURE.svg")):
            done = self.poesy("models", "upr2-rpu.toml", "-o", name)
            self.assertEqual(done.returncode, 2)
            self.assertIn(wanted, done.stderr.decode())
        done = self.poesy("models", "upr2-rpu")
        self.assertIn("write 'upr2-rpu.toml'", done.stderr.decode())

    def test_a_template_runs(self):
        for name in ("rps3", "upr2-rpu", "ups6"):
            self.take(name)
            template = self.succeeds("template", f"{name}.toml", "monte-carlo")
            template = template.replace("count = 158", "count = 2").replace("samples = 1000", "samples = 20")
            self.write("template.toml", template)
            self.assertIn("# mobility:", self.succeeds("check", "template.toml"))
            self.succeeds("run", "template.toml", "--quiet")
            self.succeeds("report", "template.h5")

    def content_hash(self, name):
        with h5py.File(self.folder / name) as file:
            return file.attrs["content_sha256"]

    def test_a_result_is_complete_without_the_file(self):
        self.study("upr2-rpu")
        self.succeeds("run", "study.toml", "--quiet")
        text = (self.folder / "upr2-rpu.toml").read_text()
        with h5py.File(self.folder / "study.h5") as result:
            self.assertEqual(result["mechanism/text"].asstr()[()], text)
            self.assertEqual(result.attrs["model"], "upr2-rpu")
            factor = result["factors/name"].asstr()[3]
        (self.folder / "upr2-rpu.toml").unlink()
        self.succeeds("replay", "study.h5", factor, "1", "2")
        self.succeeds("report", "study.h5")
        report = (self.folder / "study.html").read_text()
        self.assertIn('id="mechanism"', report)
        self.assertIn("<svg", report)
        self.succeeds("tolerances", "study.h5", "--response", "gap", "--limit", "0.03 mm", "--extrapolate", "-d", "tables")
        (confirming,) = (self.folder / "tables").glob("confirm*equal_effect*.toml")
        self.succeeds("check", confirming)

    def test_shards_are_of_one_mechanism(self):
        self.study("rps3")
        for n in (1, 2):
            self.succeeds("run", "study.toml", "--shard", f"{n}/2", "-o", f"s{n}.h5", "--quiet")
        self.succeeds("run", "study.toml", "--quiet")
        changed = (self.folder / "rps3.toml").read_text().replace('axis = "y"', 'axis = "-y"')
        self.assertNotEqual(changed, (self.folder / "rps3.toml").read_text())
        self.write("rps3.toml", changed)
        self.succeeds("run", "study.toml", "--shard", "2/2", "-o", "other.h5", "--quiet")
        done = self.poesy("merge", "s1.h5", "other.h5", "-o", "mixed.h5")
        self.assertEqual(done.returncode, 2)
        self.assertIn("is of another mechanism", done.stderr.decode())
        (self.folder / "rps3.toml").unlink()
        self.succeeds("merge", "s1.h5", "s2.h5", "-o", "all.h5")
        self.assertEqual(self.content_hash("all.h5"), self.content_hash("study.h5"))

    def test_the_gallery_is_valid(self):
        gallery = DATA.parent.parent / "results" / "gallery"
        studies = sorted(gallery.glob("*/study.toml"))
        self.assertGreaterEqual(len(studies), 6)
        for study in studies:
            self.assertIn("# valid:", self.succeeds("check", study))
            self.assertIn("mobility", self.succeeds("models", study.parent / f"{study.parent.name}.toml"))

    def test_mistakes_name_their_place(self):
        self.take("rps3")
        self.study("rps3")
        text = (self.folder / "rps3.toml").read_text()
        for old, new, wanted in (('type = "S"', 'type = "Z"', ["rps3.toml:", "'Z'"]), ("actuated = true", "", ["rps3.toml:"]),
                                 ('name    = "rps3"', 'name = "rps 3"', ["rps3.toml:3:"])):
            self.assertIn(old, text)
            self.write("rps3.toml", text.replace(old, new))
            for command in (["models", "rps3.toml"], ["check", "study.toml"]):
                done = self.poesy(*command)
                self.assertEqual(done.returncode, 2)
                for words in wanted:
                    self.assertIn(words, done.stderr.decode())
        done = self.poesy("models", "none.toml")
        self.assertEqual(done.returncode, 3)
        done = self.poesy("run", "rps3.toml")
        self.assertEqual(done.returncode, 2)
        self.assertIn("poesy template FILE", done.stderr.decode())


if __name__ == "__main__":
    main()
