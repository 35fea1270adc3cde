#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_wheel.py WHEEL…: what auditwheel would say (Debian does not have it), by PEP 600: a wheel named
manylinux_2_N asks for no newer symbol of the C library than 2.N, needs no library but those of every Linux and
its own, finds its own beside itself, and has the licence of each."""

import re
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

#: Of the list in PEP 599 and 600, those that are not for windows or sound.
SYSTEM = {"libc.so.6", "libm.so.6", "libmvec.so.1", "libpthread.so.0", "libdl.so.2", "librt.so.1", "libresolv.so.2",
          "libutil.so.1", "libgcc_s.so.1", "libstdc++.so.6", "ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1"}


def said(*words):
    return subprocess.run(words, check=True, capture_output=True, text=True).stdout


def faults_of(wheel, place):
    """One line a broken rule."""
    name = re.search(r"-py3-none-manylinux_(\d+)_(\d+)_\w+\.whl$", wheel.name)
    if name is None:
        yield f"{wheel.name}: not named manylinux"
        return
    allowed = tuple(map(int, name.groups()))
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(place)
    binaries = sorted(path for path in place.rglob("*") if path.is_file() and path.read_bytes()[:4] == b"\x7fELF")
    own = {path.name for path in binaries}
    if not binaries:
        yield f"{wheel.name}: nothing compiled in it"
    for path in binaries:
        dynamic, symbols = said("readelf", "-d", path), said("objdump", "-T", path)
        for needed in re.findall(r"\(NEEDED\).*\[(.*)\]", dynamic):
            if needed not in SYSTEM | own:
                yield f"{path.name}: needs {needed}, which is not in the wheel"
        for found in sorted(set(re.findall(r"GLIBC_(\d+)\.(\d+)", symbols)), key=lambda v: tuple(map(int, v))):
            if tuple(map(int, found)) > allowed:
                yield f"{path.name}: asks for GLIBC_{'.'.join(found)}"
        for run_path in re.findall(r"\((?:RPATH|RUNPATH)\).*\[(.*)\]", dynamic):
            if run_path != "$ORIGIN":
                yield f"{path.name}: looks for libraries in {run_path}"
        licences = [f"{path.name}.txt"] if "mesofit" not in path.name else ["LICENSE"]
        if not list(place.glob(f"*.dist-info/licenses/{licences[0]}")):
            yield f"{path.name}: without its licence"


def main():
    faults = []
    for wheel in map(Path, sys.argv[1:]):
        with tempfile.TemporaryDirectory() as place:
            faults += faults_of(wheel, Path(place))
    print("\n".join(faults) or "wheels: OK")
    sys.exit(bool(faults) or len(sys.argv) < 2)


main()
