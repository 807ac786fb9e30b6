#!/usr/bin/python3
"""The models of scripts/ that end with geometry and the components alone give, meshed with default sizes, no warning about sharp turns. usage: script_models_test.py STERNA SCRIPTS"""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

STERNA, SCRIPTS = "", ""
MODELS = {"03_airliner": "model", "04_fighter_with_stores": "model", "05_glider": "model", "06_wind_tunnel_model": "clean"}

COMPONENTS = """
local function frames(nose, tail)
  return { { x = 0, diameter = nose }, { x = 1.2, diameter = 1.1 }, { x = 2.4, diameter = 1.3 }, { x = 4.6, diameter = 1.25 }, { x = 8, diameter = tail } }
end
for _, ends in ipairs{ { 0, 0 }, { 0, 0.3 }, { 0.5, 0 }, { 0.5, 0.3 } } do
  for _, along in ipairs{ "monotone", "akima" } do
    print(surface_mesh{ fuselage{ name = "body", along = along, frames = frames(ends[1], ends[2]) } })
  end
end
for _, tip in ipairs{ "round", "flat" } do
  for _, airfoil in ipairs{ "naca0005", "naca2412" } do
    for _, trailing_edge in ipairs{ 0, 0.001 } do
      print(surface_mesh{ wing{ name = "wing", tip = tip, trailing_edge = trailing_edge, sections = {
        { y = 0, chord = 1, airfoil = airfoil }, { y = 3, chord = 0.6, sweep = 20*deg, dihedral = 5*deg } } } })
    end
  end
end
print(surface_mesh{ boom{ name = "boom", from = { 3.2, 0, 0.12 }, to = { 7.1, 0, 0.22 }, diameter = 0.19 } })
print(surface_mesh{ nacelle{ name = "engine", position = { 0, 0, 0 }, length = 4.0, diameter = 2.1 } })
"""


class ScriptModels(unittest.TestCase):
    def test_default_sizes_give_no_warning_about_sharp_turns(self):
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(pathlib.Path(SCRIPTS, "data"), pathlib.Path(folder, "data"))
            for name, model in MODELS.items():
                with self.subTest(name):
                    lines = pathlib.Path(SCRIPTS, name + ".lua").read_text(encoding="utf-8").splitlines()
                    case = pathlib.Path(folder, name + ".lua")
                    case.write_text("\n".join([line for line in lines if ":write(" not in line] + [f"print(surface_mesh{{ {model} }})"]), encoding="utf-8")
                    self.run_without_warning(case)

    def test_components_give_no_warning_about_sharp_turns(self):
        with tempfile.TemporaryDirectory() as folder:
            case = pathlib.Path(folder, "components.lua")
            case.write_text(COMPONENTS, encoding="utf-8")
            self.run_without_warning(case)

    def run_without_warning(self, case):
        done = subprocess.run([STERNA, "run", case], cwd=case.parent, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertNotIn("where the model is smooth", done.stdout + done.stderr)
        self.assertIn("closed", done.stdout)


if __name__ == "__main__":
    STERNA, SCRIPTS = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1])
