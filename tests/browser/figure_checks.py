"""Checks of the figures of an open page, and the actions of a reader: clicks, keys and selects."""

from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

MOST_CLICKS = 6  # the most options of one select, and checkboxes of one figure, that are clicked
FEW_CLICKS = 2  # the same if the page was already checked at another width

# Finds figures without a visible mark. A text that says there is nothing to show does not count as a mark.
EMPTY = """
const seen = (e) => { const r = e.getBoundingClientRect(); return r.width + r.height > 0; };
const marks = "g[data-mark=rect], g[data-mark=dot], g[data-mark=line], image, .joint";
const drawn = (svg) => seen(svg) && [...svg.querySelectorAll(marks)].some((mark) => seen(mark));
const pictures = (figure) =>
  [...figure.querySelectorAll(".plot svg[role=img]")].filter((svg) => !svg.closest(".legend, .other"));
return (arguments[0] ? [arguments[0]] : [...document.querySelectorAll("figure[data-figure]")])
  .filter((figure) => !pictures(figure).length || !pictures(figure).every(drawn) ||
    figure.querySelector(".plot-nothing"))
  .map((figure) => figure.dataset.figure);
"""

# Finds SVGs without a role or a description, and texts in them that extend beyond the page or overlap.
UNREADABLE = """
const problems = [];
const width = document.documentElement.clientWidth;
for (const svg of (arguments[0] ?? document).querySelectorAll("figure[data-figure] svg")) {
  const key = svg.closest("figure").dataset.figure;
  const said = svg.getAttribute("aria-label") ?? [...svg.querySelectorAll(":scope > :is(title, desc)")].map((e) => e.textContent).join(" ");
  if (svg.getAttribute("role") !== "img" || said.length < 20) problems.push(`${key}: not described`);
  if (/NaN|undefined|null|unknown/.test(said)) problems.push(`${key}: ${said}`);
  const texts = [...svg.querySelectorAll("text")].filter((text) => !text.closest("[pointer-events=none]"))
    .map((text) => ({ text: text.textContent, box: text.getBoundingClientRect() }))
    .filter(({ text, box }) => text && box.width);
  for (const { text, box } of texts) {
    if (box.left < -1 || box.right > width + 1) problems.push(`${key}: "${text}" is cut off`);
    if (/NaN|undefined/.test(text)) problems.push(`${key}: "${text}"`);
  }
  if (svg.closest(".turning")) continue;
  texts.forEach(({ text, box: a }, k) => texts.slice(k + 1).forEach(({ text: other, box: b }) => {
    const across = Math.min(a.right, b.right) - Math.max(a.left, b.left);
    const down = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
    if (across > 2 && down > 5) problems.push(`${key}: "${text}" and "${other}" overlap`);
  }));
}
return problems;
"""


PICTURE = """
const plot = arguments[0].querySelector(".plot").cloneNode(true);
plot.querySelectorAll("[pointer-events=none]").forEach((tip) => tip.replaceChildren());
const text = plot.innerHTML.replace(/plot-[0-9a-z-]+/g, "");
let digest = 0;
for (let k = 0; k < text.length; ++k) digest = (Math.imul(digest, 31) + text.charCodeAt(k)) | 0;
return [text.length, digest];
"""


def some(things, most):
    """All of a few; of many, the first and the last and some between."""
    step = max(1, -(-len(things) // most))
    return list(things[::step]) + ([things[-1]] if (len(things) - 1) % step else [])


class FigureChecks:
    """Works every control of the page, for a unittest.TestCase that tells what is wrong."""

    def __init__(self, test, browser, most_clicks=MOST_CLICKS):
        self.test = test
        self.browser = browser
        self.most_clicks = most_clicks
        self.driver = browser.driver

    def figures(self):
        return self.driver.find_elements(By.CSS_SELECTOR, "figure[data-figure]")

    def picture(self, figure):
        """Length and digest of what is drawn, but for what stands under the pointer."""
        return tuple(self.browser.run(PICTURE, figure))

    def not_empty(self, figure=None):
        self.test.assertEqual(self.browser.run(EMPTY, figure), [])

    def readable(self, figure=None):
        self.test.assertEqual(self.browser.run(UNREADABLE, figure), [])

    def work_all_controls(self):
        for figure in self.figures():
            with self.test.subTest(figure=figure.get_attribute("data-figure")):
                self.selects(figure)
                self.more(figure)
                self.checkboxes(figure)
                self.turning(figure)
                self.map(figure)

    def visible(self, figure, selector):
        return [one for one in figure.find_elements(By.CSS_SELECTOR, selector) if one.is_displayed()]

    def selects(self, figure):
        k = 0
        while k < len(selects := self.visible(figure, ".controls select")):  # an option may show another select
            self.options(figure, selects[k])
            k += 1

    def options(self, figure, select):
        self.test.assertTrue(self.browser.run("return arguments[0].labels[0]?.innerText.trim()", select))
        choices = select.find_elements(By.TAG_NAME, "option")
        chosen = self.browser.run("return arguments[0].selectedIndex", select)
        for i in [i for i in some(range(len(choices)), self.most_clicks) if i != chosen] + [chosen]:
            before = self.picture(figure)
            choices[i].click()
            self.browser.settle()
            self.test.assertNotEqual(self.picture(figure), before, f"option {i} changes nothing")
            self.not_empty(figure)
            self.readable(figure)

    def more(self, figure):
        for button in self.visible(figure, "button.more"):
            first = self.picture(figure)
            button.click()
            self.test.assertGreater(self.picture(figure)[0], first[0])
            self.not_empty(figure)
            self.readable(figure)
            button.click()
            self.test.assertEqual(self.picture(figure), first)

    def checkboxes(self, figure):
        for box in some(self.visible(figure, "input[type=checkbox]"), self.most_clicks):
            first = self.picture(figure)
            box.click()
            self.test.assertNotEqual(self.picture(figure), first)
            self.not_empty(figure)
            box.send_keys(Keys.SPACE)
            self.test.assertEqual(self.picture(figure), first)

    def turning(self, figure):
        for view in self.visible(figure, ".turning"):
            first = self.picture(figure)
            for key in (Keys.ARROW_LEFT, Keys.ARROW_UP):
                before = self.picture(figure)
                view.send_keys(key)
                self.test.assertNotEqual(self.picture(figure), before, "an arrow key does not turn the view")
            self.not_empty(figure)
            view.send_keys(Keys.HOME)
            self.test.assertEqual(self.picture(figure), first)
            ActionChains(self.driver).drag_and_drop_by_offset(view, 40, 10).perform()
            self.test.assertNotEqual(self.picture(figure), first, "dragging does not turn the view")
            self.visible(figure, ".turning-view button")[0].click()
            self.test.assertEqual(self.picture(figure), first)

    def map(self, figure):
        for view in self.visible(figure, ".map"):
            said = figure.find_element(By.CSS_SELECTOR, "[role=status]")
            texts = [said.text]
            for key in (Keys.HOME, Keys.ARROW_RIGHT, Keys.ARROW_DOWN, Keys.END):
                view.send_keys(key)
                texts.append(said.text)
            self.test.assertEqual(len(set(texts)), len(texts), texts)
            ActionChains(self.driver).move_to_element(view.find_element(By.CSS_SELECTOR, "image")).perform()
            self.test.assertNotEqual(said.text, texts[-1], "pointing at the map reads no value")
