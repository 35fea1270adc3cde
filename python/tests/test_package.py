# SPDX-License-Identifier: GPL-3.0-or-later
"""What pip makes of the package: a wheel that needs nothing beside it, an archive that can be built."""

import os
import re
import shutil
import stat
import subprocess
import sys
import tarfile
import zipfile

import pytest
from conftest import ROOT

sys.path.insert(0, str(ROOT / "python"))

import backend  # noqa: E402

BARE = {key: os.environ[key] for key in ("PATH", "HOME") if key in os.environ}


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """A wheel, unpacked as pip would do it."""
    place = tmp_path_factory.mktemp("wheel")
    name = backend.build_wheel(str(place))
    with zipfile.ZipFile(place / name) as archive:
        archive.extractall(place / "installed")
        for about in archive.infolist():
            if stat.S_ISREG(about.external_attr >> 16):
                (place / "installed" / about.filename).chmod(0o777 & about.external_attr >> 16)
    return place / "installed"


def test_wheel_works_on_its_own(wheel):
    code = "import mesofit; print(mesofit.__file__, mesofit.__version__)"
    done = subprocess.run([sys.executable, "-c", code], cwd=wheel, capture_output=True, text=True,
                          env=BARE, check=True)
    assert done.stdout.split() == [str(wheel / "mesofit" / "__init__.py"), backend.version()]


def test_wheel_brings_what_the_library_needs(wheel):
    library = next((wheel / "mesofit" / "lib").glob("libmesofit.so.*"))
    listed = subprocess.run(["ldd", str(library)], capture_output=True, text=True, check=True,
                            env=BARE).stdout
    for name, path in re.findall(r"^\s*(\S+) => (\S+)", listed, re.M):
        assert path.startswith(str(wheel)) or backend.SYSTEM.match(name), (name, path)


def test_wheel_has_all_modules(wheel):
    for path in (ROOT / "python" / "mesofit").glob("*.py"):
        assert (wheel / "mesofit" / path.name).read_bytes() == path.read_bytes()
    assert (wheel / "mesofit" / "py.typed").exists()


def test_wheel_has_the_program(wheel):
    code = "import mesofit._program as p; p.main()"
    done = subprocess.run([sys.executable, "-c", code, "--version"], cwd=wheel, capture_output=True,
                          text=True, env=BARE, check=True)
    assert done.stdout == f"mesofit {backend.version()}\n"
    assert list((wheel / "mesofit" / "share" / "mesofit" / "plots").glob("*.gp"))


def test_wheel_keeps_the_rules_of_its_name(wheel):
    archive = next(wheel.parent.glob("*.whl"))
    subprocess.run([ROOT / "packaging" / "check_wheel.py", archive], check=True)


def test_archive_has_all_sources(tmp_path):
    name = backend.build_sdist(str(tmp_path))
    with tarfile.open(tmp_path / name) as archive:
        archive.extractall(tmp_path)
    inside = tmp_path / name.removesuffix(".tar.gz")
    subprocess.run(["make", "-n", "-C", str(inside / "source"), "wheel-files"], check=True,
                   capture_output=True, env=BARE)
    for folder in ("include", "src", "share"):
        for path in (ROOT / folder).rglob("*.[ch]"):
            assert (inside / "source" / path.relative_to(ROOT)).exists(), path
    code = "import backend; print(backend.version())"
    done = subprocess.run([sys.executable, "-c", code], cwd=inside, capture_output=True, text=True,
                          check=True)
    assert done.stdout.strip() == backend.version()


def test_links_are_to_where_the_repository_is(monkeypatch, tmp_path):
    monkeypatch.setattr(backend, "SOURCE", tmp_path)
    monkeypatch.setattr(backend, "version", lambda: "1.2.3+4.g5678")
    (tmp_path / "CITATION.cff").write_text("type: software\nversion: 1.2.3\n")
    assert backend.links() == []
    with (tmp_path / "CITATION.cff").open("a") as citation:
        citation.write('repository-code: "https://code.example/mesofit"\n')
    assert backend.links() == ["Project-URL: Source, https://code.example/mesofit",
                               "Project-URL: Documentation, https://code.example/mesofit/blob/v1.2.3/README.md",
                               "Project-URL: Changelog, https://code.example/mesofit/blob/v1.2.3/CHANGELOG.md"]


@pytest.fixture
def clone(tmp_path):
    """A clone of two files, and what runs Git in it."""
    for file in ("include/mesofit.h", "src/base/version.sh"):
        (tmp_path / file).parent.mkdir(parents=True)
        shutil.copy(ROOT / file, tmp_path / file)

    def git(*words):
        return subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@b.c", *words],
                              cwd=tmp_path, check=True, capture_output=True, text=True).stdout

    git("init", "-q")
    git("add", ".")
    git("commit", "-qm", "one")
    return tmp_path, git


def says(place):
    return subprocess.run([str(place / "src" / "base" / "version.sh")], check=True,
                          capture_output=True, text=True).stdout.strip()


def test_version_names_the_commit_between_releases(clone):
    place, git = clone
    release = re.search(r'MESOFIT_VERSION "(.*)"', (place / "include/mesofit.h").read_text())[1]
    commit = git("rev-parse", "--short", "HEAD").strip()
    assert says(place) == f"{release}+g{commit}"
    git("tag", f"v{release}")
    assert says(place) == release
    (place / "include/mesofit.h").open("a").write("\n")
    assert says(place) == f"{release}+dirty"
    git("commit", "-qam", "two")
    commit = git("rev-parse", "--short", "HEAD").strip()
    assert says(place) == f"{release}+1.g{commit}"
    (place / "include/mesofit.h").open("a").write("\n")
    assert says(place) == f"{release}+1.g{commit}.dirty"
    (place / "version").write_text("1.2.3+4.g5678")
    assert says(place) == "1.2.3+4.g5678"


def test_archive_without_a_clone_is_the_release(clone):
    place, _ = clone
    shutil.rmtree(place / ".git")
    assert re.fullmatch(r"\d+\.\d+\.\d+", says(place))


def test_version_is_one_of_python():
    assert re.fullmatch(r"\d+(\.\d+)*(\+[a-z0-9]+(\.[a-z0-9]+)*)?", backend.version())
