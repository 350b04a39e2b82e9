"""The site of the documentation: links work, all pages can be reached and are in the search, nothing is fetched."""

import html.parser
import importlib.util
import json
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from urllib.parse import unquote, urldefrag

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "engine/docs/build_site.py"
NOT_RUN = 77


class Links(html.parser.HTMLParser):
    """What a page links to and loads, and the anchors that it has."""

    def __init__(self, text):
        super().__init__()
        self.links, self.loaded, self.anchors = set(), set(), set()
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        self.anchors.update(given[name] for name in ("id", "name") if given.get(name))
        if tag in ("a", "area") and given.get("href"):
            self.links.add(given["href"])
        elif given.get("src") or (tag == "link" and given.get("href")):
            self.loaded.add(given.get("src") or given["href"])


def read_site(site):
    return {path.relative_to(site).as_posix(): Links(path.read_text(encoding="utf-8")) for path in site.rglob("*.html")}


def target(place, link):
    """The place in the site that a link leads to, and the anchor; nothing for a link to elsewhere."""
    if re.match(r"[a-z]+:", link):
        return None
    path, anchor = urldefrag(link)
    place = (Path("/") / place).parent / unquote(path) if path else Path("/") / place
    return place.resolve().relative_to("/").as_posix(), unquote(anchor)


def broken(site, pages):
    for place, page in pages.items():
        for link in sorted(page.links | page.loaded):
            found = target(place, link)
            if found is None:
                continue
            if not (site / found[0]).is_file():
                yield f"{place}: there is no {link}"
            elif found[1] and found[0] in pages and found[1] not in pages[found[0]].anchors:
                yield f"{place}: no anchor for {link}"


def menu_of_doxygen(site):
    """Doxygen's menus are made by a script from this file."""
    return set(re.findall(r'url:"([^"]+)"', (site / "library/menudata.js").read_text(encoding="utf-8")))


def reached(pages, further):
    seen, waiting = set(), ["index.html"]
    while waiting:
        place = waiting.pop()
        if place in seen or place not in pages:
            continue
        seen.add(place)
        found = [target(place, link) for link in pages[place].links | (further if place.startswith("library/") else set())]
        waiting += [there[0] for there in found if there]
    return seen


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(holder.cleanup)
        cls.site = Path(holder.name) / "site"
        done = subprocess.run([sys.executable, "-B", SCRIPT, cls.site], capture_output=True, text=True, timeout=600, check=False)
        if done.returncode != 0:
            raise AssertionError(done.stderr)
        cls.pages = read_site(cls.site)

    def test_no_link_is_broken(self):
        found = list(broken(self.site, self.pages))
        self.assertEqual(found, [], "\n".join(found))
        self.assertGreater(sum(len(page.links) for page in self.pages.values()), 5000)

    def test_every_page_can_be_reached(self):
        lost = set(self.pages) - reached(self.pages, menu_of_doxygen(self.site))
        # Doxygen also makes pages that it does not link to: for letters and kinds of members, graphs and folders. So
        # only pages outside of library/ and those of classes and structs must be reached.
        self.assertEqual({place for place in lost if not place.startswith("library/")}, set())
        self.assertEqual({place for place in lost if re.match(r"library/(class|struct)poesy.*(?<!-members)\.html", place)}, set())

    def test_every_markdown_page_of_people_is_there(self):
        for source in ("engine/docs/guide.md", "engine/docs/theory.md", "results/gallery/6-ups/README.md", "bench/README.md",
                       "engine/docs/decisions/0036-child-reads-first.md"):
            self.assertIn(source.replace(".md", ".html"), self.pages)

    def test_sections_are_in_the_navigation_of_each_page(self):
        text = (self.site / "results/gallery/6-ups/README.html").read_text(encoding="utf-8")
        self.assertEqual(re.findall(r"<h2>(.*?)</h2><ul>", text), ["Tutorial", "How to", "Reference", "Theory"])
        self.assertIn('aria-current="page"', (self.site / "engine/docs/theory.html").read_text(encoding="utf-8"))

    def test_formulas_are_mathml(self):
        text = (self.site / "engine/docs/theory.html").read_text(encoding="utf-8")
        self.assertGreater(text.count("<math"), 300)
        self.assertGreater(text.count('<math display="block"'), 10)
        self.assertNotRegex(re.sub(r"<pre>.*?</pre>|<annotation.*?</annotation>", "", text, flags=re.DOTALL), r"\$`|`\$|\$\$")

    def test_nothing_is_fetched_from_elsewhere(self):
        for place, page in self.pages.items():
            self.assertEqual({one for one in page.loaded if re.match(r"(https?:)?//", one)}, set(), place)

    def test_search_knows_every_page(self):
        text = (self.site / "search_index.js").read_text(encoding="utf-8")
        index = json.loads(text.removeprefix("window.searchIndex = ").removesuffix(";\n"))
        self.assertLess(len(text), 3_000_000)
        found = [target("index.html", place) for place, *_ in index]
        for place, anchor in found:
            self.assertIn(place, self.pages)
            self.assertTrue(not anchor or anchor in self.pages[place].anchors, f"{place}#{anchor}")
        own = {place for place in self.pages if not place.startswith("library/")}
        self.assertEqual(own - {place for place, _ in found}, set())
        self.assertTrue(any("Clopper" in words for *_, words in index))
        self.assertTrue(any(heading == "poesy::run_study" for _, _, heading, _ in index))


    @unittest.skipUnless(shutil.which("chromium"), "chromium is not installed")
    def test_search_finds_in_a_browser_without_a_server(self):
        with tempfile.TemporaryDirectory() as profile:
            command = ["chromium", "--headless", "--no-sandbox", f"--user-data-dir={profile}", "--virtual-time-budget=10000", "--dump-dom"]
            for words, expected in {"clopper pearson": "../../engine/docs/guide.html#machines-and-their-yield", "absentword": None}.items():
                address = f"{(self.site / 'engine/docs/theory.html').as_uri()}?q={words.replace(' ', '%20')}"
                shown = subprocess.run([*command, address], capture_output=True, text=True, timeout=120, check=True).stdout
                found = re.search(r'<ol id="found">(.*?)</ol>', shown, re.DOTALL)[1]
                places = re.findall(r'href="([^"]*)"', found)
                self.assertTrue(expected in places if expected else not places, places)
                self.assertIn("<mark>Clopper</mark>" if expected else "Nothing has all of these words.", found)


class Script(unittest.TestCase):
    def test_what_is_broken_is_found(self):
        with tempfile.TemporaryDirectory() as holder:
            site = Path(holder)
            (site / "index.html").write_text('<h1 id="a"></h1><a href="b.html#c"></a><a href="d.html"></a><a href="#a"></a>')
            (site / "b.html").write_text("<img src='e.png'>")
            self.assertEqual(sorted(broken(site, read_site(site))), [
                "b.html: there is no e.png", "index.html: no anchor for b.html#c", "index.html: there is no d.html"])

    def test_a_folder_of_something_else_is_kept(self):
        with tempfile.TemporaryDirectory() as holder:
            kept = Path(holder) / "kept.txt"
            kept.write_text("mine")
            done = subprocess.run([sys.executable, "-B", SCRIPT, holder], capture_output=True, text=True, timeout=600, check=False)
            self.assertEqual(done.returncode, 1)
            self.assertIn("name another folder", done.stderr)
            self.assertEqual(kept.read_text(), "mine")

    def test_a_link_of_a_page_that_leads_nowhere_is_a_fault(self):
        specification = importlib.util.spec_from_file_location("build_site", SCRIPT)
        build_site = importlib.util.module_from_spec(specification)
        specification.loader.exec_module(build_site)
        page = build_site.Page("results/README.md")
        with self.assertRaisesRegex(build_site.Fault, "there is no absent.md"):
            page.link(re.match(build_site.LINK, '<a href="absent.md">'))
        self.assertEqual(page.link(re.match(build_site.LINK, '<a href="../README.md#limits">')), '<a href="../index.html#limits"')
        self.assertEqual(page.link(re.match(build_site.LINK, '<a href="slurm">')), '<a href="slurm/folder.html"')


if __name__ == "__main__":
    for tool in ("pandoc", "doxygen"):
        if shutil.which(tool) is None:
            print(f"{tool} is not installed")
            sys.exit(NOT_RUN)
    unittest.main(argv=[sys.argv[0], "-v"])
