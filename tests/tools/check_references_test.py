#!/usr/bin/python3
"""check_references refuses one planted dangling reference of each kind at its line, and nothing in a clean tree with the names of a user's own files.

usage: check_references_test.py PATH_OF_CHECK_REFERENCES
"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

CHECK = ""

CLEAN = {
    "README.md": "See docs/method/envelope.md, \"Heights\", and [a page](docs/use.md). `sterna mesh wing.stl -o mesh.su2`, `wing.lua`, `cases/wing.py`.\n\n"
                 "```sh\nsterna mesh docs/none.md tests/none.h\n```\n\n    indented code: none.md, none.h\n",
    "docs/use.md": "# Use\n\n## 2.1 Sizes\n\nCode: `volmesh/envelope/collide.h`, `volmesh/envelope/collide.*`, `io/x_NAME.cpp`; scripts/07; tests/bench/wings; method/envelope.md.\n",
    "docs/method/envelope.md": "# Envelope\n\n## Heights\n\n## Growth of `h0`\n\nSee [use](../use.md), use.md section 2.1.\n",
    "volmesh/envelope/collide.h": '// Heights (docs/method/envelope.md, "Heights" and "Growth of h0"), docs/use.md 2.1; collide.{h,cpp}, envelope/collide.h.\n#include <tetgen.h>\n// of tetgen.h\n',
    "volmesh/envelope/collide.cpp": 'const char* text = "none.md docs/none.h // none.cpp";\nconst char* raw = R"(none.md // none.h)";  // see collide.h, docs/method/envelope.md,\n'
                                    '// "Heights"\n',
    "io/x_su2.cpp": "/* *_su2.cpp reads mesh.su2 and writes forces.lua. */\n",
    "scripts/07_half.lua": '-- docs/use.md\nlocal text = "none.md -- none.h"\nlocal long = [[none.md]]\n',
    "tests/bench/wings_main.cpp": "// usage: wings wing.stl\n",
    "tests/data/example.py": '"""docs/use.md"""\ntext = "none.md"  # docs/use.md\nother = """\nnone.h # none.md\n"""\n',
    "tools/run": "#!/bin/sh\n# docs/use.md\necho none.md\n",
    "tests/CMakeLists.txt": "# docs/use.md\nset(x none.md)\n",
    "build/release/old.h": "// none.md\n",
}


class CheckReferences(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name)
        for name, text in CLEAN.items():
            self.write(name, text)

    def tearDown(self):
        self.folder.cleanup()

    def write(self, name: str, text: str):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def expect(self, *lines: str):
        """Exactly these violations, each given by its start."""
        result = subprocess.run([CHECK, "--root", str(self.root)], capture_output=True, text=True, check=False)
        found = result.stdout.splitlines()[:-1]
        self.assertEqual(len(found), len(lines), result.stdout + result.stderr)
        for line in lines:
            self.assertTrue(any(f.startswith(line) for f in found), f"{line} not in\n{result.stdout}")
        self.assertEqual(result.returncode, 1 if lines else 0)

    def test_clean_tree(self):
        self.expect()

    def test_empty_tree_is_no_success(self):
        for name in CLEAN:
            (self.root / name).unlink()
        self.assertEqual(subprocess.run([CHECK, "--root", str(self.root)], capture_output=True, check=False).returncode, 1)

    def test_pages(self):
        self.write("io/a.cpp", "int a;  // method.md section 2\n\n/* Based on ../shared/spec/formats.md\n   and use.md */\n")
        self.write("docs/b.md", "Page (docs/method/gone.md), `spec/build.md`.\n\nenvelope.md stands in another folder.\n")
        self.expect("io/a.cpp:1: reference: method.md", "io/a.cpp:3: reference: ../shared/spec/formats.md", "docs/b.md:1: reference: docs/method/gone.md",
                    "docs/b.md:1: reference: spec/build.md", "docs/b.md:3: reference: envelope.md")

    def test_headers_and_sources(self):
        self.write("volmesh/a.h", "/// discs/slits.h adds them (gone.cpp).\n// envelope/collide.{h,cc}\n")
        self.write("docs/b.md", "`io/sterna_*.cpp`, `io/y_NAME.cpp`, surface_criterion.h\n")
        self.expect("volmesh/a.h:1: reference: discs/slits.h", "volmesh/a.h:1: reference: gone.cpp", "docs/b.md:1: reference: io/sterna_*.cpp",
                    "docs/b.md:1: reference: io/y_*.cpp", "docs/b.md:1: reference: surface_criterion.h")

    def test_scripts_and_folders(self):
        self.write("docs/b.md", "scripts/08, scripts/gone.lua, `tools/gone.py`, tests/bench/gone, `volmesh/outer`\n")
        self.expect(*(f"docs/b.md:1: reference: {name}" for name in ("scripts/08", "scripts/gone.lua", "tools/gone.py", "tests/bench/gone", "volmesh/outer")))

    def test_headings(self):
        self.write("io/a.h", '// a\n\n// Sizes (docs/method/envelope.md,\n// "Widths") and docs/use.md section 3; docs/use.md §4.\n')
        self.expect('io/a.h:3: reference: docs/method/envelope.md has no heading "Widths"', 'io/a.h:4: reference: docs/use.md has no section "3"',
                    'io/a.h:4: reference: docs/use.md has no section "4"')

    def test_comments_of_every_language(self):
        self.write("scripts/08_x.lua", "local a = 1  -- gone.md\n--[[ and\ngone.h ]]\n")
        self.write("tools/x", "#!/usr/bin/python3\n'''Doc:\ngone.md'''\na = 1  # gone.h\n")
        self.write("tools/y", "#!/usr/bin/env bash\necho  # gone.md\n")
        self.write("tests/x.cmake", "set(a b)  # gone.md\n")
        self.write("tests/page.js", "let a = 'gone.h';  // gone.md\n")
        self.expect("scripts/08_x.lua:1: reference: gone.md", "scripts/08_x.lua:3: reference: gone.h", "tools/x:3: reference: gone.md", "tools/x:4: reference: gone.h",
                    "tools/y:2: reference: gone.md", "tests/x.cmake:1: reference: gone.md", "tests/page.js:1: reference: gone.md")


if __name__ == "__main__":
    CHECK = sys.argv.pop(1)
    unittest.main()
