#!/usr/bin/python3
"""tools/bench compares stage by stage, warns of what is slower, and says whether the meshes are the same. usage: bench_test.py PATH_OF_BENCH

No time is measured here: the programs are stand-ins that write the seconds they are told.
"""
import pathlib
import stat
import subprocess
import sys
import tempfile
import unittest

BENCH = ""

STAND_IN = """#!/usr/bin/python3
import json, sys
stats, mesh = sys.argv[sys.argv.index("--stats") + 1], sys.argv[sys.argv.index("-o") + 1]
json.dump({{"stage_seconds": {seconds}, "stage_busy_share": {{"envelope": 0.5}}, "peak_memory_bytes": 5e7}}, open(stats, "w"))
open(mesh, "w").write({mesh!r})
sys.exit({status})
"""


class Bench(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def program(self, name: str, seconds: dict, mesh: str = "mesh", status: int = 0) -> str:
        path = pathlib.Path(self.folder.name, name)
        path.write_text(STAND_IN.format(seconds=seconds, mesh=mesh, status=status))
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        return str(path)

    def bench(self, *arguments: str) -> subprocess.CompletedProcess:
        return subprocess.run([BENCH, *arguments, "--cases", "cessna", "--runs", "1", "--threads", "2", "--limit", "15"], capture_output=True, text=True, check=False)

    def test_equal_programs_give_no_warning_of_a_stage(self):
        program = self.program("a", {"envelope": 2.0, "prisms": 0.1})
        done = self.bench(program, program)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("cessna: same bytes, memory 50 -> 50 MB", done.stdout)
        self.assertIn("| envelope | 2.00 | 2.00 | 1.00 | 2.00 | 2.00 | 1.00 |", done.stdout)
        self.assertIn("| stages below 0.3 s | 0.10 | 0.10 | 1.00 |", done.stdout)
        self.assertNotIn("cessna, envelope", done.stdout)

    def test_a_slower_stage_is_a_warning_and_with_strict_an_error(self):
        base, head = self.program("a", {"envelope": 2.0, "engine": 1.0}), self.program("b", {"envelope": 2.5, "engine": 1.1}, mesh="other")
        done = self.bench(base, head)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("warning: slower by more than 15 %: cessna, envelope: 2.00 -> 2.50 s, 1.25 times", done.stdout)
        self.assertNotIn("cessna, engine", done.stdout)
        self.assertIn("other bytes", done.stdout)
        self.assertEqual(self.bench(base, head, "--strict").returncode, 1)

    def test_a_mesh_with_failing_gates_counts_and_a_missing_one_does_not(self):
        good = self.program("a", {"envelope": 1.0})
        self.assertEqual(self.bench(good, self.program("b", {"envelope": 1.0}, status=4)).returncode, 0)
        crash = pathlib.Path(self.folder.name, "c")
        crash.write_text("#!/bin/sh\necho it broke >&2\nexit 1\n")
        crash.chmod(0o755)
        done = self.bench(good, str(crash))
        self.assertEqual(done.returncode, 1)
        self.assertIn("it broke", done.stderr)

    def test_unknown_cases_and_revisions_are_errors(self):
        self.assertIn("there is no case zeppelin", subprocess.run([BENCH, "HEAD", "--cases", "zeppelin"], capture_output=True, text=True, check=False).stderr)
        self.assertIn("error: git", self.bench("no_such_revision").stderr)


if __name__ == "__main__":
    BENCH = str(pathlib.Path(sys.argv[1]).resolve())
    unittest.main(argv=sys.argv[:1])
