#!/usr/bin/env python3
"""Makes the documentation as a site of plain files: the Markdown pages of the repository, the reference of the library by
Doxygen, and a search that needs no server. Nothing is written twice: a page of the site is a page of the repository.

usage: build_site.py OUTPUT; OUTPUT is replaced if an earlier run made it. Needs pandoc and doxygen.
"""

import html
import json
import posixpath
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HERE = Path(__file__).resolve().parent
MARK = "made-by-build-site"  # the file that says that a folder may be replaced
LIBRARY = "library"
START = "README.md"

# The four kinds of documentation (https://diataxis.fr): to learn, to do, to look up, to understand. A page that is linked from one
# of these is part of the site too.
SECTIONS = {
    "Tutorial": [("Start", START), ("From a drawing to tolerances", "results/tutorial/README.md")],
    "How to": [("Use it: user guide", "engine/docs/guide.md"), ("Read results", "results/README.md"),
               ("Run long and on clusters", "engine/docs/long-runs.md"),
               ("Optimise a design", "engine/docs/design-optimisation.md"), ("Start from a mechanism", "results/gallery/README.md"),
               ("Add a mechanism", "models/README.md"), ("Add a response", "engine/docs/adding-a-response.md"),
               ("Add a kind of study", "engine/docs/adding-a-kind.md"),
               ("Contribute", "CONTRIBUTING.md")],
    "Reference": [("Study files", "engine/docs/study-file.md"), ("Result files", "engine/docs/result-file.md"),
                  ("Datasets of results", "engine/docs/result-datasets.md"),
                  ("Security", "engine/docs/security.md"),
                  ("C++ library", f"{LIBRARY}/index.html"), ("Changes", "CHANGELOG.md")],
    "Theory": [("Equations and sources", "engine/docs/theory.md"), ("Rankings of one study", "results/2upr-rpu-sensitivity/README.md"),
               ("2UPR-RPU, published", "results/2upr-rpu-paper/README.md"), ("3-PRS, published", "results/3prs-paper/README.md"),
               ("Paper", "results/paper/paper.md"), ("The engine", "engine/README.md"), ("Decisions", "engine/docs/decisions/README.md"),
               ("Benchmarks", "bench/README.md")],
}
LIBRARY_START = """# Library reference

Every public header, by [class](annotated.html) and by [file](files.html). How the rooms fit together is said in
*The engine* of the documentation.
"""
COPIED = {".png", ".svg"}  # other files that pages link to become pages with their text
BLOCK_MATH = re.compile(r"^```math\n(.*?)^```$", re.DOTALL | re.MULTILINE)
INLINE_MATH = re.compile(r"\$`([^`]*)`\$")
LINK = re.compile(r'(<(?:a|img)\b[^>]*?\b(?:href|src)=")([^"]*)(")')
MATH = re.compile(r"<math\b.*?</math>", re.DOTALL)
HEADING = re.compile(r'<h([1-6]) id="([^"]*)"[^>]*>(.*?)</h\1>', re.DOTALL)


class Fault(Exception):
    """What is wrong, in a sentence."""


def run(command, **options):
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, **options)
    if done.returncode != 0 or done.stderr:
        raise Fault(f"{command[0]}: {done.stderr.strip() or 'exit code ' + str(done.returncode)}")
    return done.stdout


def place_of(source):
    """Where a file of the repository is in the site."""
    if source == START:
        return "index.html"
    path = Path(source)
    if (ROOT / source).is_dir():
        return posixpath.join(source, "folder.html")
    if path.suffix == ".md":
        return str(path.with_suffix(".html"))
    return source if path.suffix in COPIED | {".html"} else source + ".html"


def text_of(markup):
    """What a reader sees of markup; of a formula its TeX is left out."""
    markup = re.sub(r"<annotation.*?</annotation>", "", markup, flags=re.DOTALL)
    return " ".join(html.unescape(re.sub(r"<[^>]+>", " ", markup)).split())


def formula(match):
    """A formula of pandoc as browsers show it: upright names on their letters, and brackets as tall as a line where nothing is taller."""
    text = re.sub(r'<mstyle mathvariant="normal">((?:<mi>[^<]*</mi>)+)</mstyle>',
                  lambda name: f'<mi mathvariant="normal">{re.sub("<[^>]*>", "", name[1])}</mi>', match[0])
    return text if re.search("<m(table|frac|underover|under|over)\\b", text) else text.replace('stretchy="true"', 'stretchy="false"')


class Page:
    """A page of the site: where it is, its title, its markup, and what it links to in the repository."""

    def __init__(self, source):
        self.source = source
        self.place = place_of(source)
        self.linked = []
        path = ROOT / source
        if path.is_dir():
            self.markup = self.listing(path)
        elif path.suffix == ".md":
            self.markup = self.converted(path.read_text(encoding="utf-8"))
        else:
            text = html.escape(path.read_text(encoding="utf-8"))
            self.markup = f'<h1 id="file">{html.escape(source)}</h1>\n<pre><code>{text}</code></pre>'
        self.markup = LINK.sub(self.link, self.markup)
        self.markup = self.markup.replace("<table", '<div class="wide" tabindex="0"><table').replace("</table>", "</table></div>")
        first = HEADING.search(self.markup)
        self.title = text_of(first[3]) if first else source

    def listing(self, folder):
        names = sorted(child.name for child in folder.iterdir() if not child.name.startswith("."))
        items = "".join(f'<li><a href="{html.escape(name)}">{html.escape(name)}</a></li>' for name in names)
        return f'<h1 id="folder">{html.escape(self.source)}</h1>\n<ul>{items}</ul>'

    def converted(self, text):
        """GitHub's Markdown, with formulas as MathML. A page with front matter is a paper, with citations in pandoc's way."""
        command = ["pandoc", "--to=html5", "--mathml", "--no-highlight", "--wrap=none"]
        title = re.match(r"---\n.*?^title: *'?(.*?)'?$.*?^---$", text, re.DOTALL | re.MULTILINE)
        if title:
            folder = str((ROOT / self.source).parent)
            command += ["--from=markdown", "--citeproc", "--shift-heading-level-by=1"]
            text = text.replace("bibliography: ", f"bibliography: {folder}/", 1)
            for number, label in enumerate(re.findall(r"\\label\{(.*?)\}", text), 1):
                text = text.replace(f"\\autoref{{{label}}}", f"Figure {number}")
            heading = f'<h1 id="paper">{html.escape(title[1])}</h1>\n'
        else:
            command += ["--from=gfm+tex_math_dollars"]
            text = INLINE_MATH.sub(r"$\1$", BLOCK_MATH.sub(r"$$\n\1$$", text))
            heading = ""
        try:
            return heading + MATH.sub(formula, run(command, input=text))
        except Fault as fault:
            raise Fault(f"{self.source}: {fault}") from None

    def link(self, match):
        """A link to a file of the repository becomes one to its page."""
        target = html.unescape(match[2])
        if re.match(r"[a-z]+:", target) or target.startswith("#"):
            return match[0]
        path, hash_sign, anchor = target.partition("#")
        folder = self.source if (ROOT / self.source).is_dir() else posixpath.dirname(self.source)
        source = posixpath.normpath(posixpath.join(folder, path))
        if not (ROOT / source).exists():
            raise Fault(f"{self.source}: there is no {target}")
        self.linked.append(source)
        return match[1] + html.escape(self.way_to(place_of(source)) + hash_sign + anchor) + match[3]

    def way_to(self, place):
        return posixpath.relpath(place, posixpath.dirname(self.place) or ".")

    def parts(self):
        """For the search: of each heading its anchor, its text, and the text below it."""
        found = list(HEADING.finditer(self.markup))
        ends = [match.start() for match in found[1:]] + [len(self.markup)]
        for match, end in zip(found, ends):
            yield match[2], text_of(match[3]), text_of(self.markup[match.end():end])


def all_pages(sections):
    """The pages of the sections and what they link to, and the files that are copied."""
    waiting = [source for entries in sections.values() for _, source in entries if not source.startswith(LIBRARY + "/")]
    pages, copied = {}, set()
    while waiting:
        with ThreadPoolExecutor(2) as pool:  # converting is pandoc's work
            made = list(pool.map(Page, dict.fromkeys(waiting)))
        pages.update((page.source, page) for page in made)
        linked = [source for page in made for source in page.linked]
        copied.update(source for source in linked if Path(source).suffix in COPIED)
        waiting = [source for source in linked if source not in pages and source not in copied]
    return list(pages.values()), copied


def navigation(page, sections):
    lines = []
    for section, entries in sections.items():
        lines.append(f"<h2>{section}</h2><ul>")
        for name, source in entries:
            place = source if source.startswith(LIBRARY + "/") else place_of(source)
            current = ' aria-current="page"' if place == page.place else ""
            lines.append(f'<li><a href="{page.way_to(place)}"{current}>{html.escape(name)}</a></li>')
        lines.append("</ul>")
    return "\n".join(lines)


def contents(page):
    """Links to the headings of a page, where it has several."""
    headings = [(match[2], match[3]) for match in HEADING.finditer(page.markup) if match[1] == "2"]
    if len(headings) < 3:
        return ""
    items = "".join(f'<li><a href="#{anchor}">{re.sub(r"</?a[^>]*>", "", name)}</a></li>' for anchor, name in headings)
    return f'<details class="contents"><summary>On this page</summary><ul>{items}</ul></details>'


def write_page(page, sections, output):
    values = {"title": html.escape(page.title), "root": page.way_to("."), "navigation": navigation(page, sections),
              "contents": contents(page), "body": page.markup}
    template = (HERE / "page.html").read_text(encoding="utf-8")
    path = output / page.place
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(re.sub(r"@(\w+)@", lambda match: values[match[1]], template), encoding="utf-8")


def library_index(tags):
    """For the search: classes, functions and files of Doxygen's reference."""
    for compound in ElementTree.parse(tags).getroot():
        name, file = compound.findtext("name"), compound.findtext("filename")
        if compound.get("kind") in ("class", "struct", "file"):
            page = file if file.endswith(".html") else file + ".html"
            yield [f"{LIBRARY}/{page}", "C++ library", name, compound.get("kind")]
        for member in compound.iter("member"):
            if member.get("kind") == "function":
                anchor = f"{LIBRARY}/{member.findtext('anchorfile')}#{member.findtext('anchor')}"
                yield [anchor, "C++ library", f"{name}::{member.findtext('name')}", member.findtext("arglist") or ""]


def make_library(output):
    """Doxygen's reference, with a way back to the site on each page. Returns what the search finds there."""
    with tempfile.TemporaryDirectory() as holder:
        folder = Path(holder)
        (folder / "library.md").write_text(LIBRARY_START, encoding="utf-8")
        settings = ["@INCLUDE = engine/Doxyfile", f"INPUT += {folder}/library.md", "FILE_PATTERNS = *.h", "FILTER_PATTERNS =",
                    f"USE_MDFILE_AS_MAINPAGE = {folder}/library.md", f"OUTPUT_DIRECTORY = {folder}",
                    f"GENERATE_TAGFILE = {folder}/tags", f"HTML_EXTRA_STYLESHEET = {HERE}/library.css"]
        run(["doxygen", "-"], input="\n".join(settings))
        shutil.move(folder / "html", output / LIBRARY)
        found = list(library_index(folder / "tags"))
    for path in (output / LIBRARY).glob("*.html"):
        path.write_text(mended(path.read_text(encoding="utf-8"), output / LIBRARY), encoding="utf-8")
    return found


def mended(text, folder):
    """A page of Doxygen with a way back to the site. Doxygen 1.9.4 links to lists of private classes and to pages of concepts, which it
    leaves out; such links become text."""
    def kept(match):
        there = f'name="{match[1][1:]}"' in text if match[1].startswith("#") else (folder / match[1]).exists()
        return match[0] if there else match[2]

    text = re.sub(r'<a [^>]*href="(#nested-classes|#concepts|concept\w+\.html)"[^>]*>(.*?)</a>', kept, text)
    back = '<p id="back"><a href="../index.html">poesy documentation</a></p>'
    return re.sub(r"<body[^>]*>", lambda match: match[0] + back, text, count=1)


def prepare(output):
    """An empty folder; one with something else in it is left alone."""
    if output.exists():
        if any(output.iterdir()) and not (output / MARK).exists():
            raise Fault(f"{output}: has files that no earlier run made; name another folder, or remove it")
        shutil.rmtree(output)
    output.mkdir(parents=True)
    (output / MARK).write_text("This folder is replaced when the site is built.\n")


def build(output):
    for tool in ("pandoc", "doxygen"):
        if shutil.which(tool) is None:
            raise Fault(f"{tool} is not installed; install Debian's {tool}")
    sections = {name: [entry for entry in entries if entry[1].startswith(LIBRARY) or (ROOT / entry[1]).exists()]
                for name, entries in SECTIONS.items()}
    pages, copied = all_pages(sections)
    prepare(output)
    found = make_library(output)
    for page in pages:
        write_page(page, sections, output)
    for source in copied:
        (output / source).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / source, output / source)
    for name in ("site.css", "search.js"):
        shutil.copyfile(HERE / name, output / name)
    index = [[f"{page.place}#{anchor}", page.title, heading, text] for page in pages for anchor, heading, text in page.parts()] + found
    (output / "search_index.js").write_text(f"window.searchIndex = {json.dumps(index, ensure_ascii=False)};\n", encoding="utf-8")
    return len(pages)


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    output = Path(sys.argv[1]).absolute()
    try:
        count = build(output)
    except Fault as fault:
        sys.exit(f"build_site.py: {fault}")
    print(f"{output}/index.html: {count} pages and the library's reference")


if __name__ == "__main__":
    main()
