#!/usr/bin/python3
"""The installed libraries are found by another project, whose program makes a mesh that the sterna program finds VALID. usage: library_test.py BUILD_FOLDER SOURCE_FOLDER BOX_STL"""
import pathlib
import subprocess
import sys
import tempfile


def run(*arguments) -> str:
    done = subprocess.run([str(a) for a in arguments], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{arguments} ended with {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def main() -> int:
    build, source, box = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
    with tempfile.TemporaryDirectory() as folder:
        prefix, work, mesh = pathlib.Path(folder, "prefix"), pathlib.Path(folder, "build"), pathlib.Path(folder, "box.su2")
        run("cmake", "--install", build, "--prefix", prefix, "--component", "library")
        run("cmake", "-S", source / "docs/library", "-B", work, f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_BUILD_TYPE=Release")
        run("cmake", "--build", work)
        told = run(work / "mesh_box", box, mesh)
        checked = run(build / "sterna", "check", mesh)
    print(told, checked.splitlines()[0])
    return 0 if told.rstrip().endswith("VALID") and checked.startswith("VALID") else 1


if __name__ == "__main__":
    sys.exit(main())
