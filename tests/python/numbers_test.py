"""Rankings, Sobol' indices for SALib and verdicts are those of the program: `poesy show --json`, `poesy export`."""

import csv
import json
import math
import unittest
import warnings
from pathlib import Path

import numpy as np
from package import ERRORS, ROOT, FolderTest, main, poesy, result, study


def shown(found, *options):
    """The tables of `poesy show --json` by name, their rows as dicts."""
    return {table["name"]: table for table in json.loads(found.show("--json", *options))["tables"]}


class Numbers(FolderTest):
    def check(self, ranked, rows, columns):
        """columns: field of a row of the ranking -> column of the program, or a function of its row."""
        self.assertEqual(len(ranked), len(rows))
        for own, row in zip(ranked, rows):
            for field, column in columns.items():
                value, expected = getattr(own, field), column(row) if callable(column) else row[column]
                if value == 0.0 and expected is not None:
                    self.assertLess(abs(expected), 1e-9)  # the program prints 0 for values at the level of rounding
                elif expected is None:
                    self.assertTrue(math.isnan(value), (own.name, field))
                elif isinstance(expected, str):
                    self.assertEqual(value, expected)
                else:
                    self.assertLessEqual(abs(value - expected), 1e-14 * abs(expected), (own.name, field, value, expected))

    def test_what_does_not_vary_has_no_ranking(self):
        """Errors in the plane of a planar mechanism: its gap is rounding, and no default."""
        planar = Path(__file__).resolve().parents[2] / "results/gallery/3-rrr/3-rrr.toml"
        errors = {"linear": {"distribution": "normal", "sigma": "0.05 mm"},
                  "angular": {"distribution": "normal", "sigma": "0.05 deg"}}  # fmt: skip
        for kind, value in (("sobol", "ST"), ("monte-carlo", "S1"), ("sensitivity", "effect")):
            with self.subTest(kind):
                found = poesy.run({"mechanism": {"file": str(planar)}, "poses": {"count": 3}, "errors": errors,
                                   "analysis": {"kind": kind, "factors": "in-plane", "samples": 128}})  # fmt: skip
                self.assertEqual(found.response(), "position")
                self.assertTrue({"gap", "z", "theta_x", "theta_y"} <= found.constant)
                self.assertFalse({"x", "y", "position", "theta_z", "rotation"} & found.constant)
                self.assertGreater(getattr(found.ranking()[0], value), 0.0)
                ranked = found.ranking("gap")
                self.assertIn("gap does not vary", ranked.title)
                self.assertIn("gap does not vary", repr(ranked))
                if kind == "sensitivity":
                    self.assertEqual({row.effect for row in ranked}, {0.0})
                    continue
                self.assertEqual(len(ranked), 0)
                with self.assertRaisesRegex(poesy.NotInResult, "gap does not vary"):
                    found.plot.ranking("gap")
                self.assertIn("position", found.plot.ranking().get_xlabel())

    def test_too_few_samples_are_named(self):
        found = poesy.run(study({"kind": "monte-carlo", "draws": "per pose", "samples": 50}))
        self.assertTrue(all(math.isnan(row.S1) for row in found.ranking()))
        self.assertIn("none is formed below 64 samples", found.ranking().title)

    def test_sensitivity(self):
        for name in ("sensitivity", "sensitivity of the 3-prs"):
            found = result(name)
            for response in (None, "angular_deformation" if name == "sensitivity" else "rotation"):
                table = shown(found, *(("--response", response) if response else ()))["ranked"]
                ranked = found.ranking(response)
                self.assertEqual(ranked.title, table["caption"])
                units = {column["name"]: column["unit"] for column in table["columns"]}
                self.assertEqual(ranked.units["effect"], units["effect"])
                same = ("rank", "effect", "index", "index_low", "index_high", "sigma", "unit")
                self.check(ranked, table["rows"], {"name": "error"} | {field: field for field in same})
                self.assertEqual(ranked[0].index_unit, f"{units['effect']}/{ranked[0].unit}")
                for row in ranked:
                    self.assertTrue(row.effect_low <= row.effect <= row.effect_high or math.isnan(row.effect))

    def test_descriptions(self):
        found = result("sensitivity")
        known = {one["name"]: one["description"] for one in json.loads(found.show("--json"))["errors"]}
        self.assertEqual({row.name: row.description for row in found.ranking()}, known)

    def test_sobol(self):
        for name in ("sobol", "sobol of groups"):
            found = result(name)
            what = "group" if name == "sobol of groups" else "error"
            for response in found.units("response"):
                rows = shown(found, "--response", response)[f"sobol_{response}"]["rows"]
                if what == "group":  # the program ranks groups by the Shapley effect
                    rows = sorted(rows, key=lambda row: -row["ST"])
                ranked = found.ranking(response)
                self.assertEqual(ranked.what, what)
                self.check(ranked, rows, {"name": what} | {f: f for f in ("S1", "S1_low", "S1_high", "ST", "ST_low", "ST_high")})

    def test_salib(self):
        for name in ("sobol", "sobol of groups"):
            found = result(name)
            poesy._program.call("export", found.path, "-d", "tables")
            for response in found.units("response"):
                indices = found.to_salib(response)
                with open(f"tables/sobol_{response}.csv", newline="") as file:
                    rows = list(csv.DictReader(file))
                self.assertEqual(indices["names"], [next(iter(row.values())) for row in rows])
                for column in ("S1", "S1_conf", "ST", "ST_conf"):
                    np.testing.assert_allclose(indices[column], [float(row[column]) for row in rows], rtol=1e-14)
            self.assertEqual("S2" in indices, name == "sobol of groups")
            Path("tables").rename(f"tables of {name}")

    def test_salib_pairs(self):
        found = result("sobol of groups")
        poesy._program.call("export", found.path, "-d", "tables")
        indices = found.to_salib("gap")
        pairs = {}
        for i, first in enumerate(indices["names"]):
            for j, second in enumerate(indices["names"]):
                self.assertEqual(bool(np.isnan(indices["S2"][i, j])), j <= i)
                if j > i:
                    pairs[f"{first} & {second}"] = (indices["S2"][i, j], indices["S2_conf"][i, j])
        with open("tables/sobol_pairs_gap.csv", newline="") as file:
            for row in csv.DictReader(file):
                value, half = pairs.pop(row["pair"])
                self.assertEqual(value, float(row["S2"]))
                self.assertAlmostEqual(half, (float(row["S2_ci_high"]) - float(row["S2_ci_low"])) / 2, places=14)
        self.assertEqual(pairs, {})

    def test_monte_carlo(self):
        found = result("monte-carlo")
        rows = shown(found)["first_order"]["rows"]
        columns = {"name": "error", "S1": "S1_gap", "S1_low": "S1_ci_low_gap", "S1_high": "S1_ci_high_gap"}
        self.check(found.ranking()[: len(rows)], rows, columns)

    def test_machines(self):
        found = result("machines")
        table = shown(found)["mean_square_shares"]
        limited = [column["name"].removeprefix("share_") for column in table["columns"][1::3]]
        self.assertEqual(set(limited), {"gap", "angular_deformation"})
        by_response = found.to_xarray("yield")["by_response"]
        self.assertEqual(float(by_response.sel(response=limited[0])), float(by_response.min()))  # rejects most machines
        for response, ranked in ((limited[0], found.ranking()), (limited[1], found.ranking(limited[1]))):
            def share(end, of=response):
                return lambda row: row[f"share_{end}{of}"] / 100.0
            columns = {"name": "error", "mean_square_share": share(""), "mean_square_share_low": share("ci_low_"),
                       "mean_square_share_high": share("ci_high_")}
            order = [str(name) for name in found.to_xarray("yield")["factor"].values]  # for equal shares
            rows = sorted(table["rows"], key=lambda row: (-row[f"share_{response}"], order.index(row["error"])))
            self.check(ranked, rows, columns)
            self.assertIn(response, ranked.title)
        changes = {row["error"]: row for row in shown(found)["yield_gradient"]["rows"]}
        for row in found.ranking():
            if row.name in changes:
                self.assertAlmostEqual(row.change, changes[row.name]["change"] / 100.0, places=12)
        label = found.plot.ranking().get_xlabel()
        self.assertEqual(label, f"share of the scatter of {limited[0]}")
        self.assertEqual(found.ranking("linear_deformation").value, "S1")  # this response has no limit

    def test_correlated_errors_are_ranked_together(self):
        described = study({"kind": "monte-carlo", "samples": 400, "limits": {"gap": "0.04 mm"}})
        block = {"factors": ["delta_1_4_x", "delta_1_4_y"], "correlation": [[1, 0.9], [0.9, 1]]}
        described["errors"] = {**ERRORS, "correlated": [block]}
        found = poesy.run(described)
        rows = {row["error"]: row for row in shown(found)["mean_square_shares"]["rows"]}
        ranked = {row.name: row for row in found.ranking()}
        self.assertEqual(set(rows), set(ranked))
        together = ranked["2 correlated errors together"]
        self.assertEqual(together.description, "delta_1_4_x, delta_1_4_y")
        self.assertAlmostEqual(together.mean_square_share, rows[together.name]["share_gap"] / 100.0, places=12)
        self.assertTrue(math.isnan(ranked["delta_1_4_x"].mean_square_share))
        shares = [row.mean_square_share for row in ranked.values() if not math.isnan(row.mean_square_share)]
        linear = float(found.to_xarray("yield")["linear_share"].sel(response="gap"))
        self.assertAlmostEqual(sum(shares), linear, places=12)
        self.assertEqual(shares, sorted(shares, reverse=True))
        self.assertIn("scatter", found.plot.ranking().get_xlabel())

    def test_allocation(self):
        found = result("allocation")
        table = shown(found)["drawing"]
        columns = {"name": "part", "members": "errors"} | {field: field for field in ("cost", "tolerance", "sigma", "unit")}
        self.check(found.ranking(), table["rows"], columns | {"share": lambda row: row["share"] / 100.0})
        self.assertEqual(sum(row.cost for row in found.ranking()) > 0.0, True)

    def test_identification(self):
        found = result("identification")
        table = shown(found)["identification"]
        rows = {row["error"]: row for row in table["rows"]}
        ranked = found.ranking()
        self.assertEqual(ranked.title, table["caption"])
        self.assertEqual({row.name: row.verdict for row in ranked}, {name: row["verdict"] for name, row in rows.items()})
        for row in ranked:
            self.assertEqual(row.share * 4, rows[row.name]["deforming_poses_1"])
        largest = found.to_xarray("identification")["single_max"].sel(group=found.to_xarray("identification")["group"][0])
        for row in ranked:
            alone = float(largest.sel(factor=row.name)) if row.verdict == "deforms alone" else 0.0
            self.assertAlmostEqual(row.deformation, alone / float(largest.max()), 12)
        self.assertGreater(len({row.deformation for row in ranked}), 2)
        order = ["deforms alone", "deforms in a coupling", "absorbed"]
        self.assertEqual([row.verdict for row in ranked], sorted((row.verdict for row in ranked), key=order.index))

    def test_verdicts(self):
        words = {"PASS": "kept", "FAIL": "not kept", "UNDECIDED": "undecided"}

        def verdict(asked):
            analysis = {"kind": "monte-carlo", "draws": "per machine", "samples": 1000, "yield": asked, "conf_level": 0.9}
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", poesy.PoesyWarning)
                found = poesy.run(study(analysis | {"limits": {"gap": "0.07 mm"}}, poses=2))
            caption = shown(found)["yield"]["caption"]
            self.assertEqual(found.verdict, words[caption.partition(":")[0]], caption)
            return found.verdict, float(found.to_xarray("yield")["value"])

        _, value = verdict(0.5)
        self.assertTrue(0.1 < value < 0.9, value)
        offsets = {-0.08: "kept", 0.0: "undecided", 0.08: "not kept"}
        self.assertEqual({offset: verdict(value + offset)[0] for offset in offsets}, offsets)
        for step in range(-6, 7):
            verdict(value + 0.005 * step)

    def test_no_verdict_without_a_wanted_yield(self):
        analysis = {"kind": "monte-carlo", "draws": "per machine", "samples": 200, "limits": {"gap": "0.07 mm"}}
        self.assertIsNone(poesy.run(study(analysis, poses=2)).verdict)
        page = (ROOT / "engine" / "python" / "README.md").read_text(encoding="utf-8")
        self.assertIn("or limits on machines without a wanted `yield`", page)


class Tables(unittest.TestCase):
    def test_rows_have_names(self):
        ranked = result("sensitivity").ranking()
        self.assertEqual(ranked[0].rank, 1)
        self.assertEqual(len(ranked[:5]), 5)
        self.assertEqual([row.name for row in ranked], ranked.to_dict()["name"])
        self.assertEqual(len({len(column) for column in ranked.to_dict().values()}), 1)
        self.assertEqual(ranked[-1], list(ranked)[-1])

    def test_print(self):
        ranked = result("sensitivity").ranking()
        lines = repr(ranked).splitlines()
        self.assertIn("effect [mm]", lines[1])
        self.assertTrue(lines[2].split()[1] == ranked[0].name)
        self.assertEqual(lines[-1], f"... and {len(ranked) - 20} more")
        self.assertIn("<caption>Effect of each error on gap", ranked._repr_html_())
        self.assertNotIn("more", repr(ranked[:3]))
        self.assertEqual(repr(ranked[:0]), ranked.title + "\n")

    def test_result_says_what_it_is(self):
        self.assertRegex(repr(result("allocation")), r"<poesy allocation result of 2upr-rpu, certified: .*\.h5>")


if __name__ == "__main__":
    main()
