#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A small fit by LAMMPS that is killed at random moments: the program by SIGINT, SIGTERM and SIGKILL,
or the engine alone. After --resume its results must have the bits of the fit that nobody killed, and
no engine may be left running. Slow: some minutes; not part of `make check`.

    [ENGINE="mpirun -np 2 lmp"] tests/tools/engine_kills.py build/mesofit [KILLS] [SEED]
"""

import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PROGRAM = os.path.realpath(sys.argv[1])
KILLS = int(sys.argv[2]) if len(sys.argv) > 2 else 20
ENGINE = os.environ.get("ENGINE", "lmp")
RANDOM = random.Random(int(sys.argv[3]) if len(sys.argv) > 3 else 1)
SETUP = {"box": [5, 5, 5], "time_step": 0.02, "particles": {"count": 250}}
TRUTH = {"seed": 3, **SETUP, "conservative": {"law": "soft-repulsion", "a": 25},
         "dissipative": {"law": "power", "sigma": 3}, "rdf": {"range": 1.2, "bins": 30},
         "measure": {"equilibration": 300, "samples": 200, "every": 20}}
RUN = {"seed": 4, "scene": SETUP,
       "target": {"rdf": {"file": "truth/rdf.tsv", "errors_of": "samples"}},
       "verification": {"by": "engine", "replicas": 2, "equilibration": 40, "samples": 10,
                        "every": 20},
       "engine": {"name": "lammps", "time_step": 0.005, "steps": 20},
       "method": {"name": "auto", "replicas": 3, "equilibration": 10, "samples": 20,
                  "precision": 0.1, "iterations": 3}}
WAYS = [signal.SIGINT, signal.SIGTERM, signal.SIGKILL, None]  # None: the engine alone


def fit(folder, *words):
    return subprocess.Popen([PROGRAM, "fit", "run.json", "-o", folder, "--engine", ENGINE, "--threads",
                             "2", "--quiet", *words], stderr=subprocess.PIPE, text=True)


def engines():
    """Processes that work in a folder of pieces."""
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            place = os.readlink(process / "cwd")
        except OSError:
            continue
        if place.startswith(os.path.join(os.getcwd(), "out", "engine")):
            found.append(int(process.name))
    return found


def has_ended():
    """Whether there is a result that is no interrupted one."""
    try:
        return json.loads(Path("out/summary.json").read_text())["status"] != "interrupted"
    except (OSError, ValueError, KeyError):
        return False


def same():
    tables = ("potential.tsv", "rdf.tsv", "history.tsv")
    return [name for name in tables
            if not Path("out", name).exists()
            or Path("out", name).read_bytes() != Path("whole", name).read_bytes()]


def kill_once(way, moment):
    """Returns the exit code, the processes left, how often it was resumed, what it said last."""
    shutil.rmtree("out", ignore_errors=True)
    process = fit("out")
    time.sleep(moment)
    if way is None:
        for engine in engines()[:1]:
            os.kill(engine, signal.SIGKILL)
    elif process.poll() is None:
        process.send_signal(way)
    said = process.communicate()[1]
    end = time.monotonic() + 5  # mpirun needs its time
    while engines() and time.monotonic() < end:
        time.sleep(0.1)
    left = engines()
    for engine in left:
        os.kill(engine, signal.SIGKILL)
    again = 0
    while not has_ended() and again < 4:
        again += 1
        said = fit("out", "--resume").communicate()[1]
    return process.returncode, left, again, said.strip().splitlines()[-1:]


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        Path("truth.json").write_text(json.dumps(TRUTH))
        Path("run.json").write_text(json.dumps(RUN))
        subprocess.run([PROGRAM, "simulate", "truth.json", "-o", "truth", "--quiet"], check=True)
        begun = time.monotonic()
        fit("whole").communicate()
        took = time.monotonic() - begun
        print(f"undisturbed: {took:.1f} s", flush=True)
        faults = 0
        for n in range(KILLS):
            way = WAYS[n % len(WAYS)]
            moment = RANDOM.uniform(0, took)
            code, left, again, said = kill_once(way, moment)
            differ = same()
            faults += bool(differ or left)
            name = way.name if way else "the engine"
            print(f"{n + 1}: {name} after {moment:.1f} s, exit code {code}, resumed {again} times, "
                  + (f"others: {differ} {said}" if differ else "same bits")
                  + (f", left running: {left}" if left else ""), flush=True)
        print(f"{faults} of {KILLS} kills left something else")
        os.chdir("/")
        return faults > 0


sys.exit(main())
