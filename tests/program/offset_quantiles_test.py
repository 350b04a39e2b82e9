"""Quantiles of a response with an offset, e.g. by a background: they are as accurate as those of the scatter about the
offset, which are known in closed form, and have the same bits however a study is run."""

import h5py
import numpy

from poesy_program import ProgramTest, main

# The 5 % quantile of the normal distribution is 1.644854 standard deviations below the mean; the density there is
# 0.103136. So the quantile of n samples has a standard error of sqrt(0.05 x 0.95 / n) / 0.103136 = 2.1132 / sqrt(n)
# standard deviations, which is more than that of the median. The probability that any of 54 comparisons exceeds 4.5
# standard errors is alpha = 0.0004.
Z = 1.644854
SAMPLES = 20000
TOLERANCE = 4.5 * 2.1132 / SAMPLES**0.5
BOUND = 0.0025  # half the width of a sketch's bucket, in standard deviations

STUDY = """\
format = "poesy-study"
version = 1
[mechanism]
model = "3-prs"
fidelity = "first-order"
[poses]
count = 3
[errors]
linear = {{ distribution = "normal", sigma = "{sigma} mm" }}
[analysis]
kind = "monte-carlo"
factors = ["a_x_1"]
samples = {samples}
draws = "per {draws}"
background = {{ factors = ["q_1"], linear = "1 mm" }}
[run]
seed = 11
"""


class OffsetQuantiles(ProgramTest):
    def run_study(self, draws, sigma, *options, output="out.h5", samples=SAMPLES):
        self.write("study.toml", STUDY.format(draws=draws, sigma=sigma, samples=samples))
        self.succeeds("run", "study.toml", "-o", output, "--quiet", *options)

    def test_follow_the_scatter(self):
        for draws in ("pose", "machine"):
            for sigma in ("0.01", "0.0001", "0.000001"):  # the offset is 500, 50 000 and 5 000 000 sigma
                with self.subTest(draws=draws, sigma=sigma):
                    self.run_study(draws, sigma)
                    with h5py.File(self.folder / "out.h5") as file:
                        names = list(file["responses/name"].asstr())
                        r = names.index("tip_position")
                        found = {name: file["monte_carlo"][name][r] for name in
                                 ("mean", "std", "quantiles", "quantiles_ci_low", "quantiles_ci_high", "quantile_error")}
                    self.assertTrue((found["mean"] > 100 * found["std"]).all())
                    expected = found["mean"][:, None] + numpy.outer(found["std"], [-Z, 0.0, Z])
                    off = numpy.abs(found["quantiles"] - expected) / found["std"][:, None]
                    self.assertLess(off.max(), TOLERANCE + BOUND)
                    self.assertTrue((found["quantile_error"] > 0).all())
                    self.assertLess((found["quantile_error"] / found["std"]).max(), BOUND)
                    self.assertTrue((found["quantiles_ci_low"] < found["quantiles"]).all())
                    self.assertTrue((found["quantiles"] < found["quantiles_ci_high"]).all())
                    width = (found["quantiles_ci_high"] - found["quantiles_ci_low"]) / found["std"][:, None]
                    self.assertLess(width.max(), 2 * TOLERANCE)

    def test_are_said_to_be_as_good(self):
        self.run_study("machine", "0.0001")
        text = self.succeeds("show", "out.h5")
        self.assertRegex(" ".join(text.split()), r"\(quantiles to 0\.\d+ % of std\)")
        self.succeeds("export", "out.h5", "-d", "tables")
        for name in ("overall", "machines_largest", "monte_carlo_tip_position"):
            self.assertIn(",quantile_error", (self.folder / f"tables/{name}.csv").read_text().splitlines()[0])
        self.run_study("pose", "0.0001", samples=80)
        self.assertIn("quantiles are those of the samples", " ".join(self.succeeds("show", "out.h5").split()))

    def test_have_the_same_bits(self):
        for draws in ("pose", "machine"):
            hashes = set()
            for threads in (1, 3):
                self.run_study(draws, "0.0001", "--threads", threads, samples=12300)
                hashes.add(self.content_hash("out.h5"))
            for k in (1, 2, 3):
                self.run_study(draws, "0.0001", "--shard", f"{k}/3", output=f"{k}.h5", samples=12300)
            self.succeeds("merge", "2.h5", "3.h5", "1.h5", "-o", "merged.h5")
            hashes.add(self.content_hash("merged.h5"))
            self.assertEqual(len(hashes), 1, draws)

    def content_hash(self, name):
        with h5py.File(self.folder / name) as file:
            return file.attrs["content_sha256"]


if __name__ == "__main__":
    main()
