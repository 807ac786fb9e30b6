#!/usr/bin/python3
"""count_skips counts what skipped itself and fails on it only where data are required. usage: count_skips_test.py PATH_OF_COUNT_SKIPS"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

COUNT = ""


def results(*outcomes: str) -> str:
    tests = [{"name": f"t{i}", "result": outcome, **({"skipped": [{"message": "a_test.cpp:3\nneeds data"}]} if outcome == "SKIPPED" else {})}
             for i, outcome in enumerate(outcomes)]
    return json.dumps({"testsuites": [{"name": "S", "testsuite": tests}]})


class CountSkips(unittest.TestCase):
    def run_count(self, required: str, **files: str) -> subprocess.CompletedProcess:
        with tempfile.TemporaryDirectory() as folder:
            for name, text in files.items():
                pathlib.Path(folder, name + ".json").write_text(text)
            return subprocess.run([COUNT, folder], capture_output=True, text=True, check=False, env={**os.environ, "STERNA_REQUIRE_DATA": required})

    def test_counts_over_files(self):
        result = self.run_count("0", a=results("COMPLETED", "SKIPPED"), b=results("SKIPPED"))
        self.assertEqual(result.returncode, 0)
        self.assertIn("3 single tests ran, 2 of them skipped themselves", result.stdout)
        self.assertIn("skipped a: S.t1 (needs data)", result.stdout)

    def test_required_data_allow_no_skip(self):
        self.assertEqual(self.run_count("1", a=results("COMPLETED", "SKIPPED")).returncode, 1)
        self.assertEqual(self.run_count("1", a=results("COMPLETED")).returncode, 0)

    def test_a_torn_result_is_an_error(self):
        self.assertNotEqual(self.run_count("0", a='{"testsuites": [').returncode, 0)


if __name__ == "__main__":
    COUNT = str(pathlib.Path(sys.argv[1]).resolve())
    unittest.main(argv=sys.argv[:1])
