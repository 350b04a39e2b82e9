"""The file, `poesy show`, its JSON, the exported tables and the report's tables and figures have the same numbers.

Expected numbers are computed here from the file's SI numbers, with separate factors for mm, deg and %.
"""

import base64
import csv
import json
import math
import re
import struct

import h5py

from poesy_program import STUDY, ProgramTest, main
from report_test import Page

DISPLAY = {"m": 1e-3, "rad": math.pi / 180.0, "1": 1.0}
BELOW_ROUNDING = 1e-10  # smaller indices are shown as 0
FLOAT = 2.0**-23
# The datasets that are shown as the index with its interval; and the same for the published estimator.
SHOWN = ("global_corrected", "global_corrected_ci_low", "global_corrected_ci_high")
PUBLISHED = ("global", "global_ci_low", "global_ci_high")


def shown_alike(text, value):
    """Whether a text is the value, rounded to the digits that it shows."""
    if text == "0":
        return abs(value) < BELOW_ROUNDING
    digits = text.lower().split("e")[0].lstrip("-").replace(".", "").lstrip("0")
    unit = 10.0 ** (math.floor(math.log10(abs(value))) - max(len(digits), 4) + 1)
    return abs(float(text) - value) <= 0.501 * unit


def same_cell(page, shown):
    """Whether a page's cell says what the terminal shows; a page fills decimals with zeros and has a true minus sign."""
    text = page.replace("\N{MINUS SIGN}", "-")
    return text == shown or bool(re.fullmatch(r"-?[0-9.]+", text)) and float(text) == float(shown)


def floats(page, name):
    data = base64.b64decode(page.data["arrays"][name])
    return struct.unpack(f"<{len(data) // 4}f", data)


class SameNumbers(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("study.toml", STUDY)
        self.succeeds("run", "study.toml", "-o", "r.h5", "--quiet")
        self.succeeds("report", "r.h5")
        self.succeeds("export", "r.h5", "-d", "tables")
        self.page = Page((self.folder / "r.html").read_text())
        self.json = {table["name"]: table for table in json.loads(self.succeeds("show", "r.h5", "--json"))["tables"]}
        with h5py.File(self.folder / "r.h5") as result:
            self.factors = list(result["factors/name"].asstr()[:])
            self.responses = list(result["responses/name"].asstr()[:])
            self.factor_display = [DISPLAY[unit] for unit in result["factors/unit"].asstr()[:]]
            self.response_display = [DISPLAY[unit] for unit in result["responses/unit"].asstr()[:]]
            self.sigma = result["factors/sigma"][:]
            self.found = {name: result["sensitivity"][name][:] for name in (*SHOWN, *PUBLISHED)}
            self.not_converged = result["solver/not_converged"][:].sum(axis=1)
            self.count = result["poses/z"].shape[0] * 1500

    def index(self, name, response, factor):
        """In the units shown."""
        return self.found[name][response, factor] * self.factor_display[factor] / self.response_display[response]

    def effect(self, name, response, factor):
        return self.found[name][response, factor] * self.sigma[factor] / self.response_display[response]

    def expected_row(self, response, factor):
        index, low, high = (self.index(name, response, factor) for name in SHOWN)
        return {"effect": self.effect("global_corrected", response, factor), "index": index, "index_low": low,
                "index_high": high, "index_published": self.index("global", response, factor),
                "sigma": self.sigma[factor] / self.factor_display[factor],
                "not_converged": 100.0 * self.not_converged[factor] / self.count}

    def test_ranked_table(self):
        response = self.responses.index("linear_deformation")
        table = self.json["ranked"]
        names = [column["name"] for column in table["columns"]]
        text = [line.split() for line in self.succeeds("show", "r.h5").splitlines()]
        self.assertEqual({row["error"] for row in table["rows"]}, set(self.factors))
        for row, shown in zip(table["rows"], table["shown"]):
            factor = self.factors.index(row["error"])
            self.assertIn(shown, text)
            self.assertTrue(any(all(map(same_cell, cells, shown)) for cells in self.page.tables["ranked"]), shown)
            for name, expected in self.expected_row(response, factor).items():
                with self.subTest(error=row["error"], column=name):
                    self.assertTrue(math.isclose(row[name], expected, rel_tol=1e-12, abs_tol=BELOW_ROUNDING))
                    self.assertTrue(shown_alike(shown[names.index(name)], expected), shown[names.index(name)])

    def test_order_and_place_within_the_interval(self):
        response = self.responses.index("linear_deformation")
        effects = self.found["global_corrected"][response] * self.sigma
        order = sorted(self.factors, key=lambda name: -effects[self.factors.index(name)])
        self.assertEqual([row["error"] for row in self.json["ranked"]["rows"]], order)
        value, low, high = (self.found[name] for name in SHOWN)
        self.assertTrue(((low <= value) & (value <= high)).all())
        self.assertTrue((value < self.found["global"]).any())  # both estimators differ

    def test_exported_indices(self):
        with open(self.folder / "tables/global.csv", newline="", encoding="utf-8") as file:
            head, *rows = csv.reader(file)
        columns = {name.split(" [")[0]: n for n, name in reversed(list(enumerate(head)))}  # first of equal names: SI
        for factor, row in enumerate(rows):
            self.assertEqual(row[0], self.factors[factor])
            for response, name in enumerate(self.responses):
                for part in (*SHOWN, *PUBLISHED):
                    self.assertEqual(float(row[columns[part.replace("global", name)]]), self.found[part][response, factor])

    def test_bars_of_the_report(self):
        figure = self.page.data["figures"]["ranking"]
        order = [self.responses.index(name) for name in figure["choices"][0]["options"]]
        factors = [self.factors.index(name) for name in figure["items"]]
        parts = dict(zip(("value", "low", "high"), SHOWN))
        for quantity, expected in zip(figure["quantities"], (self.effect, self.index)):
            for key, part in parts.items():
                drawn = floats(self.page, quantity[key])
                wanted = [expected(part, response, factor) for response in order for factor in factors]
                self.assertEqual(len(drawn), len(wanted))
                for one, other in zip(drawn, wanted):
                    self.assertTrue(math.isclose(one, other, rel_tol=FLOAT, abs_tol=BELOW_ROUNDING), (one, other))

    def test_monte_carlo(self):
        """Root mean squares and intervals of quantiles, in the terminal's units, in SI in the tables, and in the file."""
        self.write("mc.toml", STUDY.replace('"sensitivity"', '"monte-carlo"'))
        self.succeeds("run", "mc.toml", "-o", "mc.h5", "--quiet")
        self.succeeds("export", "mc.h5", "-d", "mc")
        overall, poses, *_ = json.loads(self.succeeds("show", "mc.h5", "--json"))["tables"]
        with open(self.folder / "mc/overall.csv", newline="", encoding="utf-8") as file:
            exported = {row["response"]: row for row in csv.DictReader(file)}
        with h5py.File(self.folder / "mc.h5") as file:
            found = {name: data[:] for name, data in file["monte_carlo"].items() if isinstance(data, h5py.Dataset)}
        for row, worst in zip(overall["rows"], poses["rows"]):
            response = self.responses.index(row["response"])
            unit = self.response_display[response]
            other = exported[row["response"]]
            self.assertTrue(math.isclose(row["rms"] * unit, found["overall_rms"][response], rel_tol=1e-12))
            self.assertEqual(float(other["rms"]), found["overall_rms"][response])
            self.assertEqual(other["count"], str(found["overall_count"][response]))
            self.assertEqual(DISPLAY[other["unit"]], unit)
            mean_square = (found["rms"][response] ** 2).mean()  # all poses have equally many samples
            self.assertTrue(math.isclose(found["overall_rms"][response] ** 2, mean_square, rel_tol=1e-10))
            pose = found["quantiles"][response, :, -1].argmax()
            for name, key in (("largest_q_0_95_low", "quantiles_ci_low"), ("largest_q_0_95_high", "quantiles_ci_high")):
                self.assertTrue(math.isclose(worst[name] * unit, found[key][response, pose, -1], rel_tol=1e-12))
            self.assertEqual(found["histogram_counts"][response].sum(), found["overall_count"][response])
            with open(self.folder / f"mc/histogram_{row['response']}.csv", newline="", encoding="utf-8") as file:
                bins = list(csv.DictReader(file))
            self.assertEqual(sum(int(one["count"]) for one in bins), found["overall_count"][response])

    def test_rounding_is_told_apart(self):
        self.assertTrue(shown_alike("2.809", 2.80938))
        self.assertTrue(shown_alike("2.81", 2.80996))
        self.assertFalse(shown_alike("2.81", 2.80938))
        self.assertFalse(shown_alike("2.808", 2.80938))
        self.assertTrue(shown_alike("1.1e-07", 1.1e-7))


if __name__ == "__main__":
    main()
