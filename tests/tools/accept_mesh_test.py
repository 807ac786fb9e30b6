#!/usr/bin/python3
"""tools/accept_mesh accepts good meshes of ours, whole, half, in wind tunnels and periodic, and refuses one with a node in the wrong place. Exit status 77: a program that it needs is not installed.

usage: accept_mesh_test.py ACCEPT_MESH STERNA BOX.stl
"""
import pathlib
import subprocess
import sys
import tempfile

NOT_INSTALLED = 77


def accept(tool, sterna, mesh, *more):
    result = subprocess.run([tool, mesh, "--sterna", sterna, *more], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    print(result.stdout)
    if result.returncode == NOT_INSTALLED:
        sys.exit(NOT_INSTALLED)
    return result.returncode, result.stdout


def main():
    tool, sterna, box = sys.argv[1:4]
    with tempfile.TemporaryDirectory() as folder:
        good = pathlib.Path(folder) / "good.su2"
        subprocess.run([sterna, "--quiet", "mesh", box, "--layers", "5", "--first-height", "1e-3", "--farfield-radius", "10", "-o", good], check=True)
        status, output = accept(tool, sterna, good)
        assert status == 0 and output.count(" accepts ") == 3, "a good mesh is refused"
        # The last node is one of tetrahedra; far outside, it turns them inside out.
        lines = good.read_text().splitlines(keepends=True)
        first = next(i for i, line in enumerate(lines) if line.startswith("NPOIN"))
        last = first + int(lines[first].split("=")[1].split()[0])
        lines[last] = "1e3 1e3 1e3 " + " ".join(lines[last].split()[3:]) + "\n"
        bad = pathlib.Path(folder) / "bad.su2"
        bad.write_text("".join(lines))
        status, output = accept(tool, sterna, bad)
        assert status == 1 and "checkMesh      REFUSES" in output, "a bad mesh is accepted"
        script = pathlib.Path(__file__).resolve().parent / "accept_small.lua"
        subprocess.run([sterna, "--quiet", "run", script], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        for name in ("half", "tunnel", "half_span", "blade"):
            status, output = accept(tool, sterna, pathlib.Path(folder) / f"{name}.sterna", *(["--flow", "1", "0", "0"] if name == "half" else []))
            assert status == 0 and output.count(" accepts ") == 3, f"{name} is refused"


main()
