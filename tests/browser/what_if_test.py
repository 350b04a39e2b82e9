"""Sliders in a report predict the yield at other sizes of errors: a study finds the same within the stated error."""

import json
import re
import sys
import unittest

import h5py
from report_test import ROOT, ReportTest

from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

TRICEPT = ROOT / "results" / "gallery" / "tricept"

# For each setting, the factor of slider g; slider 0 is the most important error.
SETTINGS = {
    "all_smaller": lambda g: 0.5,
    "all_larger": lambda g: 1.5,
    "first_doubled": lambda g: 2.0 if g == 0 else 1.0,
    "three_made_well": lambda g: 0.25 if g < 3 else 1.25,
    "every_second": lambda g: 0.75 if g % 2 else 2.0,
}

MOVE = """
const inputs = [...document.querySelectorAll(".what-if-slider input")];
const factors = JSON.parse(document.getElementById("report-data").textContent).figures["what-if"].factors;
inputs.forEach((input, g) => {
  input.value = factors.indexOf(arguments[0][g]);
  input.dispatchEvent(new Event("input"));
});
return document.querySelector(".what-if-said").textContent;
"""


class WhatIf(ReportTest):
    def study(self, name, extra=""):
        text = (TRICEPT / "yield.toml").read_text()
        text = text.replace('file = "tricept.toml"', f'file = "{TRICEPT / "tricept.toml"}"')
        text = text.replace('fidelity = "first-order"\n', "").replace("count = 20", "count = 12")
        return self.result(name, text.replace("[analysis]", extra + "[analysis]"))

    of_plain_study = None  # bytes of the result of plain_study(), after the first run

    def plain_study(self):
        """The result at the study's own sizes, which is run once for all tests."""
        if WhatIf.of_plain_study is None:
            WhatIf.of_plain_study = (self.folder / self.study("study")).read_bytes()
        (self.folder / "study.h5").write_bytes(WhatIf.of_plain_study)
        return "study.h5"

    def sliders(self):
        return self.browser.driver.find_elements(By.CSS_SELECTOR, ".what-if-slider")

    def said(self):
        return self.browser.run("return document.querySelector('.what-if-said').textContent")

    def test_predictions_are_what_runs_find(self):
        page = self.report("what-if", self.plain_study())
        self.browser.open(page, 1400)
        names = self.browser.run(
            "return [...document.querySelectorAll('.what-if-slider label')].map((label) => label.textContent)")
        self.assertEqual(len(names), 10)
        sizes = self.browser.run(
            "return [...document.querySelectorAll('.what-if-slider input')].map((one) => one.getAttribute('aria-valuetext'))")
        widths = []
        for setting, factor in SETTINGS.items():
            with self.subTest(setting=setting):
                factors = [factor(g) for g in range(len(names))]
                value, low, high, study = map(float, re.findall(r"([\d.]+)\u202f%", self.browser.run(MOVE, factors)))
                lines = ""
                for name, size, one in zip(names, sizes, factors):
                    sigma, unit = re.search(r"sigma ([\d.]+)\u202f(mm|deg)", size).groups()
                    lines += f'{name} = {{ distribution = "normal", sigma = "{float(sigma) * one:.6g} {unit}" }}\n'
                result = self.study(setting, f"[errors.override]\n{lines}\n")
                found = 100 * self.found_yield(result)
                print(f"{setting}: predicted {value} ({low} to {high}), found {found:.2f}, study {study}")
                self.assertLessEqual(low - 0.05, found)  # the page rounds to a tenth
                self.assertLessEqual(found, high + 0.05)
                self.assertLess(low, high)
                self.assertGreater(abs(found - study), 0.5)  # otherwise the setting would test nothing
                widths.append(high - low)
        self.assertLess(max(widths), 6)

    def found_yield(self, result):
        with h5py.File(self.folder / result) as file:
            return float(file["yield/value"][()])

    def test_the_section_is_drawn_and_faultless(self):
        page = self.report("what-if", self.plain_study())
        self.check_page(page)
        data = json.loads(re.search(r'id="report-data">(.*?)</script>', page.read_text()).group(1))
        numbers = sum(len(text) for name, text in data["arrays"].items() if name.startswith("what_if/"))
        self.assertLess(numbers, 500_000)

    def test_sliders_are_moved_by_keys_and_reset(self):
        self.browser.open(self.report("what-if", self.plain_study()), 400)
        first = self.said()
        slider = self.browser.driver.find_element(By.CSS_SELECTOR, ".what-if-slider input")
        before = slider.get_attribute("aria-valuetext")
        slider.send_keys(Keys.END)
        self.assertIn("× 2.00", slider.get_attribute("aria-valuetext"))
        self.assertNotEqual(self.said(), first)
        self.browser.driver.find_element(By.CSS_SELECTOR, "[data-figure=what-if] button").click()
        self.assertEqual(slider.get_attribute("aria-valuetext"), before)
        self.assertEqual(self.said(), first)
        note = self.browser.run("return document.querySelector('[data-figure=what-if] .note').textContent")
        self.assertIn("certified only at the study's sizes", note)

    def test_paper_and_pages_without_scripts_have_no_sliders(self):
        page = self.report("what-if", self.plain_study())
        self.browser.open(page, 1000)
        self.browser.printed_width(680)
        boxes = "return document.querySelector('[data-figure=what-if]').getClientRects().length"
        self.assertEqual(self.browser.run(boxes), 0)
        page.write_text(re.sub(r"<script>.*?</script>", "", page.read_text(), flags=re.DOTALL))
        self.browser.open(page, 1000)
        text = self.browser.run("return document.getElementById('what-if').textContent")
        self.assertIn("need JavaScript", text)
        self.assertEqual(self.sliders(), [])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v", *sys.argv[1:]])
