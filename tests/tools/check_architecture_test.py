#!/usr/bin/python3
"""check_architecture finds one planted violation of each rule at its line, and nothing in a clean tree.

usage: check_architecture_test.py PATH_OF_CHECK_ARCHITECTURE [C++ COMPILER]
"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

CHECK = ""
COMPILER = "c++"

CLEAN = {
    "geom/base/a.h": '#pragma once\n#include <vector>\n#include <sys/stat.h>\n',
    "geom/base/a.cpp": '// std::cout << 1; printf("x") in a comment is no printing\n#include "geom/base/a.h"\n#include <tbb/parallel_for.h>\n'
                       'const char* k_text = "std::cout << stderr"; int f(char* b) { return snprintf(b, 1, "puts("); }\n',
    "surfmesh/face/s.cpp": '#include "geom/base/a.h"\n#include <Eigen/Dense>\n',
    "volmesh/tetra/tetgen_main.cpp": '#include <tetgen.h>\nvoid f() { std::fprintf(stderr, "died"); }\n',
    "io/text/w.cpp": '#include "geom/base/a.h"\n#include <zlib.h>\n',
    "scripting/cli/m.cpp": '#include "io/text/w.h"\n#include "surfmesh/face/s.h"\n#include <lua.hpp>\n#include <CLI/CLI.hpp>\nvoid f() { std::cout << 1; }\n',
    "io/text/w.h": "#pragma once\n",
    "surfmesh/face/s.h": "#pragma once\n",
    "geom/mesh/m.h": '#pragma once\n#include "geom/base/a.h"\n',
    "geom/model/m.h": '#pragma once\n#include "geom/mesh/m.h"\n',
    "volmesh/envelope/e.h": "#pragma once\n",
    "volmesh/v.h": '#pragma once\n#include "volmesh/envelope/e.h"\n',
}

FOLDERS = """# a comment
geom/base:
geom/mesh: geom/base
geom/model: geom/base geom/mesh
surfmesh/face: geom/*
volmesh/envelope: geom/*
volmesh/tetra: geom/* volmesh/envelope
volmesh: geom/* volmesh/*
io/text: geom/*
scripting/cli: geom/* surfmesh/* volmesh/* volmesh io/*
"""

DRAWING = """```text
scripting -> geom, io, surfmesh, volmesh
   1  cli
io -> geom
   1  text
surfmesh -> geom
   1  face
volmesh -> geom
   3  (volmesh itself)
   2  tetra
   1  envelope
geom
   3  model
   2  mesh
   1  base
```
"""
BEGIN = "<!-- layers: the output of tools/check_architecture --draw -->\n"
END = "<!-- end of layers -->\n"


class CheckArchitecture(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.folder.name)
        for name, text in CLEAN.items():
            self.write(name, text)
        self.write("tools/folders.txt", FOLDERS)
        self.write("docs/architecture/folders.md", "# Title\n" + BEGIN + DRAWING + END)

    def tearDown(self):
        self.folder.cleanup()

    def write(self, name: str, text: str):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def run_check(self, *arguments: str) -> subprocess.CompletedProcess:
        return subprocess.run([CHECK, "--root", str(self.root), *arguments], capture_output=True, text=True, check=False)

    def expect(self, *lines: str):
        """Exactly these violations, each given by the start of its line."""
        result = self.run_check()
        found = result.stdout.splitlines()[:-1]
        self.assertEqual(len(found), len(lines), result.stdout)
        for line in lines:
            self.assertTrue(any(f.startswith(line) for f in found), f"{line} not in\n{result.stdout}")
        self.assertEqual(result.returncode, 1 if lines else 0)

    def test_clean_tree(self):
        self.expect()

    def test_empty_tree_is_no_success(self):
        for name in CLEAN:
            (self.root / name).unlink()
        self.assertEqual(self.run_check().returncode, 1)

    def test_direction(self):
        self.write("volmesh/v.cpp", '#include "surfmesh/face/s.h"\n')
        self.write("io/text/x.cpp", '\n\n#include "surfmesh/face/s.h"\n')
        self.expect("volmesh/v.cpp:1: direction:", "io/text/x.cpp:3: direction:")

    def test_direction_between_folders_of_one_folder(self):
        self.write("volmesh/envelope/x.cpp", '#include "volmesh/tetra/t.h"\n')
        self.write("volmesh/tetra/t.h", "#pragma once\n")
        self.expect("volmesh/envelope/x.cpp:1: direction:")

    def test_circle_of_folders(self):
        self.write("geom/base/b.h", '#pragma once\n\n#include "geom/model/m.h"\n')
        self.expect("geom/base/b.h:3: direction:", "geom/base/b.h:3: circle: geom/base -> geom/model")

    def test_circle_of_top_folders(self):
        self.write("geom/base/b.h", '#include "io/text/w.h"\n')
        self.expect("geom/base/b.h:1: direction:", "geom/base/b.h:1: circle: geom -> io")

    def test_circle_of_deeper_folders(self):
        self.write("tools/folders.txt", FOLDERS + "io/text/a: io/text/b\nio/text/b:\n")
        self.write("io/text/a/a.h", '#include "io/text/b/b.h"\n')
        self.write("io/text/b/b.h", "#pragma once\n")
        self.write("io/text/b/c.h", '#include "io/text/a/a.h"\n')
        self.write("docs/architecture/folders.md", BEGIN + self.run_check("--draw").stdout + END)
        self.expect("io/text/b/c.h:1: direction:", "io/text/a/a.h:1: circle: io/text/a -> io/text/b")

    def test_exceptions(self):
        """One lets a circle pass while it is there, shows in the drawing, and is a violation itself when nothing needs it."""
        self.write("tools/folders.txt", FOLDERS + "except geom/base -> geom/model: until it is split\n")
        self.write("geom/base/b.h", '#include "geom/model/m.h"\n')
        drawing = self.run_check("--draw").stdout
        self.assertIn("excepted: geom/base -> geom/model", drawing)
        self.write("docs/architecture/folders.md", BEGIN + drawing + END)
        self.expect()
        (self.root / "geom/base/b.h").unlink()
        self.expect("tools/folders.txt:11: table:")

    def test_mistakes_in_the_table(self):
        self.write("tools/folders.txt", FOLDERS + "this is no line\n")
        self.expect("tools/folders.txt:11: table:")
        self.write("tools/folders.txt", FOLDERS + "io/text: geom/base\n")
        self.expect("tools/folders.txt:11: table:")
        self.write("tools/folders.txt", FOLDERS.replace("geom/model: geom/base", "geom/model: geom/bsae"))
        self.expect("tools/folders.txt: table: geom/model may not use geom/bsae")
        self.write("tools/folders.txt", FOLDERS.replace("geom/base:", "geom/base: geom/model"))
        self.expect("tools/folders.txt: circle:", "docs/architecture/folders.md:2: drawing:")

    def test_folder_without_an_entry_and_entry_without_a_folder(self):
        self.write("geom/other/x.h", "#pragma once\n")
        self.expect("geom/other/x.h: folder:")
        (self.root / "geom/other/x.h").unlink()
        (self.root / "geom/model/m.h").unlink()
        self.expect("tools/folders.txt: table: there is no source file in geom/model")

    def test_drawing(self):
        self.assertEqual(self.run_check("--draw").stdout, DRAWING)
        self.write("docs/architecture/folders.md", "# Title\n" + BEGIN + DRAWING.replace("tetra", "tetrahedra") + END)
        self.expect("docs/architecture/folders.md:2: drawing:")
        self.write("docs/architecture/folders.md", "# Title\n")
        self.expect("docs/architecture/folders.md: drawing:")

    def test_include_paths(self):
        self.write("io/text/x.cpp", '#include "w.h"\n#include "io/text/missing.h"\n#include "io/text/w.cpp"\n')
        self.expect("io/text/x.cpp:1: include path:", "io/text/x.cpp:2: include path:", "io/text/x.cpp:3: include path:")

    def test_third_party_headers_outside_their_adapter(self):
        planted = {
            "geom/mesh/a.cpp": ["tbb/parallel_for.h", "lua.hpp", "nlopt.h", "tetgen.h", "gmsh.h", "BRep_Tool.hxx"],
            "geom/base/a.h": ["tbb/parallel_for.h", "Eigen/Dense", "nlohmann/json.hpp"],
            "volmesh/envelope/e.h": ["nlopt.h"],
            "volmesh/tetra/engine.cpp": ["tetgen.h", "gmsh.h_cwrap"],
            "surfmesh/face/s.cpp": ["CGAL/Surface_mesh.h", "zlib.h", "spdlog/spdlog.h"],
            "scripting/cli/m.cpp": ["cgnslib.h", "netcdf.h", "hdf5.h", "lz4.h", "tbb/task_arena.h"],
            "io/text/w.cpp": ["CLI/CLI.hpp", "readline/readline.h", "fmt/core.h", "xxhash.h", "xxh3.h"],
            "scripting/cli/h.h": ["CLI/CLI.hpp", "spdlog/spdlog.h"],
        }
        expected = []
        for name, headers in planted.items():
            self.write(name, "".join(f"#include <{header}>\n" for header in headers))
            expected += [f"{name}:{i}: adapter:" for i in range(1, len(headers) + 1)]
        self.expect(*expected)

    def test_unknown_library(self):
        self.write("io/text/x.cpp", "#include <boost/any.hpp>\n")
        self.expect("io/text/x.cpp:1: unknown library:")

    def test_cgal_outside_its_adapters(self):
        self.write("geom/mesh/a.cpp", "#include <CGAL/Surface_mesh.h>\n")
        self.expect("geom/mesh/a.cpp:1: adapter:")

    def test_cycle(self):
        self.write("geom/base/p.h", '#include "geom/base/q.h"\n')
        self.write("geom/base/q.h", '#include <vector>\n#include "geom/base/r.h"\n')
        self.write("geom/base/r.h", '#include "geom/base/p.h"\n')
        self.expect("geom/base/r.h:1: include cycle: geom/base/p.h -> geom/base/q.h -> geom/base/r.h -> geom/base/p.h")

    def test_printing(self):
        self.write("geom/base/p.cpp", "void f() {\n  std::cout << 1;\n}\n")
        self.write("io/text/p.cpp", 'void f() { printf("x"); }\n')
        self.write("surfmesh/face/p.cpp", "void f(FILE* f);\nvoid g() { f(stderr); }\n")
        self.write("volmesh/tetra/hxt_main.cpp", "void f() { std::cout << 1; }\n")
        self.expect("geom/base/p.cpp:2: printing:", "io/text/p.cpp:1: printing:", "surfmesh/face/p.cpp:2: printing:", "volmesh/tetra/hxt_main.cpp:1: printing:")

    def test_length(self):
        self.write("io/text/long.cpp", "\n" * 801)
        self.write("io/text/just.cpp", "\n" * 800)
        self.expect("io/text/long.cpp:800: length:")

    def test_linking(self):
        source = self.root / "planted.cpp"
        clean, dirty = self.root / "clean", self.root / "dirty"
        source.write_text("int main() {}\n")
        subprocess.run([COMPILER, "-o", clean, source], check=True)
        # A symbol of the library's name stands for the library linked statically.
        source.write_text("struct tetgenmesh { __attribute__((noinline, used)) void f(); }; void tetgenmesh::f() {}\nint main() { tetgenmesh().f(); }\n")
        subprocess.run([COMPILER, "-o", dirty, source], check=True)
        self.assertEqual(self.run_check("--binary", str(clean)).returncode, 0)
        self.assertIn("linking", self.run_check("--binary", str(dirty)).stdout)
        self.assertEqual(self.run_check("--binary", str(dirty)).returncode, 1)
        self.assertEqual(self.run_check("--binary", str(self.root / "absent")).returncode, 1)

    def test_linking_of_the_shared_library(self):
        source, dirty = self.root / "planted.cpp", self.root / "dirty"
        source.write_text("int main() {}\n")
        subprocess.run([COMPILER, "-o", dirty, source, "-Wl,--no-as-needed", "-ltet"], check=True)
        self.assertIn("libtet", self.run_check("--binary", str(dirty)).stdout)


if __name__ == "__main__":
    CHECK = str(pathlib.Path(sys.argv[1]).resolve())
    COMPILER = sys.argv[2] if len(sys.argv) > 2 else COMPILER
    unittest.main(argv=sys.argv[:1])
