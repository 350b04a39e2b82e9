"""Headless Chromium: opens a page at a width and a colour scheme, and returns what the browser reports about it."""

import base64
import json
import os
import shutil
from pathlib import Path

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
except ImportError:
    webdriver = None

HEIGHT = 1000
TALLEST_SCREENSHOT = 16000
ALL_RULES = {"type": "tag", "values": ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "best-practice"]}
COLOUR_RULES = {"type": "rule", "values": ["color-contrast", "link-in-text-block"]}


def missing():
    """What has to be installed before a browser can be started; empty where nothing is."""
    programs = {"chromium": "chromium", "chromedriver": "chromium-driver"}
    packages = [package for program, package in programs.items() if not shutil.which(program)]
    return packages + ([] if webdriver else ["python3-selenium"])


class Browser:
    def __init__(self, axe):
        self.axe_source = Path(axe).read_text()
        options = webdriver.ChromeOptions()
        options.binary_location = shutil.which("chromium")
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        for argument in ("--headless=new", "--disable-gpu", "--disable-dev-shm-usage", "--force-color-profile=srgb"):
            options.add_argument(argument)
        if os.geteuid() == 0:
            options.add_argument("--no-sandbox")
        self.driver = webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)
        self.driver.set_script_timeout(120)

    def quit(self):
        self.driver.quit()

    def open(self, page, width, scheme="light"):
        """The page, with all its figures drawn."""
        self.driver.get_log("browser")
        self.driver.get_log("performance")
        self.resize(width)
        self.set_scheme(scheme)
        self.driver.get(Path(page).as_uri())
        self.settle()

    def resize(self, width):
        size = {"width": width, "height": HEIGHT, "deviceScaleFactor": 1, "mobile": False}
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
        self.settle()

    def set_scheme(self, scheme):
        features = [{"name": "prefers-color-scheme", "value": scheme}]
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "", "features": features})

    def settle(self):
        """Waits until figures that follow a change of size are drawn: they are within two frames."""
        self.driver.execute_async_script(
            "const done = arguments[0]; let k = 3;"
            "const next = () => k-- ? requestAnimationFrame(next) : done(); next();")

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def console(self):
        """Errors and warnings since the page was opened."""
        return [entry["message"] for entry in self.driver.get_log("browser") if entry["level"] in ("SEVERE", "WARNING")]

    def requests(self):
        """The addresses asked for since the page was opened."""
        events = [json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")]
        return [event["params"]["request"]["url"] for event in events if event["method"] == "Network.requestWillBeSent"]

    def violations(self, rules=ALL_RULES):
        """What axe-core finds, a line each."""
        if self.run("return typeof axe === 'undefined'"):
            self.run(self.axe_source)
        found = self.driver.execute_async_script(
            """const done = arguments[1];
            axe.run(document, {runOnly: arguments[0], resultTypes: ["violations"]})
              .then((result) => done(result.violations));""",
            rules)
        return [f"{rule['id']}: {rule['help']}: {node['html'][:200]}: {node['failureSummary'][:300]}"
                for rule in found for node in rule["nodes"]]

    def screenshot(self, path):
        size = self.run("const e = document.scrollingElement; return [e.clientWidth, e.scrollHeight]")
        clip = {"x": 0, "y": 0, "width": size[0], "height": min(size[1], TALLEST_SCREENSHOT), "scale": 1}
        shot = self.driver.execute_cdp_cmd("Page.captureScreenshot", {"captureBeyondViewport": True, "clip": clip})
        Path(path).write_bytes(base64.b64decode(shot["data"]))
        self.settle()

    def printed_width(self, paper):
        """The width of the page on paper so wide; what is wider is printed smaller."""
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
        self.resize(paper)
        return self.run("return document.scrollingElement.scrollWidth")

    def print(self, path):
        printed = self.driver.execute_cdp_cmd("Page.printToPDF", {"paperWidth": 8.27, "paperHeight": 11.69})
        Path(path).write_bytes(base64.b64decode(printed["data"]))
