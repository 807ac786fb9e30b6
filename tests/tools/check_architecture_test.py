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
    "surfmesh/s.cpp": '#include "geom/base/a.h"\n#include <Eigen/Dense>\n',
    "volmesh/tetra/tetgen_main.cpp": '#include <tetgen.h>\nvoid f() { std::fprintf(stderr, "died"); }\n',
    "io/w.cpp": '#include "geom/base/a.h"\n#include <zlib.h>\n',
    "scripting/m.cpp": '#include "io/w.h"\n#include "surfmesh/s.h"\n#include <lua.hpp>\n#include <CLI/CLI.hpp>\nvoid f() { std::cout << 1; }\n',
    "io/w.h": "#pragma once\n",
    "surfmesh/s.h": "#pragma once\n",
}


class CheckArchitecture(unittest.TestCase):
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
        self.write("geom/base/b.h", '#pragma once\n#include "io/w.h"\n')
        self.write("volmesh/v.cpp", '#include "surfmesh/s.h"\n')
        self.write("io/x.cpp", '\n\n#include "scripting/m.h"\n')
        self.expect("geom/base/b.h:2: direction:", "volmesh/v.cpp:1: direction:", "io/x.cpp:3: direction:")

    def test_include_paths(self):
        self.write("io/x.cpp", '#include "w.h"\n#include "io/missing.h"\n#include "io/w.cpp"\n')
        self.expect("io/x.cpp:1: include path:", "io/x.cpp:2: include path:", "io/x.cpp:3: include path:")

    def test_third_party_headers_outside_their_adapter(self):
        planted = {
            "geom/mesh/a.cpp": ["tbb/parallel_for.h", "lua.hpp", "nlopt.h", "tetgen.h", "gmsh.h", "BRep_Tool.hxx"],
            "geom/base/a.h": ["tbb/parallel_for.h", "Eigen/Dense", "nlohmann/json.hpp"],
            "volmesh/envelope/e.h": ["nlopt.h"],
            "volmesh/tetra/engine.cpp": ["tetgen.h", "gmsh.h_cwrap"],
            "surfmesh/s.cpp": ["CGAL/Surface_mesh.h", "zlib.h", "spdlog/spdlog.h"],
            "scripting/m.cpp": ["cgnslib.h", "netcdf.h", "hdf5.h", "lz4.h", "tbb/task_arena.h"],
            "io/w.cpp": ["CLI/CLI.hpp", "readline/readline.h", "fmt/core.h", "xxhash.h", "xxh3.h"],
            "scripting/h.h": ["CLI/CLI.hpp", "spdlog/spdlog.h"],
        }
        expected = []
        for name, headers in planted.items():
            self.write(name, "".join(f"#include <{header}>\n" for header in headers))
            expected += [f"{name}:{i}: adapter:" for i in range(1, len(headers) + 1)]
        self.expect(*expected)

    def test_unknown_library(self):
        self.write("io/x.cpp", "#include <boost/any.hpp>\n")
        self.expect("io/x.cpp:1: unknown library:")

    def test_cgal_in_two_files(self):
        self.write("geom/mesh/a.cpp", "#include <CGAL/Surface_mesh.h>\n")
        self.write("geom/model/b.cpp", "#include <CGAL/Surface_mesh.h>\n")
        self.expect("geom/model/b.cpp:1: adapter:")

    def test_cycle(self):
        self.write("geom/base/p.h", '#include "geom/base/q.h"\n')
        self.write("geom/base/q.h", '#include <vector>\n#include "geom/base/r.h"\n')
        self.write("geom/base/r.h", '#include "geom/base/p.h"\n')
        self.expect("geom/base/r.h:1: include cycle: geom/base/p.h -> geom/base/q.h -> geom/base/r.h -> geom/base/p.h")

    def test_printing(self):
        self.write("geom/base/p.cpp", "void f() {\n  std::cout << 1;\n}\n")
        self.write("io/p.cpp", 'void f() { printf("x"); }\n')
        self.write("surfmesh/p.cpp", "void f(FILE* f);\nvoid g() { f(stderr); }\n")
        self.write("volmesh/tetra/hxt_main.cpp", "void f() { std::cout << 1; }\n")
        self.expect("geom/base/p.cpp:2: printing:", "io/p.cpp:1: printing:", "surfmesh/p.cpp:2: printing:", "volmesh/tetra/hxt_main.cpp:1: printing:")

    def test_length(self):
        self.write("io/long.cpp", "\n" * 801)
        self.write("io/just.cpp", "\n" * 800)
        self.expect("io/long.cpp:800: length:")

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
