# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds wheels and source archives, by make and the standard library alone: what pip calls (PEP 517).

What is compiled is the Makefile's; another backend would say it a second time. A wheel holds the shared library, the
program and what both need beside the C library (GSL, NLopt, cJSON, expat, zlib, zstd, libgomp) with their licences, found
by the run path $ORIGIN; its name says which C library it asks for (PEP 600). An archive has the sources of the
library in `source`; the tests are in clones alone.
"""

from __future__ import annotations

import base64
import hashlib
import io
import os
import re
import stat
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
SOURCE = HERE / "source" if (HERE / "source" / "Makefile").exists() else HERE.parent

#: Libraries of every Linux, which no wheel may bring along (PEP 600).
SYSTEM = re.compile(r"^(ld-linux.*|lib(c|m|mvec|pthread|dl|rt|util|resolv|stdc\+\+|gcc_s)\.so.*)$")


def version() -> str:
    return subprocess.run([str(SOURCE / "src" / "base" / "version.sh")], capture_output=True,
                          text=True, check=True).stdout.strip()


def links() -> list[str]:
    """To pages of the repository, once CITATION.cff says where that is."""
    found = re.search(r'^repository-code: "?(https://[^"\s]+?)/?"?$', (SOURCE / "CITATION.cff").read_text(), re.M)
    if not found:
        return []
    pages = f"{found[1]}/blob/v{version().partition('+')[0]}"
    return [f"Project-URL: {name}, {address}" for name, address in (
        ("Source", found[1]), ("Documentation", f"{pages}/README.md"), ("Changelog", f"{pages}/CHANGELOG.md"))]


def metadata() -> str:
    project = (HERE / "pyproject.toml").read_text()

    def value(key: str) -> str:
        return re.search(rf'^{key} = "(.*)"', project, re.M).group(1)
    keywords = ",".join(re.findall('"(.*?)"', re.search(r"^keywords = \[(.*)\]", project, re.M).group(1)))
    lines = ["Metadata-Version: 2.1", f"Name: {value('name')}", f"Version: {version()}",
             f"Summary: {value('description')}", "Author: The mesofit authors", "License: GPL-3.0-or-later",
             f"Keywords: {keywords}",
             f"Requires-Python: {value('requires-python')}", *links()]
    inside = re.search(r"^dependencies = \[(.*)\]", project, re.M).group(1)
    lines += [f"Classifier: {known}" for known in re.findall(r'^    "(.* :: .*)",$', project, re.M)]
    lines += [f"Requires-Dist: {need}" for need in re.findall(r'"(.*?)"', inside)]
    extras = project.split("[project.optional-dependencies]")[1].split("\n[")[0]
    for extra, needs in re.findall(r"^(\w+) = \[(.*)\]", extras, re.M):
        lines.append(f"Provides-Extra: {extra}")
        lines += [f'Requires-Dist: {need}; extra == "{extra}"'
                  for need in re.findall(r'"(.*?)"', needs)]
    lines += ["Description-Content-Type: text/markdown", "", (HERE / "README.md").read_text()]
    return "\n".join(lines)


# The library --------------------------------------------------------------------------------------

def make(target: str) -> None:
    jobs = os.environ.get("MAKEFLAGS", "") or f"-j{os.cpu_count() or 1}"
    environment = {**os.environ, "MAKEFLAGS": jobs}
    subprocess.run(["make", "-C", str(SOURCE), target], env=environment, check=True,
                   stdout=sys.stderr)


def needed(library: Path) -> list[Path]:
    """What it is linked with, but for what every Linux has."""
    listed = subprocess.run(["ldd", str(library)], capture_output=True, text=True,
                            check=True).stdout
    found = dict(re.findall(r"^\s*(\S+) => (/\S+)", listed, re.M))
    return [Path(path) for name, path in sorted(found.items()) if not SYSTEM.match(name)]


def binaries() -> dict[str, Path]:
    """Names in the wheel, and files: the library, the program, and what they need."""
    make("wheel-files")
    built = SOURCE / "build" / "wheel"
    own = [next(built.glob("libmesofit.so.*")), built / "mesofit"]
    return {path.name: path for path in [*own, *sorted({other for path in own for other in needed(path)})]}


def licence(library: Path) -> bytes:
    """What Debian says of the package that a library is of."""
    listed = subprocess.run(["dpkg-query", "--search", f"*/{library.resolve().name}"], capture_output=True, text=True,
                            check=True).stdout
    return Path(f"/usr/share/doc/{listed.split(':')[0]}/copyright").read_bytes()


def glibc(paths: list[Path]) -> str:
    """The newest version of the C library that one of these asks for, "2_36"."""
    asked = subprocess.run(["objdump", "-T", *map(str, paths)], capture_output=True, text=True, check=True).stdout
    newest = max(tuple(map(int, found)) for found in re.findall(r"GLIBC_(\d+)\.(\d+)", asked))
    return "{}_{}".format(*newest)


# Wheels -------------------------------------------------------------------------------------------

def write_wheel(directory: str, files: dict[str, bytes], system: str = "linux") -> str:
    tag, name = f"py3-none-{system}_{os.uname().machine}", f"mesofit-{version()}"
    information = f"{name}.dist-info"
    files = {**files, f"{information}/METADATA": metadata().encode(),
             f"{information}/entry_points.txt": b"[console_scripts]\nmesofit = mesofit._program:main\n",
             f"{information}/licenses/LICENSE": (SOURCE / "LICENSE").read_bytes(),
             f"{information}/WHEEL": (f"Wheel-Version: 1.0\nGenerator: mesofit\n"
                                      f"Root-Is-Purelib: false\nTag: {tag}\n").encode()}
    record = []
    path = Path(directory) / f"{name}-{tag}.whl"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        def put(inside: str, content: bytes) -> None:
            about = zipfile.ZipInfo(inside, (2000, 1, 1, 0, 0, 0))  # the same files, the same wheel
            about.compress_type = zipfile.ZIP_DEFLATED
            # pip keeps what may be run of regular files alone.
            about.external_attr = (stat.S_IFREG | (0o755 if "/lib/" in inside else 0o644)) << 16
            archive.writestr(about, content)
        for inside, content in sorted(files.items()):
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=")
            record.append(f"{inside},sha256={digest.decode()},{len(content)}")
            put(inside, content)
        record.append(f"{information}/RECORD,,")
        put(f"{information}/RECORD", ("\n".join(record) + "\n").encode())
    return path.name


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    information = Path(metadata_directory) / f"mesofit-{version()}.dist-info"
    information.mkdir(parents=True, exist_ok=True)
    (information / "METADATA").write_text(metadata())
    return information.name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    package = {f"mesofit/{path.name}": path.read_bytes()
               for path in sorted((HERE / "mesofit").iterdir())
               if path.suffix == ".py" or path.name == "py.typed"}
    files = binaries()
    package |= {f"mesofit/lib/{name}": path.read_bytes() for name, path in files.items()}
    package |= {f"mesofit/share/mesofit/plots/{path.name}": path.read_bytes()
                for path in sorted((SOURCE / "plots").glob("*.gp"))}
    package |= {f"mesofit-{version()}.dist-info/licenses/{name}.txt": licence(path)
                for name, path in files.items() if "mesofit" not in name}
    return write_wheel(wheel_directory, package, f"manylinux_{glibc([*files.values()])}")


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    make("all")
    return write_wheel(wheel_directory, {"mesofit.pth": f"{HERE}\n".encode()})


# Source archives ----------------------------------------------------------------------------------

#: What the library is built of, beside the package.
SOURCES = ("Makefile", "LICENSE", "CITATION.cff", "README.md", "mesofit.pc.in", "include", "src", "plots", "share")


def build_sdist(sdist_directory, config_settings=None):
    name = f"mesofit-{version()}"
    path = Path(sdist_directory) / f"{name}.tar.gz"

    def clean(about):
        about.uid = about.gid = 0
        about.uname = about.gname = ""
        kept = not re.search(r"__pycache__|\.o$|\.d$|/build(/|$)", about.name)
        return about if kept else None
    with tarfile.open(path, "w:gz", format=tarfile.PAX_FORMAT) as archive:
        for own in ("pyproject.toml", "README.md", "backend.py", "mesofit"):
            archive.add(HERE / own, f"{name}/{own}", filter=clean)
        for source in SOURCES:
            archive.add(SOURCE / source, f"{name}/source/{source}", filter=clean)
        for inside, text in (("PKG-INFO", metadata()), ("source/version", version())):
            about = tarfile.TarInfo(f"{name}/{inside}")
            about.size = len(text.encode())
            archive.addfile(about, io.BytesIO(text.encode()))
    return path.name
