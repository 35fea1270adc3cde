#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Damaged and foreign requests to the live view beside a running fit.

live_requests.py COUNT [SEED]: the fit must leave the same bytes as one that nobody disturbs, no request may end the
program, and its memory and open files must stay. With MESOFIT a program under sanitizers, they have a word, too."""
import collections
import json
import os
import random
import socket
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "live"))
from served import Served, differences, make_folder, run_plain, water_fit  # noqa: E402

PATHS = ["/", "/app.js", "/api/state", "/api/text", "/api/topics", "/api/particles?after=0", "/api/files?path=out",
         "/api/files?in=result", "/api/file?path=run.json", "/api/file?in=result&path=history.tsv", "/api/zip?in=result",
         "/api/file?path=../../etc/passwd", "/api/file?path=%2e%2e/%2e%2e/x", "/api/files?in=now", "/api/wish",
         "/api/open?path=scene.json", "/api/start?force=1", "/api/file?path=fuzz.tsv&replace=1", "/api/nothing", "*", ""]
BODIES = [b"", b'{"wish": "pause"}', b'{"wish": "go"}', b'{"wish": "step", "steps": 3}', b'{"wish": "speed", "speed": 1e6}',
          b'{"wish": "change", "temperature": 2}', b'{"wish": "change", "time_step": -1, "temperature": "x"}', b'{"wish": "change"}',
          b"{", b'{"wish": 3}', b"\0\0\0", b"[" * 5000, b'{"a":' * 3000, b"\xff" * 100, b"x" * 20000]
HEADS = ["Host: localhost:1", "Host: evil.example", "Origin: http://evil.example", "Origin: http://localhost:1",
         "Content-Length: -1", "Content-Length: 99999999999999999999", "Transfer-Encoding: chunked", "Expect: 100-continue",
         "Range: bytes=0-0,1-99999", "Connection: close", "Connection: upgrade", "X-Mesofit-Token: 0", "Cookie: a=b",
         "A" * 3000 + ": b", "Accept-Encoding: gzip, br"]


def make(chance, token):
    body = chance.choice(BODIES)
    method = chance.choice(["GET", "GET", "POST", "POST", "HEAD", "PUT", "OPTIONS", "DELETE", "get", "\x01"])
    heads = chance.sample(HEADS, chance.randint(0, 3))
    if chance.random() < 0.8:
        heads.insert(0, "Host: 127.0.0.1")
    if chance.random() < 0.6:
        heads.append("X-Mesofit-Token: " + token)
    if chance.random() < 0.8:
        heads.append(f"Content-Length: {len(body)}")
    request = f"{method} {chance.choice(PATHS)} HTTP/1.1\r\n".encode("latin1")
    request += "".join(head + "\r\n" for head in heads).encode("latin1") + b"\r\n" + body
    if chance.random() < 0.5:  # damage some bytes, or the end
        damaged = bytearray(request)
        for _ in range(chance.randint(1, 8)):
            damaged[chance.randrange(len(damaged))] = chance.randrange(256)
        request = bytes(damaged[:chance.randint(1, len(damaged))] if chance.random() < 0.3 else damaged)
    return request


def send(port, request, patience):
    """What the server says to a request: a code, or that it says nothing."""
    with socket.create_connection(("127.0.0.1", port), timeout=10) as connection:
        connection.settimeout(patience)
        try:
            connection.sendall(request)
            connection.shutdown(socket.SHUT_WR)
            answer = connection.recv(4096)
        except OSError:
            return "no answer"
    return answer[9:12].decode("latin1") if answer.startswith(b"HTTP/1.1 ") else "no answer"


def measure(process):
    """Resident memory [kB] and open files."""
    with open(f"/proc/{process.pid}/status", encoding="ascii") as file:
        memory = next(int(line.split()[1]) for line in file if line.startswith("VmRSS"))
    return memory, len(os.listdir(f"/proc/{process.pid}/fd"))


def main():
    count, chance = int(sys.argv[1]), random.Random(int(sys.argv[2]) if len(sys.argv) > 2 else 1)
    with tempfile.TemporaryDirectory() as folder:
        make_folder(folder)
        with open(os.path.join(folder, "run.json"), "w", encoding="utf-8") as file:
            json.dump(water_fit(max(3, count // 8000)), file)
        plain = run_plain(folder, "fit", "run.json", "-o", "plain", "--threads", "1")
        served = Served(folder, "live", "run.json", "-o", "out", "--start", "--stay", "--threads", "1")
        told, during, first = collections.Counter(), 0, None
        for number in range(count):
            told[send(served.port, make(chance, served.token), 0.3)] += 1
            if number == count // 10:
                first = measure(served.process)
            if number % 1000 == 0:
                during = number if served.state()["phase"] in ("running", "paused") else during
                if served.process.poll() is not None:
                    sys.exit(f"the program ended after {number} requests: {served.said[-5:]}")
        last = measure(served.process)
        served.wish(wish="go")
        while served.state()["phase"] in ("running", "paused"):
            served.wish(wish="go")
        changed = differences(os.path.join(folder, "plain"), os.path.join(folder, "out"))
        code = served.end()
    print(f"{count} requests, {during} of them beside the fit (which ended with {plain}): {dict(told)}")
    print(f"memory {first[0]} kB after a tenth, {last[0]} kB at the end; open files {first[1]}, {last[1]}; exit code {code}")
    print("the fit's folder: " + (f"differs in {changed}" if changed else "the same bytes"))
    sys.exit(bool(changed) or code != 0)


if __name__ == "__main__":
    main()
