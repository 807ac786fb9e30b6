#!/usr/bin/python3
"""What `cmake --install` puts into a folder works there: both names of the program, its helper processes, the scripts, sterna.py, completion and man page. usage: install_test.py BUILD_FOLDER BOX_STL"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

BUILD, BOX = "", ""


class Install(unittest.TestCase):
    def test_installed_programs_work(self):
        with tempfile.TemporaryDirectory() as folder:
            prefix = pathlib.Path(folder, "prefix")
            subprocess.run(["cmake", "--install", BUILD, "--prefix", prefix], check=True, capture_output=True)
            work = pathlib.Path(folder, "work")
            work.mkdir()

            def run(*arguments) -> str:
                done = subprocess.run(arguments, cwd=work, capture_output=True, text=True, check=False)
                self.assertEqual(done.returncode, 0, f"{arguments}: {done.stdout}{done.stderr}")
                return done.stdout

            sterna = prefix / "bin/sterna"
            self.assertRegex(run(sterna, "--version"), r"^sterna \d")
            self.assertIn("usage: sterna pentagrow", run(prefix / "bin/pentagrow", "--help").lower())
            for engine in ("sterna", "hxt", "tetgen"):  # two are processes of their own
                run(sterna, "mesh", BOX, "--layers", "3", "--first-height", "1e-3", "--set", f"tetrahedra.engine={engine}", "--set",
                    "tetrahedra.try_other_engine=false", "-o", f"{engine}.su2")
            run(sterna, "convert", "sterna.su2", "box.cgns")
            self.assertIn("VALID", run(sterna, "check", "box.cgns"))  # read by a process of its own
            run(sterna, "check-script", prefix / "share/sterna/scripts/03_airliner.lua")  # its airfoils lie beside it

            # The installed sterna.py finds the program that came with it.
            script = "import sterna; print(sterna.find_program(), sterna.mesh('box.stl', 'python.su2', layers=2, first_height=1e-3)['verdict'])"
            (work / "box.stl").write_bytes(pathlib.Path(BOX).read_bytes())
            bare = {"PATH": "/nowhere", "PYTHONPATH": str(prefix / "share/sterna/python")}
            done = subprocess.run([sys.executable, "-B", "-c", script], cwd=work, env=bare, capture_output=True, text=True, check=False)
            self.assertEqual(done.stdout.split(), [str(sterna), "VALID"], done.stderr)
            (work / "box.stl").unlink()

            # The shell that completes is the installed one's own text.
            completion = prefix / "share/bash-completion/completions/sterna"
            for words, expected in ((("sterna", "check-sc"), ["check-script"]), (("sterna", "mesh", "--first-h"), ["--first-height"]),
                                    (("sterna", "check", "bo"), ["box.cgns", "box.cgns.json"])):
                script = f'source {completion}; COMP_WORDS=({" ".join(words)}); COMP_CWORD={len(words) - 1}; _sterna; echo "${{COMPREPLY[@]}}"'
                self.assertEqual(sorted(run("bash", "-c", script).split()), expected)
            page = (prefix / "share/man/man1/sterna.1").read_text()
            self.assertIn(".SS sterna check\\-script\n", page)
            self.assertIn(".B \\-\\-first\\-height\n", page)


if __name__ == "__main__":
    BUILD, BOX = (str(pathlib.Path(argument).resolve()) for argument in sys.argv[1:3])
    unittest.main(argv=sys.argv[:1])
