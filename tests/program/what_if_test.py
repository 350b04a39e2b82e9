"""The numbers from which a report predicts yields at other sizes of errors: at the sizes of the study they give its
machines; slopes, sizes and costs; cases without a prediction."""

import base64
import json
import math
import re

import h5py
import numpy

from poesy_program import EACH_A_PART, MECHANISMS, ProgramTest, main

STUDY = """\
format = "poesy-study"
version = 1
[mechanism]
model = "3-prs"
[poses]
count = 5
[errors]
linear = { distribution = "normal", sigma = "0.1 mm" }
angular = { distribution = "uniform", half_width = "0.05 deg" }
[analysis]
kind = "monte-carlo"
draws = "per machine"
factors = "all"
samples = 800
[analysis.limits]
LIMITS
"""
LIMITS = 'tip_position = "0.6 mm"\nz = ["-0.15 mm", "0.4 mm"]'
ALLOCATION = STUDY.split("[analysis]")[0] + """\
[analysis]
kind = "allocation"
samples = 3000
limits = { tip_position = "0.3 mm" }
yield = 0.9
sigmas = 3
""" + EACH_A_PART


ZONES = STUDY.replace('model = "3-prs"', 'file = "delta.toml"').split("[errors]")[0] + """\
[errors]
zones = { distribution = "uniform" }
[analysis]
kind = "monte-carlo"
draws = "per machine"
samples = 1000
limits = { tip_position = "0.1 mm" }
"""


class WhatIf(ProgramTest):
    def report(self, study):
        """The page's prediction, with its arrays, and the result."""
        self.write("study.toml", study)
        done = self.poesy("run", "study.toml", "-o", "out.h5", "--quiet")
        self.assertIn(done.returncode, (0, 6), done.stderr)
        done = self.poesy("report", "out.h5", "-o", "out.html")
        self.assertEqual(done.returncode, 0, done.stderr)
        text = (self.folder / "out.html").read_text()
        data = json.loads(re.search(r'id="report-data">(.*?)</script>', text).group(1))
        found = data["figures"].get("what-if")
        self.assertEqual(found is not None, 'id="what-if"' in text)
        if found is None:
            return None
        components = sum(limit["components"] for limit in found["limits"])
        shapes = {"components": (found["poses"], components, found["machines"]), "deviations": (-1, found["machines"]),
                  "slopes": (found["poses"], components, -1)}
        for name, shape in shapes.items():
            numbers = numpy.frombuffer(base64.b64decode(data["arrays"][found[name]]), "<f4")
            found[name] = numbers.astype(float).reshape(shape)
        return found

    def rejected(self, found, factors):
        """Whether each machine is rejected, if sliders have these factors."""
        change = numpy.zeros(len(found["deviations"]))
        for slider, factor in zip(found["sliders"], factors):
            change[slider["errors"]] = factor - 1
        vectors = found["components"] + numpy.einsum("kce,e,eb->kcb", found["slopes"], change, found["deviations"])
        beyond = numpy.zeros(found["machines"], bool)
        first = 0
        for limit in found["limits"]:
            part = vectors[:, first:first + limit["components"]]
            first += limit["components"]
            values = part[:, 0] if limit["components"] == 1 else numpy.sqrt((part**2).sum(axis=1))
            low, high = (-numpy.inf if limit["low"] is None else limit["low"],
                         numpy.inf if limit["high"] is None else limit["high"])
            beyond |= ~((low <= values) & (values <= high)).all(axis=0)
        return beyond

    def test_at_the_sizes_of_the_study_machines_are_those_of_the_study(self):
        """All machines and poses of the study are in the page, so the count is exact."""
        found = self.report(STUDY.replace("LIMITS", LIMITS))
        with h5py.File(self.folder / "out.h5") as file:
            rejects, value = file["yield/rejects"][()], file["yield/value"][()]
        self.assertEqual(found["machines"], 800)
        self.assertEqual(self.rejected(found, [1] * 10).sum(), rejects)
        self.assertEqual(found["yield"][0], value)
        self.assertGreater(rejects, 40)
        self.assertEqual(found["missed"], 0)
        self.assertLess(found["linearError"], 0.05)
        self.assertEqual(len(found["sliders"]), 10)

    def test_sizes_are_those_of_the_study(self):
        found = self.report(STUDY.replace("LIMITS", LIMITS))
        shown = {(size["label"], size["value"], size["unit"]) for slider in found["sliders"] for size in slider["sizes"]}
        self.assertTrue(shown <= {("sigma", 0.1, "mm"), ("\u00b1", 0.05, "deg")}, shown)
        for slider in found["sliders"]:
            spread = found["deviations"][slider["errors"][0]].std()
            size = slider["sizes"][0]
            sigma = 1e-4 if size["unit"] == "mm" else numpy.radians(0.05) / numpy.sqrt(3)
            self.assertAlmostEqual(spread / sigma, 1, delta=0.12)  # 5 standard errors of 800 machines

    def changes(self):
        """The yields in per cent that the summary predicts for single changes."""
        text = (self.folder / "out.html").read_text()
        said = re.search(r"Predicted yields for one change alone, now [\d.]+ %: (.*?)\. "
                         r"Each is uncertain by up to ([\d.]+) ", text)
        self.uncertainty = float(said.group(2))
        return {name: float(value) for name, value in re.findall(r"([^,:]+?) ([\d.]+) %", said.group(1))}

    def test_the_summary_predicts_what_a_slider_shows(self):
        self.write("delta.toml", (MECHANISMS / "linear-delta-drawing.toml").read_text())
        found = self.report(ZONES)
        names = [slider["name"] for slider in found["sliders"]]
        was = ~self.rejected(found, [1] * len(names))
        said = self.changes()
        self.assertGreaterEqual(len(said), 3)
        self.assertEqual(list(said.values()), sorted(said.values(), reverse=True))
        chances = []
        for change, value in said.items():
            name = change.strip().removeprefix("halving ")
            good = ~self.rejected(found, [0.5 if one == name else 1 for one in names])
            both, before, after = ((numpy.sum(one) + 1) / (len(was) + 4)
                                   for one in (was & good, was & ~good, ~was & good))
            slope = (both - (both + before) * (both + after)) / ((both + before) * (1 - both - before))
            expected = good.mean() + slope * (found["yield"][0] - was.mean())
            self.assertAlmostEqual(value, 100 * expected, delta=0.11, msg=change)  # shown to a tenth; arrays are floats
            rest = (both + after) * (1 - both - after) - slope**2 * (both + before) * (1 - both - before)
            chances.append(100 * found["quantile"] * math.sqrt(rest / (len(was) + 4)))
        self.assertAlmostEqual(self.uncertainty / max(chances), 1, delta=0.06)  # shown with two digits

    def test_the_summary_names_errors_whose_means_reject_machines(self):
        """Predicted without the mean: the yield of the run without it, with the same draws."""
        study = STUDY.replace("LIMITS", LIMITS)
        found = self.report(study)
        name = next(one["name"] for one in found["sliders"] if one["sizes"][0]["unit"] == "mm")
        shifted = f'[errors.override]\n{name} = {{ distribution = "normal", sigma = "0.1 mm", mean = "0.4 mm" }}\n[analysis]'
        shifted = self.report(study.replace("[analysis]\n", shifted + "\n"))
        self.assertLess(shifted["yield"][0], found["yield"][0] - 0.05)
        stem = name.rstrip("0123456789")
        said = [value for change, value in self.changes().items() if f"removing the means of {stem}" in change]
        self.assertEqual(len(said), 1, self.changes())
        self.assertAlmostEqual(said[0], 100 * found["yield"][0], delta=2)

    def test_costs_follow_the_laws_of_the_parts(self):
        found = self.report(ALLOCATION)
        with h5py.File(self.folder / "out.h5") as file:
            total = file["allocation"].attrs["cost"]
        same = found["factors"].index(1)
        self.assertAlmostEqual(found["otherCosts"] + sum(slider["costs"][same] for slider in found["sliders"]), total)
        for slider in found["sliders"]:
            for factor, cost in zip(found["factors"], slider["costs"]):
                tolerance = slider["sizes"][0]["value"] * factor  # in mm or deg, like b of the cost law
                self.assertAlmostEqual(cost * tolerance, 1, places=9)

    def test_the_machines_of_an_allocation_are_those_of_its_certificate(self):
        found = self.report(ALLOCATION)
        certificate = (self.folder / "out_certificate.toml").read_text()
        fewer = re.sub(r"\nsamples = \d+", "\nsamples = 1000", certificate.replace("yield = 0.9\n", ""))
        self.assertNotEqual(fewer, certificate)
        self.write("out_certificate.toml", fewer)
        done = self.poesy("run", "out_certificate.toml", "-o", "certificate.h5", "--quiet")
        self.assertIn(done.returncode, (0, 6), done.stderr)
        with h5py.File(self.folder / "certificate.h5") as file:
            rejects = file["yield/rejects"][()]
        self.assertGreater(rejects, 30)
        self.assertEqual(self.rejected(found, [1] * len(found["sliders"])).sum(), rejects)

    def test_a_feature_is_one_slider_for_its_zones_in_all_limbs(self):
        mechanism = (MECHANISMS / "linear-delta-drawing.toml").read_text()
        self.write("delta.toml", mechanism)
        found = self.report(ZONES)
        sliders = {slider["name"]: slider for slider in found["sliders"]}
        rail = sliders["rail"]
        self.assertEqual([(size["label"], size["value"], size["unit"]) for size in rail["sizes"]],
                         [("position", 0.05, "mm"), ("perpendicularity", 0.02, "mm")])
        self.assertEqual(len(rail["errors"]), 3 * 4)
        halved = ("face", "hinge_b", "rail")
        predicted = self.rejected(found, [0.5 if name in halved else 1 for name in sliders]).sum()
        lines = mechanism.splitlines()
        for n, line in enumerate(lines):
            if re.search(f'name = "({"|".join(halved)})"', line):
                lines[n] = re.sub(r'zone = "([\d.]+) mm"', lambda zone: f'zone = "{float(zone[1]) / 2} mm"', line)
        self.write("delta.toml", "\n".join(lines))
        self.report(ZONES)
        with h5py.File(self.folder / "out.h5") as file:
            rejects = int(file["yield/rejects"][()])
        self.assertLess(rejects, self.rejected(found, [1] * len(sliders)).sum() - 30)
        self.assertLessEqual(abs(int(predicted) - rejects), 2)  # the prediction uses a linear map

    def test_an_overridden_error_of_a_feature_has_a_slider_of_its_own(self):
        self.write("delta.toml", (MECHANISMS / "linear-delta-drawing.toml").read_text())
        overridden = '[errors.override]\nrod_2 = { distribution = "uniform", half_width = "0.2 mm" }\n[analysis]'
        found = self.report(ZONES.replace('"uniform" }', '"normal", sigmas = 3 }').replace("[analysis]", overridden))
        sliders = {slider["name"]: slider for slider in found["sliders"]}
        self.assertEqual([(size["label"], size["value"], size["unit"]) for size in sliders["rod_2"]["sizes"]],
                         [("\u00b1", 0.2, "mm")])
        self.assertEqual(len(sliders["rod_2"]["errors"]), 1)
        self.assertEqual(len(sliders["rod"]["errors"]), 2)

    def test_limits_over_poses_have_no_prediction(self):
        self.assertIsNone(self.report(STUDY.replace("LIMITS", 'z = { spread = "0.3 mm" }')))
        self.assertIsNone(self.report(STUDY.replace("LIMITS", 'z = { to = "0.3 mm", from = "-0.3 mm", share = 0.9 }')))

    def test_errors_that_are_drawn_at_each_pose_have_no_slider(self):
        per_pose = '[errors.override]\n"a_x_*" = { draws = "per pose" }\n[analysis]'
        found = self.report(STUDY.replace("LIMITS", LIMITS).replace("[analysis]", per_pose))
        with h5py.File(self.folder / "out.h5") as file:
            rejects = file["yield/rejects"][()]
        self.assertEqual(self.rejected(found, [1] * 10).sum(), rejects)
        self.assertFalse(any(slider["name"].startswith("a_x_") for slider in found["sliders"]))


if __name__ == "__main__":
    main()
