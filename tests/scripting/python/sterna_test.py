#!/usr/bin/python3
"""sterna.py drives the program: results, errors in the program's words, progress, series, where the program is looked for. usage: sterna_test.py SOURCE_FOLDER STERNA DATA_FOLDER"""
import contextlib
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import threading
import unittest

SOURCE, PROGRAM, DATA = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
sys.path.insert(0, str(SOURCE / "scripting/python"))
import sterna  # noqa: E402

BOX = SOURCE / "tests/data/scripts/box.stl"
STEP = SOURCE / "tests/data/cad/box_mm.step"

BODIES = """
local body = fuselage{ name = "body", frames = { { x = 0.5, diameter = 0.8 }, { x = 2, diameter = 1 }, { x = 4, diameter = 0.5 } } }
series{ "bodies", over = { alpha = { 0, 2, 4 } }, run = jobs{ 1 }, case = function(p)
  if p.alpha == 2 then error("two is too many") end
  local wall = surface_mesh{ body:model():rotate{ about = { 0, 0, 0 }, pitch = p.alpha*deg }, max_edge = 0.4, curvature_angle = 40*deg }
  return volume_mesh{ wall, layers = 3, first_height = 0.01, farfield = sphere{ radius = 20 } }:write(p.name .. ".su2")
end }
"""


@contextlib.contextmanager
def environment(**values):
    before = {name: os.environ.get(name) for name in values}
    try:
        for name, value in values.items():
            os.environ.pop(name, None) if value is None else os.environ.update({name: value})
        yield
    finally:
        for name, value in before.items():
            os.environ.pop(name, None) if value is None else os.environ.update({name: value})


class Case(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.sterna = sterna.Sterna(PROGRAM, folder=self.folder)

    def write(self, name: str, text: str) -> str:
        (self.folder / name).write_text(text)
        return name


class Commands(Case):
    def test_mesh_and_check_say_the_same(self):
        made = self.sterna.mesh(BOX, ["box.su2", "box.vtu"], layers=3, first_height=1e-3, farfield="sphere radius=20", set={"size.size_growth": 1.8})
        self.assertEqual(made["verdict"], "VALID")
        self.assertEqual(made["options"]["envelope"]["layers"], 3)
        self.assertEqual(made["options"]["size"]["size_growth"], 1.8)
        self.assertEqual(made["files"], [str(self.folder / "box.su2"), str(self.folder / "box.vtu")])
        for file in made["files"]:
            self.assertTrue(pathlib.Path(file).is_file())
        checked = self.sterna.check("box.su2")
        self.assertEqual(checked["verdict"], "VALID")
        self.assertEqual(checked["cells"]["prisms"], made["mesh"]["prisms"])
        self.assertEqual(checked["nodes"], made["mesh"]["nodes"])
        self.assertGreater(self.sterna.info("box.su2")["cells"]["prisms"], 0)
        self.assertEqual(self.sterna.info("box.su2")["manifest"]["output"], "box.su2")
        self.assertGreater(pathlib.Path(self.sterna.draw("box.su2", "box.png", width=200, height=150)).stat().st_size, 100)
        self.assertIn("<html", pathlib.Path(self.sterna.report("box.su2", "box.html", times=False)).read_text()[:300])

    def test_threads_do_not_change_a_byte(self):
        for threads in (1, 2):
            sterna.Sterna(PROGRAM, folder=self.folder, threads=threads).mesh(BOX, f"{threads}.su2", layers=2, first_height=1e-3)
        self.assertEqual((self.folder / "1.su2").read_bytes(), (self.folder / "2.su2").read_bytes())

    def test_model_to_surface_to_other_formats(self):
        wall = self.sterna.surface(STEP, "wall.stl", max_edge=0.2)
        self.assertTrue(wall["mesh"]["closed"])
        finer = self.sterna.surface(STEP, "finer.stl", max_edge=0.1)
        self.assertGreater(finer["mesh"]["triangles"], wall["mesh"]["triangles"])
        made = self.sterna.convert("wall.stl", "wall.obj")
        self.assertEqual(made, str(self.folder / "wall.obj"))
        found = self.sterna.inspect("wall.stl", layers=3, first_height=1e-3)
        self.assertEqual(found["errors"], 0)

    def test_patch_rules_and_repeated_options(self):
        made = self.sterna.mesh(BOX, "box.su2", layers=3, first_height=1e-3, patch={"*": {"layers": 2, "first_height": 2e-3}}, source=["point 2 0 0 size=0.2", "point -2 0 0 size=0.2"])
        plain = self.sterna.mesh(BOX, "plain.su2", layers=3, first_height=1e-3)
        self.assertEqual(made["mesh"]["prisms"] * 3, plain["mesh"]["prisms"] * 2)
        self.assertGreater(made["mesh"]["tetrahedra"], plain["mesh"]["tetrahedra"])

    def test_invalid_mesh_is_an_answer_of_check(self):
        self.sterna.mesh(BOX, "box.su2", layers=2, first_height=1e-3)
        lines = (self.folder / "box.su2").read_text().splitlines()
        first = next(k for k, line in enumerate(lines) if line.startswith("NELEM=")) + 1
        removed = lines[: first - 1] + [f"NELEM= {int(lines[first - 1].split('=')[1]) - 1}"] + lines[first + 1 :]
        (self.folder / "hole.su2").write_text("\n".join(removed) + "\n")
        report = self.sterna.check("hole.su2")
        self.assertEqual(report["verdict"], "INVALID")
        self.assertTrue(report["findings"])

    def test_run_hands_arguments_to_the_script(self):
        script = self.write("angle.lua", "local given = args{ alpha = 0, half = false }\nprint(string.format(\"%g\", given.alpha + 1), given.half)\n")
        self.assertEqual(self.sterna.run(script, {"alpha": 4, "half": True})["text"].split(), ["5", "true"])

    def test_arguments_of_scripts_in_every_form(self):
        self.write("twice.lua", "local p = args{ a = 0, name = '' } print(p.a * 2, p.name)")
        for arguments in ({"a": 3, "name": "x=y"}, ["a=3", "name=x=y"], [("a", 3), ("name", "x=y")], ("a=3", "name=x=y")):
            self.assertEqual(self.sterna.run("twice.lua", arguments)["text"], "6\tx=y\n")
            self.assertEqual(self.sterna.check_script("twice.lua", arguments), [])

    def test_wrong_types_are_type_errors(self):
        script = self.write("empty.lua", "")
        for call in (lambda: self.sterna.run(script, "a=1"), lambda: self.sterna.run(script, 3), lambda: self.sterna.run(script, ["a"]), lambda: self.sterna.run(script, [1]),
                     lambda: self.sterna.run([script]), lambda: self.sterna.check_script(script, "a=1"), lambda: self.sterna.series(script, "s", "a=1"),
                     lambda: self.sterna.mesh(3, "a.su2"), lambda: self.sterna.mesh({"a": 1}, "a.su2"), lambda: self.sterna.mesh(BOX, None), lambda: self.sterna.mesh(BOX, []),
                     lambda: self.sterna.mesh(BOX, "a.su2", patch={"wing": 3}), lambda: self.sterna.check(["a.su2"]), lambda: self.sterna.info(None), lambda: self.sterna.union(None, "a.stl"),
                     lambda: self.sterna.draw("a.su2", None), lambda: self.sterna.convert(["a.su2"], "b.su2"), lambda: self.sterna.inspect(None), lambda: self.sterna.report(3, "a.html")):
            with self.assertRaisesRegex(TypeError, "expected|neither|at least"):
                call()

    def test_version(self):
        self.assertRegex(self.sterna.version(), r"^\d+\.\d+\.\d+$")


class Errors(Case):
    def test_open_surface_with_places_and_advice(self):
        facets = BOX.read_text().split("facet normal")
        self.write("open.stl", "facet normal".join(facets[:-1]) + "endsolid\n")
        with self.assertRaises(sterna.SternaError) as caught:
            self.sterna.mesh("open.stl", "open.su2", layers=2, first_height=1e-3)
        error = caught.exception
        self.assertEqual(error.status, 1)
        self.assertIn("is open along 3 edges", str(error))
        self.assertEqual(len(error.places), 3)
        self.assertIn("edge with one facet", error.places[0].what)
        self.assertIn("sterna repair", error.advice)
        found = self.sterna.inspect("open.stl", layers=2, first_height=1e-3)  # here it is an answer
        self.assertGreater(found["errors"], 0)

    def test_misspelt_option_and_missing_file(self):
        with self.assertRaisesRegex(sterna.UsageError, "first-height"):
            self.sterna.mesh(BOX, "box.su2", layers=2, frist_height=1e-3)
        with self.assertRaisesRegex(sterna.SternaError, "there is no such file"):
            self.sterna.check("nothing.su2")
        with self.assertRaises(TypeError):
            self.sterna.mesh(BOX, "box.su2", layers=2, first_height={"wing": 1e-3})

    def test_check_script_lists_mistakes(self):
        self.write("wrong.lua", 'volume_mesh{ read_surface{ "%s", unt = mm }, layers = 2, first_height = 1e-3, farfield = sphere{ radus = 3 } }\n' % BOX)
        mistakes = self.sterna.check_script("wrong.lua")
        self.assertEqual(len(mistakes), 2)
        self.assertTrue(any("radus" in text for text in mistakes) and any("unt" in text for text in mistakes))
        self.assertEqual(self.sterna.check_script(self.write("right.lua", "print(1)\n")), [])

    def test_time_is_limited_and_callbacks_may_raise(self):
        self.write("endless.lua", "while true do end\n")
        with self.assertRaises(sterna.TimedOut):
            sterna.Sterna(PROGRAM, folder=self.folder, timeout=1.0).run("endless.lua")

        def refuse(_):
            raise KeyError("enough")

        with self.assertRaises(KeyError):
            sterna.Sterna(PROGRAM, folder=self.folder, log=refuse).mesh(BOX, "box.su2", layers=2, first_height=1e-3)

    def test_no_program(self):
        with self.assertRaisesRegex(sterna.ProgramNotFound, "no_such_program"):
            sterna.Sterna("no_such_program")


class Program(Case):
    def test_is_found_by_argument_environment_and_path(self):
        other = self.folder / "other"
        other.mkdir()
        (other / "sterna").symlink_to(PROGRAM)
        with environment(STERNA=None, PATH=str(other)):
            self.assertEqual(sterna.find_program(), str(other / "sterna"))
            with environment(STERNA=str(PROGRAM)):
                self.assertEqual(sterna.find_program(), str(PROGRAM))
                self.assertEqual(sterna.find_program(other / "sterna"), str(other / "sterna"))
                self.assertEqual(sterna.version(), self.sterna.version())  # as a function
            with environment(STERNA=str(self.folder)), self.assertRaisesRegex(sterna.ProgramNotFound, "STERNA"):
                sterna.find_program()


class Progresses(Case):
    def test_progress_and_log_arrive(self):
        steps, lines = [], []
        sterna.Sterna(PROGRAM, folder=self.folder, progress=steps.append, log=lines.append).mesh(BOX, "box.su2", layers=3, first_height=1e-3, size_growth=1.06, farfield_radius=50)  # half a second: time for progress
        self.assertTrue(steps)
        self.assertTrue(all(0.0 <= step.share <= 1.0 for step in steps))
        self.assertEqual([step.share for step in steps], sorted(step.share for step in steps))
        self.assertTrue(any(step.stage.startswith("volume_mesh") for step in steps))
        self.assertTrue(any(line.startswith("wrote box.su2") for line in lines))
        self.assertFalse(any("\x1b" in line or "%]" in line for line in lines))

    def test_lines_in_pieces(self):
        steps, lines = [], []
        messages = sterna._Messages(steps.append, lines.append)
        text = "\r[ 13 %] volume_mesh/envelope, about 1:02 min left\x1b[K\r\x1b[Kwarning: thin\r\n  at (1, 2, 3): here\r\nwrote b\u00f6x\r\n\r[100 %] done\x1b[K".encode()
        for k in range(len(text)):
            messages.take(text[k : k + 1])
        messages.take(b"", True)
        self.assertEqual(steps, [sterna.Progress(0.13, "volume_mesh/envelope", "1:02 min"), sterna.Progress(1.0, "done", None)])
        self.assertEqual(lines, ["warning: thin", "  at (1, 2, 3): here", "wrote b\u00f6x"])
        self.assertEqual(messages.warnings, ["thin\n  at (1, 2, 3): here"])


class Series(Case):
    def test_failed_cases_are_an_answer(self):
        script = self.write("bodies.lua", BODIES)
        result = self.sterna.series(script, "bodies")
        self.assertEqual((result["done"], result["failed"]), (2, 1))
        first, second, _ = result["cases"]
        self.assertEqual((first["parameters"], first["verdict"]), ({"alpha": 0}, "VALID"))
        self.assertIn("two is too many", second["error"]["message"])
        with self.assertRaises(sterna.CaseFailure) as caught:
            self.sterna.series(script, "bodies", must_succeed=True)  # as it was: nothing runs again
        self.assertEqual([case["name"] for case in caught.exception.cases], ["alpha=2"])
        self.assertEqual(self.sterna.read_series("bodies")["done"], 2)

    def test_error_before_the_series_is_an_error(self):
        with self.assertRaisesRegex(sterna.SternaError, "before"):
            self.sterna.series(self.write("wrong.lua", 'error("before")\n' + BODIES), "bodies")
        with self.assertRaisesRegex(sterna.SternaError, "without a series"):
            self.sterna.series(self.write("none.lua", "print(1)\n"), "bodies")

    def test_interrupt_stops_the_program(self):
        script = self.write("slow.lua", "local n = 0\nwhile true do n = n + 1 end\n")
        program = f"import sys; sys.path.insert(0, {str(SOURCE / 'scripting/python')!r}); import sterna; sterna.Sterna({str(PROGRAM)!r}, folder={str(self.folder)!r}, log=print).run({script!r})"
        process = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True)
        timer = threading.Timer(1.5, lambda: os.killpg(process.pid, 2))  # what Ctrl-C sends: to all of the terminal's group
        timer.start()
        try:
            _, messages = process.communicate(timeout=60)
        finally:
            timer.cancel()
        self.assertIn(b"KeyboardInterrupt", messages)
        self.assertNotEqual(process.returncode, 0)


class Pipeline(Case):
    def test_the_step_of_the_document_meshes_a_cpacs_file(self):
        cpacs = DATA / "cpacs/simpletest.cpacs.xml"
        step = re.search(r"^```python\n(# step\.py\n.*?)^```$", (SOURCE / "docs/python.md").read_text(), re.MULTILINE | re.DOTALL)
        names = {}
        exec(compile(step[1], "step.py", "exec"), names)
        with environment(STERNA=str(PROGRAM)):
            made = names["mesh_of_cpacs"](cpacs, self.folder / "case", first_height=1e-3, layers=5)
        self.assertEqual(made["markers"], ["SimpleFuselage", "Wing", "farfield"])
        self.assertTrue(pathlib.Path(made["mesh"]).is_file())
        self.assertGreater(made["wall_triangles"], 1000)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
