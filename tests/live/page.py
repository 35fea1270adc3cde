# SPDX-License-Identifier: GPL-3.0-or-later
"""The page in a real browser, for tests: Debian's chromium by python3-selenium.

With LIVE_SHOTS=FOLDER screenshots are left there, to be looked at."""
import os
import shutil
import tempfile
import unittest

from served import Served, make_folder

try:
    from selenium import webdriver
    from selenium.common.exceptions import StaleElementReferenceException
    from selenium.webdriver import ActionChains
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.ui import WebDriverWait
    MISSING = next((name for name in ("chromium", "chromedriver") if not shutil.which(name)), "")
except ImportError:
    ActionChains = Keys = None
    MISSING = "python3-selenium"

SHOTS = os.environ.get("LIVE_SHOTS", "")
# No more than a limit: a busy machine may take ten times as long as an idle one.
PATIENCE = 600


def open_browser(profile, downloads, width=1280, height=800, dark=False):
    options = webdriver.ChromeOptions()
    for word in ("--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking",
                 "--disable-component-update", "--disable-sync", "--disable-quic", "--enable-unsafe-swiftshader",
                 f"--user-data-dir={profile}", f"--window-size={width},{height}"):
        options.add_argument(word)
    if dark:
        options.add_argument("--blink-settings=preferredColorScheme=0")
    options.add_experimental_option("prefs", {"download.default_directory": downloads})
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)


@unittest.skipIf(MISSING, f"{MISSING} is missing: the page is not tested in a browser")
class PageTest(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.folder = os.path.join(self.place.name, "work")
        self.downloads = os.path.join(self.place.name, "downloads")
        os.mkdir(self.folder)
        os.mkdir(self.downloads)
        make_folder(self.folder)
        self.served = self.browser = None

    def tearDown(self):
        if self.browser:
            self.browser.quit()
        if self.served:
            self.served.end()
        self.place.cleanup()

    def begin(self, *words, **how):
        self.served = Served(self.folder, *words)
        self.browser = open_browser(os.path.join(self.place.name, "profile"), self.downloads, **how)
        self.browser.get(self.served.address)
        self.wait(lambda: self.text("phase") != "connecting")

    def wait(self, condition):
        """What the condition gives once it is true; an element that is drawn anew in between is asked for again."""
        patience = WebDriverWait(self.browser, PATIENCE, 0.1, ignored_exceptions=(StaleElementReferenceException,))
        return patience.until(lambda _: condition())

    def at(self, name):
        return self.browser.find_element("id", name)

    def text(self, name):
        return self.at(name).text

    def phase(self):
        return self.at("phase").get_attribute("data-phase")

    def press(self, name):
        self.wait(lambda: self.at(name).is_enabled())
        self.at(name).click()

    def panels(self):
        return [panel.get_attribute("data-table") for panel in self.browser.find_elements("css selector", "#panels .panel")]

    def chart(self, table, number=0):
        """Labels and numbers of points of the curves in a panel, the first or another of a table."""
        return self.browser.execute_script(
            "const found = [...document.querySelectorAll('#panels .panel')].filter((e) => e.dataset.table === arguments[0]);"
            "return Chart.getChart(found[arguments[1]].querySelector('canvas')).data.datasets.map((s) => [s.label, s.data.length]);",
            table, number)

    def button(self, text):
        """The button of the list of files, or none."""
        return next((b for b in self.at("files").find_elements("tag name", "button") if b.text == text and b.is_displayed()), None)

    def when_there(self, find, act):
        """Does a thing with what is found; the list of files may be drawn anew between the two."""
        def done():
            element = find()
            if element:
                act(element)
            return element
        self.wait(done)

    def click_button(self, text):
        self.when_there(lambda: self.button(text), lambda button: button.click())

    def open_file(self, name):
        self.when_there(lambda: next((row for row in self.at("files").find_elements("tag name", "tr") if name in row.text), None),
                        lambda row: row.find_element("xpath", ".//button[text()='open']").click())

    def shoot(self, name):
        if SHOTS:
            self.browser.save_screenshot(os.path.join(SHOTS, name + ".png"))

    def check_console(self):
        faults = [entry["message"] for entry in self.browser.get_log("browser") if entry["level"] == "SEVERE"]
        self.assertEqual(faults, [])
