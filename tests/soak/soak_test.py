#!/usr/bin/python3
"""The soak tells good from bad: meshes spoiled on purpose, programs that crash, hang, lie or keep silent are called wrong, and what is wrong is made smaller.

usage: soak_test.py STERNA AUDIT SCRATCH_FOLDER
"""
import json
import pathlib
import shutil
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import cases  # noqa: E402
import judge  # noqa: E402
import reduce  # noqa: E402
import surfaces  # noqa: E402

STERNA, AUDIT, SCRATCH = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])

# A case that is quick and plain.
PLAIN = {"seed": 0, "index": 0, "kind": "parts", "size": 1.0, "triangulated": False, "farfield": {"shape": "sphere", "radius": "20"}, "output": "",
         "components": [{"name": "part0", "lua": 'box{ {0, 0, 0}, {1, 1, 1}, name = "part0" }', "needs": []},
                        {"name": "part1", "lua": 'cylinder{ {0.5, 0.5, 0}, {0.5, 0.5, 2}, radius = 0.3, name = "part1" }', "needs": []}],
         "surface": {"max_edge": "0.4", "growth": "1.5"}, "volume": {"layers": "3", "first_height": "0.01"}}

# A wing with a flap, and a pod between sides that match.
WING = PLAIN | {"kind": "aircraft", "farfield": {}, "surface": {"max_edge": "0.3", "min_edge": "0.06", "curvature_angle": "40*deg", "growth": "1.6"},
                "volume": {"layers": "3", "first_height": "0.002", "size_growth": "1.8", "improve_rounds": "2"}, "turned": [{"patch": "flap", "angle": "12"}],
                "components": [{"name": "main_wing", "needs": [], "after": ['main_wing:deflect{ "flap", from = {0.3, 0.7}, to = {0.7, 0.7}, angle = 12*deg }'],
                                "plain": 'main_wing:control{ "flap", from = {0.3, 0.7}, to = {0.7, 0.7} }',
                                "lua": 'wing{ name = "wing", symmetric = true, trailing_edge = 0.01, sections = { { y = 0, chord = 1, airfoil = "naca0012" }, { y = 2 } } }'}]}
SHARP = WING | {"turned": [], "volume": WING["volume"] | {"open_ridges": '"always"'},
                "components": [WING["components"][0] | {"lua": WING["components"][0]["lua"].replace("trailing_edge = 0.01", "trailing_edge = 0"), "after": []}]}
# Two blocks with a gap that is too narrow for the layers of both.
LOW = PLAIN | {"volume": {"layers": "5", "first_height": "0.01", "truncate": '"always"', "growth": '"local"'},
               "components": [{"name": "part0", "lua": 'box{ {0, 0, 0}, {1, 1, 1}, name = "part0" }', "needs": []},
                              {"name": "part1", "lua": 'box{ {0, 0, 1.08}, {1, 1, 1.3}, name = "part1" }', "needs": []}]}
ROW = PLAIN | {"farfield": {}, "periodic": [["tunnel_left", "tunnel_right", ["0", "2", "0"]]], "tunnel_box": [["-2", "-1", "-1"], ["3", "1", "1"]],
               "tunnel": 'test_section{ length = 5, width = 2, height = 2, upstream = 2, max_edge = 0.5, walls = "slip" }',
               "components": [{"name": "pod", "needs": [], "lua": 'cylinder{ {0, 0.2, 0}, {1, 0.2, 0}, radius = 0.3, name = "pod" }'}]}

# What a program in the place of sterna does to its mesh: Python that changes `lines` of the file.
SPOIL = {
    "turned": "i = next(i for i, line in enumerate(lines) if line.startswith('10 ')); w = lines[i].split(); w[1], w[2] = w[2], w[1]; lines[i] = ' '.join(w)",
    "hole": "i = next(i for i, line in enumerate(lines) if line.startswith('10 ')); del lines[i]; lines[n] = f'NELEM= {int(lines[n].split()[-1]) - 1}'",
    "twice": "i = next(i for i, line in enumerate(lines) if line.startswith('10 ')); lines.insert(i, lines[i]); lines[n] = f'NELEM= {int(lines[n].split()[-1]) + 1}'",
    "uncovered": "i = next(i for i, line in enumerate(lines) if line.startswith('MARKER_ELEMS')); lines[i] = f'MARKER_ELEMS= {int(lines[i].split()[-1]) - 1}'; del lines[i + 1]",
    "moved": "i = next(i for i, line in enumerate(lines) if line.startswith('NPOIN')); w = lines[i + 1].split(); w[0] = str(float(w[0]) + 3); lines[i + 1] = ' '.join(w)",
    "renamed": "lines = [line.replace('part1', 'lost') for line in lines]",
    "stretched": "i = next(i for i, line in enumerate(lines) if line.startswith('NPOIN')); k = int(lines[i].split()[1]); lines[i + 1:i + 1 + k] = [' '.join([str(1.5 * float(x)) for x in line.split()[:3]] + line.split()[3:]) for line in lines[i + 1:i + 1 + k]]",
}


class Fake:
    """A program in the place of sterna, which runs it and does more."""

    def __init__(self, name, text):
        self.folder = SCRATCH / name
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)
        self.program = self.folder / "fake"
        self.program.write_text(text)
        self.program.chmod(0o755)

    def judged(self, case, limit=60):
        work = self.folder / "work"
        shutil.rmtree(work, ignore_errors=True)
        work.mkdir()
        return judge.Judge(self.program, AUDIT, None, limit)(case, work)


class Verdicts(unittest.TestCase):
    def test_a_good_mesh_is_valid(self):
        result = Fake("good", f'#!/bin/sh\nexec {STERNA} "$@"\n').judged(PLAIN | {"output": ".vtu"})
        self.assertIn(result["verdict"], ("VALID", "forced"), result)

    def test_spoiled_meshes_are_wrong(self):
        for name, change in SPOIL.items():
            text = (f"#!/usr/bin/python3\nimport subprocess, sys\nstatus = subprocess.run(['{STERNA}'] + sys.argv[1:]).returncode\nlines = open('mesh.su2').read().splitlines()\n"
                    f"n = next(i for i, line in enumerate(lines) if line.startswith('NELEM'))\n{change}\nopen('mesh.su2', 'w').write('\\n'.join(lines) + '\\n')\nsys.exit(status)\n")
            result = Fake("spoiled_" + name, text).judged(PLAIN)
            self.assertEqual(result["verdict"], "wrong", f"{name}: {result}")
            self.assertRegex(result["why"], "silent:|audit:", name)

    def test_what_is_silently_not_done_is_wrong(self):
        for name, lua, made in (("height", "first_height = 0.01", "first_height = 0.02"), ("farfield", "radius = 20", "radius = 10"), ("layers", "layers = 3", "layers = 2")):
            text = f"#!/bin/sh\nsed -i 's/{lua}/{made}/' case.lua\nexec {STERNA} \"$@\"\n"
            result = Fake("silent_" + name, text).judged(PLAIN)
            self.assertEqual((result["verdict"], result["why"].partition(":")[0]), ("wrong", "silent"), f"{name}: {result}")

    def test_what_was_asked_beside_layers_is_looked_for(self):
        surface = {"shape": "surface", "radii": ["9", "8", "7"], "center": ["0", "0", "0"], "n": 12}
        cylinder = {"shape": "cylinder", "from": "-8", "to": "16", "radius": "8", "sides": True}
        box = {"shape": "box", "low": ["-8", "-8", "-8"], "high": ["16", "8", "8"], "sides": True}
        for name, case, change, word in (
                ("wakes", WING | {"wakes": '"auto"', "wake_reach": "0.2"}, 's/, wakes = "auto"//', "wake sheet"), ("short_wake", WING | {"wakes": '"auto"', "wake_reach": "5"}, "s/x/x/", "long"),
                ("own_wakes", WING, 's/layers = 3/layers = 3, wakes = "auto"/', "stand on no wall"), ("flap", WING, "s/angle = 12/angle = 2/", "turned by"),
                ("cylinder", PLAIN | {"farfield": cylinder}, "s/radius = 8/radius = 7/", "cylinder asked"), ("sides", PLAIN | {"farfield": cylinder}, 's/start = "inflow", //', "inflow"),
                ("box_sides", PLAIN | {"farfield": box}, 's/x_max = "outflow"/x_min = "inflow"/', "outflow"), ("surface", PLAIN | {"farfield": surface}, 's/"far.stl"/sphere{ radius = 20 }/', "surface asked"),
                ("tunnel", ROW, "s/length = 5/length = 6/", "tunnel asked"), ("periodic", ROW, 's/, periodic = {.*} }/ }/', "do not match"),
                ("truncate", LOW, 's/truncate = "always"/truncate = "never"/', "lower than layers times first height"),
                ("ridges", SHARP, 's/open_ridges = "always"/open_ridges = "never"/', "not a word about normals"),
                ("through", PLAIN | {"through": ".step"}, 's/read_cad "model.step"/read_cad{ "model.step", unit = 1.1 }/', "read from")):
            good = Fake("asked_" + name, f'#!/bin/sh\nexec {STERNA} "$@"\n').judged(case)
            self.assertIn(good["verdict"], ("VALID", "forced") if name != "short_wake" else ("wrong",), f"{name}: {good}")
            result = Fake("not_done_" + name, f"#!/bin/sh\nsed -i '{change}' case.lua\nexec {STERNA} \"$@\"\n").judged(case)
            self.assertEqual((result["verdict"], result["why"].partition(":")[0]), ("wrong", "silent"), f"{name}: {result}")
            self.assertIn(word, result["why"], name)

    def test_another_mesh_when_continued_is_wrong(self):
        for step in ("envelope", "tetrahedra"):
            case = PLAIN | {"continued": step}
            good = Fake("continued_" + step, f'#!/bin/sh\nexec {STERNA} "$@"\n').judged(case)
            self.assertIn(good["verdict"], ("VALID", "forced"), good)
            result = Fake("continues_otherwise_" + step, f'#!/bin/sh\n{STERNA} "$@" || exit 1\n[ ! -f continued.su2 ] || echo >> continued.su2\n').judged(case)
            self.assertEqual((result["verdict"], result["why"]), ("wrong", f"continued behind the {step}: another mesh"))

    def test_crashes_hangs_and_silence_are_wrong(self):
        for name, text, word in (("crash", "kill -SEGV $$", "crash"), ("hang", "while true; do :; done", "hang"), ("mute", "exit 1", "dishonest"), ("idle", "exit 0", "no mesh"),
                                 ("curt", 'echo "error: it failed at (1, 2, 3)" >&2; exit 1', "dishonest"), ("blind", 'printf "error: it failed\\n  try: again\\n" >&2; exit 1', "dishonest")):
            result = Fake(name, f"#!/bin/sh\n{text}\n").judged(PLAIN, limit=1)
            self.assertEqual(result["verdict"], "wrong", f"{name}: {result}")
            self.assertTrue(result["why"].startswith(word), f"{name}: {result}")

    def test_an_error_with_place_and_remedy_is_honest(self):
        result = Fake("honest", '#!/bin/sh\nprintf "error: two walls cross\\n  at (1, 2, 3): wing\\n  try: union{}\\n" >&2\nexit 1\n').judged(PLAIN)
        self.assertEqual(result["verdict"], "refused", result)


class Reduction(unittest.TestCase):
    def test_what_has_nothing_to_do_with_it_goes(self):
        fake = Fake("reduced", "#!/bin/sh\ngrep -q part1 case.lua && kill -SEGV $$\nexit 1\n")
        case = PLAIN | {"output": ".vtu", "volume": PLAIN["volume"] | {"max_growth": "1.3"}}
        small, result, said = reduce.reduce(case, fake.judged(case), lambda case, folder: fake.judged(case))
        self.assertEqual(result["verdict"], "wrong")
        self.assertEqual([part["name"] for part in small["components"]], ["part1"])
        self.assertEqual((small["output"], small["volume"], small["farfield"]), ("", PLAIN["volume"], {}))
        self.assertEqual(len(said), 5)  # growth of the surface, too

    def test_triangles_go(self):
        case = {"kind": "surface", "form": "box", "form_seed": 1, "damage": [], "offset": None, "scale": "1", "surface": {}, "volume": {}, "farfield": {}, "output": ""}
        count = lambda some: sum(len(soup) for _, soup in cases.soup_of(some, None))  # noqa: E731
        small, _, _ = reduce.reduce(case, {"verdict": "wrong", "why": "crash"}, lambda case, folder: {"verdict": "wrong", "why": "crash"}, count)
        self.assertLess(count(small), count(case) / 8)


class Generator(unittest.TestCase):
    def test_the_same_number_gives_the_same_case_and_every_kind_comes(self):
        table = cases.options_of(STERNA, "volume_mesh")
        self.assertGreater(len(table), 20)
        made = [cases.make(1, index, table, None) for index in range(120)]
        self.assertEqual(json.dumps(made), json.dumps([cases.make(1, index, table, None) for index in range(120)]))
        self.assertEqual({case["kind"] for case in made}, {"aircraft", "parts", "surface", "model"})
        for what in ("wakes", "through", "periodic", "turned", "continued", "tunnel", "half", "attitude"):
            self.assertTrue(any(case.get(what) for case in made), what)
        self.assertNotEqual(made[0], cases.make(2, 0, table, None))

    def test_damage_changes_a_surface_and_forms_are_closed(self):
        for soup in (surfaces.ellipsoid(1, 0.5, 0.3, 12), surfaces.thick_wing(surfaces.generator(1), 10), surfaces.refined(surfaces.box((0, 0, 0), (1, 1, 1)), 2)):
            edges = {}
            for t in soup:
                for k in range(3):
                    edge = (t[k], t[(k + 1) % 3])
                    edges[edge] = edges.get(edge, 0) + 1
            self.assertTrue(all(n == 1 and edges.get((b, a)) == 1 for (a, b), n in edges.items()))
            self.assertGreater(surfaces.volume(soup), 0)
            for name, damage in surfaces.DAMAGE.items():
                self.assertNotEqual(damage(surfaces.generator(2), soup, 0.5), soup, name)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
