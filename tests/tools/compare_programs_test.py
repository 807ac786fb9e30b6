#!/usr/bin/python3
"""tools/compare_programs reports files that differ, files that are missing, and runs that are ended. usage: compare_programs_test.py PATH_OF_COMPARE_PROGRAMS

The programs are stand-ins that write a given mesh.
"""
import pathlib
import stat
import subprocess
import sys
import tempfile
import unittest

COMPARE = ""

STAND_IN = """#!/usr/bin/python3
import sys, time
if "--help" in sys.argv or "manual" in sys.argv:
    print("  mesh    meshes")
    sys.exit()
time.sleep({seconds})
open("mesh.su2", "w").write({mesh!r})
if {has_more}:
    open("more.vtu", "w").write("more")
open("series.csv", "w").write("case,cells,seconds\\na,{cells},%f\\n" % time.time())
open("measure.json", "w").write('{{"cells": {cells}, "stage_seconds": {{"read": %f}}, "peak_memory_bytes": %d}}' % (time.time(), time.time_ns()))
open(".lock", "w").write(str(time.time_ns()))
"""


class Comparison(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def program(self, name: str, mesh: str = "mesh", seconds: float = 0.0, has_more: bool = False, cells: int = 12) -> str:
        path = pathlib.Path(self.folder.name, name)
        path.write_text(STAND_IN.format(mesh=mesh, seconds=seconds, has_more=has_more, cells=cells))
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        return str(path)

    def compare(self, old: str, new: str, *more: str) -> subprocess.CompletedProcess:
        folder = pathlib.Path(self.folder.name, "compared")
        return subprocess.run([COMPARE, old, new, "script_01*", "--folder", str(folder), "--threads", "1,2", *more], capture_output=True, text=True, check=False)

    def test_equal_programs_have_equal_files(self):
        done = self.compare(self.program("a"), self.program("b"))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("1 items, 8 files compared, 0 differ", done.stdout)  # exit status, mesh, table and figures, for two numbers of threads

    def test_another_byte_is_reported(self):
        done = self.compare(self.program("a"), self.program("b", mesh="mess"))
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("2 threads: mesh.su2 differs", done.stdout)

    def test_figures_beside_times_are_compared(self):
        done = self.compare(self.program("a"), self.program("b", cells=13))
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("1 threads: series.csv differs", done.stdout)
        self.assertIn("1 threads: measure.json differs", done.stdout)

    def test_a_file_of_one_program_is_reported(self):
        done = self.compare(self.program("a"), self.program("b", has_more=True))
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("more.vtu is only written by the new program", done.stdout)

    def test_an_ended_run_is_no_success(self):
        done = self.compare(self.program("a", seconds=30.0), self.program("b"), "--seconds", "1")
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn("not compared", done.stdout)


if __name__ == "__main__":
    COMPARE = sys.argv.pop()
    unittest.main()
