#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""site.py FOLDER: the pages of the repository as a site, FOLDER/site, by mkdocs (Debian: mkdocs-material). They lie in
it as they lie in the repository, so that their links hold; every link of what comes out is followed. Notebooks are
pages, too, with what their cells show (Debian: python3-nbconvert, python3-ipykernel)."""

import html
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import nbclient
import nbconvert
import nbformat

ROOT = Path(__file__).resolve().parent.parent

#: What is in the bar at the left; all other pages are found by their links and by the search.
NAVIGATION = """
- Gallery: docs/gallery.md
- First steps: README.md
- Tutorial: docs/tutorial.md
- Using it:
  - Fits: docs/fit.md
  - Files: docs/files.md
  - Results: docs/results.md
  - Simulations: docs/simulate.md
  - Local densities: docs/many-body.md
  - Other systems: docs/other-systems.md
  - Other engines that sample: docs/any-engine.md
  - Cluster, live view: docs/cluster-and-live.md
  - Coming from VOTCA: docs/coming-from-votca.md
- Python: docs/python.md
- Notebooks:
  - From a trajectory to an engine: examples/trajectory_to_engine.md
  - A digitised g(r): examples/digitised_rdf.md
  - A force and an optimiser of your own: examples/own_force_and_optimiser.md
- Reference:
  - Keys and options: docs/reference.md
  - Python: docs/python-reference.md
  - Theory: docs/theory.md
- Measured:
  - Figures: docs/figures.md
  - Standard set: runs/standard-set/README.md
  - Systems: runs/systems.md
  - Beside VOTCA: runs/compare-peers/README.md
  - Runs: runs/README.md
- Changes: CHANGELOG.md
- Architecture: ARCHITECTURE.md
- Contributing: CONTRIBUTING.md
"""

SETTINGS = """
site_name: mesofit
site_description: The pair interactions of a coarse-grained liquid from what was measured of it
docs_dir: {pages}
site_dir: {site}
use_directory_urls: false
strict: true
theme:
  name: material
  font: false
  features: [navigation.top, search.highlight]
markdown_extensions:
- tables
- fenced_code
- toc:
    permalink: true
    slugify: !!python/object/apply:pymdownx.slugs.slugify {{kwds: {{case: lower}}}}
plugins: [search]
nav:
"""

#: A link to a notebook, whose page has its name.
NOTEBOOK = re.compile(r"(\]\([^)\s]+)\.ipynb\)")
LINK = re.compile(r"(!?\[[^\]]*\])\(([^)\s]+)\)")


def tracked():
    """Files of the repository, committed or not yet."""
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    return {Path(name) for name in listed.split("\0") if (ROOT / name).is_file()}


def linked(page, files):
    """Files and folders of the repository that a page links to."""
    for _, target in LINK.findall((ROOT / page).read_text()):
        path = Path(os.path.normpath(page.parent / target.split("#")[0]))
        if path in files or (ROOT / path).is_dir():
            yield path


def gather(pages):
    """The pages, and what they link to; a folder without a page of its own gets a list of its files."""
    files = tracked()
    texts = {path for path in files if path.suffix == ".md"}
    wanted = texts | {path for page in texts for path in linked(page, files)}
    for folder in {path for path in wanted if (ROOT / path).is_dir() and path / "README.md" not in files}:
        inside = sorted(path for path in files if path.parent == folder)
        wanted |= set(inside)
        (pages / folder).mkdir(parents=True, exist_ok=True)
        (pages / folder / "README.md").write_text(
            f"# {folder}\n\n" + NOTEBOOK.sub(r"\1.md)", "".join(f"- [{path.name}]({path.name})\n" for path in inside)))
    for path in wanted & files:
        (pages / path).parent.mkdir(parents=True, exist_ok=True)
        if path.suffix == ".md":
            (pages / path).write_text(NOTEBOOK.sub(r"\1.md)", (ROOT / path).read_text()))
        elif path.suffix != ".ipynb":
            shutil.copy(ROOT / path, pages / path)


def execute(notebook, clone):
    """The notebook with what its cells show, run in a copy of the examples, beside all else of the repository."""
    shutil.copytree(ROOT / "examples", clone / "examples")
    for beside in ("runs", "targets", "tests"):
        (clone / beside).symlink_to(ROOT / beside)
    read = nbformat.read(notebook, as_version=4)
    nbclient.NotebookClient(read, kernel_name="python3", timeout=None,
                            resources={"metadata": {"path": str(clone / "examples")}}).execute()
    shutil.rmtree(clone)
    return read


def show_notebooks(pages, clone):
    for notebook in sorted((ROOT / "examples").glob("*.ipynb")):
        text, more = nbconvert.MarkdownExporter().from_notebook_node(
            execute(notebook, clone), {"output_files_dir": notebook.stem})
        (pages / "examples" / notebook.stem).mkdir(parents=True, exist_ok=True)
        (pages / "examples" / f"{notebook.stem}.md").write_text(text)
        for name, figure in more["outputs"].items():
            (pages / "examples" / name).write_bytes(figure)


def mend_bars(site):
    """In a table a bar is written as \\|, which Python-Markdown leaves as it is in code."""
    for page in site.rglob("*.html"):
        text = page.read_text()
        page.write_text(re.sub("<code>[^<]*</code>", lambda code: code[0].replace("\\|", "|"), text))


def broken(site):
    """Links within the site to what is not there."""
    anchors = {}

    def names(path):
        if path not in anchors:
            anchors[path] = set(re.findall(r'\bid="([^"]+)"', path.read_text())) if path.suffix == ".html" else set()
        return anchors[path]

    for page in sorted(site.rglob("*.html")):
        if page.name == "404.html":
            continue
        for link in re.findall(r'(?:href|src)="([^"]+)"', page.read_text()):
            target, _, anchor = html.unescape(link).partition("#")
            if re.match(r"[a-z]+:", target):
                continue
            path = Path(os.path.normpath(page.parent / target)) if target else page
            path = path / "index.html" if path.is_dir() else path
            if not path.exists() or (anchor and path.suffix == ".html" and anchor not in names(path)):
                yield f"{page.relative_to(site)}: {link}"


def main():
    place = Path(sys.argv[1]).resolve()
    pages, site = place / "pages", place / "site"
    shutil.rmtree(place, ignore_errors=True)
    pages.mkdir(parents=True)
    gather(pages)
    show_notebooks(pages, place / "clone")
    settings = place / "mkdocs.yml"
    settings.write_text(SETTINGS.format(pages=pages, site=site) + NAVIGATION)
    built = subprocess.run(["mkdocs", "build", "--config-file", str(settings)], stderr=subprocess.PIPE, text=True)
    if built.returncode:
        sys.exit("\n".join(line for line in built.stderr.splitlines() if "INFO" not in line))
    mend_bars(site)
    faults = list(broken(site))
    print("\n".join(faults) or f"site: OK, {len(list(site.rglob('*.html')))} pages in {site}")
    sys.exit(bool(faults))


main()
