# SPDX-License-Identifier: GPL-3.0-or-later
"""`mesofit watch` on a terminal of its own."""
import fcntl
import json
import os
import pty
import re
import select
import signal
import struct
import subprocess
import tempfile
import termios
import time
import unittest

from served import PROGRAM, SCENE, make_folder, run_plain


class Watch(unittest.TestCase):
    def read(self, master, seconds):
        text, until = b"", time.time() + seconds
        while time.time() < until:
            if select.select([master], [], [], 0.1)[0]:
                try:
                    text += os.read(master, 65536)
                except OSError:
                    break
        return text.decode("utf-8", "replace")

    def test_simulation_that_runs_tells_how_far_it_is(self):
        """Steps, rate and time left agree with each other and with what is left to do; later nothing is left behind."""
        with tempfile.TemporaryDirectory() as folder:
            make_folder(folder)
            measure = {"equilibration": 200, "samples": 1000000, "every": 20}
            with open(os.path.join(folder, "long.json"), "w", encoding="utf-8") as file:
                json.dump({**SCENE, "measure": measure}, file)
            run = subprocess.Popen([PROGRAM, "simulate", "long.json", "-o", "out", "--quiet"], cwd=folder, stderr=subprocess.DEVNULL)
            until = time.time() + 60
            while not os.path.exists(os.path.join(folder, "out", "progress.json")):
                self.assertLess(time.time(), until)
                time.sleep(0.2)
            master, slave = pty.openpty()
            fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 120, 0, 0))
            watch = subprocess.Popen([PROGRAM, "watch", "out"], cwd=folder, stdin=slave, stdout=slave, stderr=subprocess.PIPE)
            text = self.read(master, 1)
            self.assertIn("out: running; last change", text)
            found = re.search(r"(\d+) of (\d+) steps \((\d+) %\), ([\d.e+]+) a second, ([\d.]+) (s|min|h) left; step \1  T ", text)
            self.assertIsNotNone(found, text)
            done, total, rate = int(found[1]), int(found[2]), float(found[4])
            left = float(found[5]) * {"s": 1, "min": 60, "h": 3600}[found[6]]
            self.assertEqual(total, measure["equilibration"] + measure["samples"] * measure["every"])
            # Two digits of the time left and three of the rate, rounded: 5 % and 0.5 % at most.
            self.assertAlmostEqual(left / ((total - done) / rate), 1, delta=0.06)
            run.send_signal(signal.SIGINT)
            self.assertEqual(run.wait(60), 130)
            self.assertNotIn(" a second", self.read(master, 2.2).split("\x1b[H")[-1])
            self.assertFalse(os.path.exists(os.path.join(folder, "out", "progress.json")))
            os.write(master, b"q")
            self.assertEqual(watch.wait(10), 0)
            watch.stderr.close()
            os.close(master)
            os.close(slave)

    def test_screen_is_drawn_follows_the_size_and_quits_with_q(self):
        with tempfile.TemporaryDirectory() as folder:
            make_folder(folder)
            self.assertEqual(run_plain(folder, "simulate", "scene.json", "-o", "out"), 0)
            master, slave = pty.openpty()
            fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 80, 0, 0))
            before = termios.tcgetattr(slave)
            process = subprocess.Popen([PROGRAM, "watch", "out"], cwd=folder, stdin=slave, stdout=slave, stderr=subprocess.PIPE)
            text = self.read(master, 1.5)
            self.assertTrue(text.startswith("\x1b[?1049h\x1b[?25l"))
            self.assertIn("out: ok; last change", text)
            self.assertIn("temperature, by step [T_0]", text)
            self.assertTrue(any("\u2801" <= letter <= "\u28ff" for letter in text))
            screen = text.split("\x1b[H")[1]
            lines = screen.split("\x1b[K\r\n")
            self.assertLessEqual(len(lines), 24)
            self.assertLessEqual(max(len(line) for line in lines[:-1]), 80)
            fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 12, 40, 0, 0))
            self.read(master, 1.2)
            lines = self.read(master, 1.5).split("\x1b[H")[1].split("\x1b[K\r\n")
            self.assertLessEqual(max(len(line) for line in lines[:-1]), 40)
            os.write(master, b"q")
            self.assertEqual(process.wait(10), 0)
            self.assertIn("\x1b[?25h\x1b[?1049l", self.read(master, 0.3))
            self.assertEqual(termios.tcgetattr(slave), before)
            self.assertEqual(process.stderr.read(), b"")
            process.stderr.close()
            os.close(master)
            os.close(slave)


if __name__ == "__main__":
    unittest.main()
