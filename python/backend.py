# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds wheels and source archives, by make and the standard library alone: what pip calls (PEP 517).

A wheel holds the shared library and what it needs beside the C library (GSL, NLopt, cJSON, expat, libgomp),
found by the run path $ORIGIN. An archive has the sources of the library in `source`; the tests are in
clones alone.
"""

from __future__ import annotations

import base64
import hashlib
import io
import os
import re
import subprocess
import sys
import sysconfig
import tarfile
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
SOURCE = HERE / "source" if (HERE / "source" / "Makefile").exists() else HERE.parent

#: Libraries of every Linux, which no wheel may bring along.
SYSTEM = re.compile(r"^(ld-linux.*|lib(c|m|mvec|pthread|dl|rt|util|resolv)\.so.*)$")


def version() -> str:
    return subprocess.run([str(SOURCE / "src" / "base" / "version.sh")], capture_output=True,
                          text=True, check=True).stdout.strip()


def metadata() -> str:
    project = (HERE / "pyproject.toml").read_text()

    def value(key: str) -> str:
        return re.search(rf'^{key} = "(.*)"', project, re.M).group(1)
    lines = ["Metadata-Version: 2.1", f"Name: {value('name')}", f"Version: {version()}",
             f"Summary: {value('description')}", "License: GPL-3.0-or-later",
             f"Requires-Python: {value('requires-python')}"]
    inside = re.search(r"^dependencies = \[(.*)\]", project, re.M).group(1)
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


def libraries() -> dict[str, bytes]:
    """Names in the wheel, and contents."""
    make("wheel-library")
    own = next((SOURCE / "build" / "wheel").glob("libmesofit.so.*"))
    soname = {path: path.name for path in [own, *needed(own)]}
    return {f"mesofit/lib/{name}": path.read_bytes() for path, name in soname.items()}


# Wheels -------------------------------------------------------------------------------------------

def write_wheel(directory: str, files: dict[str, bytes]) -> str:
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    tag, name = f"py3-none-{platform}", f"mesofit-{version()}"
    information = f"{name}.dist-info"
    files = {**files, f"{information}/METADATA": metadata().encode(),
             f"{information}/LICENSE": (SOURCE / "LICENSE").read_bytes(),
             f"{information}/WHEEL": (f"Wheel-Version: 1.0\nGenerator: mesofit\n"
                                      f"Root-Is-Purelib: false\nTag: {tag}\n").encode()}
    record = []
    path = Path(directory) / f"{name}-{tag}.whl"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        def put(inside: str, content: bytes) -> None:
            about = zipfile.ZipInfo(inside, (2000, 1, 1, 0, 0, 0))  # the same files, the same wheel
            about.compress_type = zipfile.ZIP_DEFLATED
            about.external_attr = (0o755 if "/lib/" in inside else 0o644) << 16
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
    return write_wheel(wheel_directory, {**package, **libraries()})


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    make("all")
    return write_wheel(wheel_directory, {"mesofit.pth": f"{HERE}\n".encode()})


# Source archives ----------------------------------------------------------------------------------

#: What the library is built of, beside the package.
SOURCES = ("Makefile", "LICENSE", "README.md", "mesofit.pc.in", "include", "src", "plots", "share")


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
