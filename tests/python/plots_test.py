"""Plots show the numbers of the result with units. Kinds without a plot give a message."""

import unittest

import numpy as np
from matplotlib import pyplot
from package import main, poesy, result


class Plots(unittest.TestCase):
    def tearDown(self):
        pyplot.close("all")

    def test_ranking(self):
        labels = {
            "sensitivity": "effect on gap [mm]",
            "sobol": "ST, share of the variance of gap",
            "sobol of groups": "ST, share of the variance of gap",
            "monte-carlo": "S1, share of the variance of gap",
            "allocation": "cost",
            "identification": "deformation by the error alone, relative to the largest",
        }
        for name, label in labels.items():
            with self.subTest(name):
                found = result(name)
                axes = found.plot.ranking(top=7)
                ranked = found.ranking()[:7]
                self.assertEqual(axes.get_xlabel(), label)
                self.assertEqual([text.get_text() for text in axes.get_yticklabels()], [row.name for row in ranked])
                widths = [bar.get_width() for bar in axes.patches]
                np.testing.assert_array_equal(widths, [getattr(row, ranked.value) for row in ranked])
                self.assertTrue(axes.yaxis_inverted())
        label = result("sensitivity").plot.ranking("angular_deformation").get_xlabel()
        self.assertEqual(label, "effect on angular_deformation [deg]")

    def test_intervals_of_the_ranking(self):
        found = result("sensitivity")
        lines = found.plot.ranking().collections[0].get_segments()
        for row, line in zip(found.ranking(), lines):
            np.testing.assert_array_equal(line[:, 0], (row.effect_low, row.effect_high))

    def test_axes_that_are_given(self):
        axes = pyplot.subplots(1, 2)[1]
        self.assertIs(result("sensitivity").plot.ranking(ax=axes[0]), axes[0])
        self.assertIs(result("sensitivity").plot.field(ax=axes[1]), axes[1])
        self.assertEqual(len(pyplot.get_fignums()), 1)

    def values(self, axes):
        return np.asarray(axes.collections[0].get_array())

    def test_field(self):
        found = result("sensitivity")
        axes = found.plot.field("gap", "epsilon_1_1_x")
        group = found.to_xarray("sensitivity").sel(response="gap", factor="epsilon_1_1_x")
        sigma = np.deg2rad(0.02)
        np.testing.assert_allclose(self.values(axes), group["local"].values * sigma * 1e3, rtol=1e-12)
        poses = found.to_xarray("poses")
        expected = np.stack([poses["z"] * 1e3, np.rad2deg(poses["beta"])], axis=1)
        np.testing.assert_allclose(axes.collections[0].get_offsets(), expected)
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("z [mm]", "beta [deg]"))
        self.assertEqual(axes.figure.axes[-1].get_ylabel(), "effect of epsilon_1_1_x on gap [mm]")
        other = found.plot.field(x="beta", y="gamma")
        self.assertEqual((other.get_xlabel(), other.get_ylabel()), ("beta [deg]", "gamma [deg]"))
        self.assertEqual(found.plot.field(x="z").get_ylabel(), f"effect of {found.ranking()[0].name} on gap [mm]")

    def test_field_of_each_kind(self):
        cases = {
            "sobol": "ST of {first} on gap",
            "sobol of groups": "ST of {first} on gap",
            "monte-carlo": "rms of gap [mm]",
            "machines": "rms of gap [mm]",
            "allocation": "rms of gap over what its limit allows [%]",
            "coupling": "effect of FS+T+R+L on tip_position at 0.5 mm [mm]",
            "evaluate": "largest gap [mm]",
        }
        for name, label in cases.items():
            with self.subTest(name):
                axes = result(name).plot.field()
                first = result(name).ranking()[0].name if "{" in label else ""
                self.assertEqual(axes.figure.axes[-1].get_ylabel(), label.format(first=first))
                self.assertTrue(np.isfinite(self.values(axes)).all())
        np.testing.assert_allclose(
            self.values(result("monte-carlo").plot.field("angular_deformation", quantity="max")),
            np.rad2deg(result("monte-carlo").to_xarray("monte_carlo")["max"].sel(response="angular_deformation")),
        )
        self.assertEqual(result("evaluate").plot.field(of="all").figure.axes[-1].get_ylabel(), "gap of case all [mm]")

    def test_field_over_time(self):
        axes = result("trajectory").plot.field()
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("time [s]", "largest tip_position [mm]"))
        np.testing.assert_allclose(axes.lines[0].get_xdata(), [0, 0.5, 1, 1.5, 2])

    def test_main_effects(self):
        found = result("machines")
        group = found.to_xarray("monte_carlo/main_effect").sel(response="gap")
        axes = found.plot.main_effects(errors="epsilon_1_1_x")
        np.testing.assert_allclose(axes.lines[0].get_xdata(), np.rad2deg(group["error"].sel(factor="epsilon_1_1_x")))
        np.testing.assert_allclose(axes.lines[0].get_ydata(), group["mean"].sel(factor="epsilon_1_1_x") * 1e3)
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("epsilon_1_1_x [deg]", "mean of gap [mm]"))
        several = found.plot.main_effects()
        self.assertEqual([line.get_label() for line in several.lines], [row.name for row in found.ranking()[:4]])
        self.assertEqual(several.get_xlabel(), "error [standard deviations]")
        self.assertLess(np.abs(several.lines[0].get_xdata()).max(), 4.0)

    def test_yields(self):
        found = result("machines")
        axes = found.plot.yields()
        self.assertEqual([text.get_text() for text in axes.get_yticklabels()], ["all limits", "gap", "angular_deformation"])
        group = found.to_xarray("yield")
        np.testing.assert_allclose(axes.lines[0].get_xdata()[0], 100 * group["value"])
        self.assertEqual(axes.get_xlabel(), "good machines [%]")
        self.assertIn("asked: 90 %", [text.get_text() for text in axes.get_legend().get_texts()])
        certificate = result("allocation").plot.yields()
        group = result("allocation").to_xarray("allocation/certificate")
        np.testing.assert_allclose(certificate.lines[0].get_xdata(), 100 * group["yield"])

    def test_what_a_kind_does_not_have(self):
        cases = {
            ("coupling", "ranking"): "ranks nothing",
            ("identification", "field"): "no values over poses",
            ("sensitivity", "main_effects"): "results of kind monte-carlo have them",
            ("monte-carlo", "yields"): 'draws = "per machine"',
        }
        for (name, picture), words in cases.items():
            with self.subTest(name), self.assertRaisesRegex(poesy.NotInResult, words):
                getattr(result(name).plot, picture)()
        for call, words in (
            (lambda: result("sensitivity").plot.field(of="absent"), "no factor 'absent'"),
            (lambda: result("sensitivity").plot.field(x="absent"), "no coordinate 'absent'; they have z, beta, gamma"),
            (lambda: result("machines").plot.main_effects(errors=["absent"]), "no error 'absent'"),
            (lambda: result("machines").plot.field(quantity="median"), "one of rms, mean"),
            (lambda: result("allocation").plot.field("angular_deformation"), "has no limit in this study; gap has"),
            (lambda: result("evaluate").plot.field(of="absent"), "no case 'absent'; it has all"),
        ):
            with self.subTest(words), self.assertRaisesRegex(poesy.NotInResult, words):
                call()
        self.assertEqual(pyplot.get_fignums(), [])


if __name__ == "__main__":
    main()
