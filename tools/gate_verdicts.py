"""`tools/verify_gates verdicts`: compares old and new verdicts for a collection of files, without a solver.

Each file is meshed by `sterna mesh --auto` with few layers on coarse triangles, and the mesh is checked for all solvers. The old verdict ("before") is the rule of
25 November 2026: a mesh FAILs if any value exceeds one of the hard limits of that day (BEFORE), independent of the solver and of the evidence for the limit. With --meshes
the files are volume meshes of other programs, which are checked without changes."""
import argparse
import collections
import json
import pathlib
import shutil
import subprocess
import sys

# measure: (hard limit of 25 November 2026, whether the limit is a lower bound)
BEFORE = {"orthogonality": (5.0, True), "sub_volume_ratio": (1e5, False), "stack_growth": (1.5, False), "interface_height": (8.0, False), "interface_volume": (8.0, False), "first_height": (0.2, False),
          "coverage": (0.95, True), "layer_step": (1.0, False), "min_dihedral": (5.0, True), "max_dihedral": (170.0, False), "tet_growth": (20.0, False), "edge_ratio": (100.0, False),
          "non_orthogonality": (90.0, False), "skewness": (20.0, False), "face_weight": (0.05, True), "volume_ratio": (0.01, True), "cell_openness": (1e-6, False), "face_tets": (1e-30, True)}
LAYERS, HEIGHT = 12, 1e-4  # number of layers; first height over the body length


def run(command: list, folder: pathlib.Path, limit: float) -> tuple[int | None, str]:
    """Returns exit status (None: no answer within the limit) and output."""
    try:
        done = subprocess.run([str(word) for word in command], cwd=folder, capture_output=True, text=True, errors="replace", timeout=limit)
    except subprocess.TimeoutExpired:
        return None, ""
    return done.returncode, done.stdout + done.stderr


def first_object(text: str) -> dict | None:
    try:
        return json.JSONDecoder().raw_decode(text[text.index("{"):])[0]
    except ValueError:
        return None


def before(report: dict) -> list[str]:
    """Returns the measures beyond the hard limits of 25 November. Measures whose values beyond the limit are all forced do not count, as on that day."""
    missed = []
    for entry in report["measures"]:
        limit = BEFORE.get(entry["measure"])
        if not limit or entry["state"] == "not checked" or entry["worst"] is None:
            continue
        is_beyond = entry["worst"] < limit[0] if limit[1] else entry["worst"] > limit[0]
        is_all_forced = entry.get("forced") and entry["forced"] == entry.get("beyond_hard")
        if is_beyond and not is_all_forced:
            missed.append(entry["measure"])
    return missed


def verdicts_of(sterna: pathlib.Path, mesh: pathlib.Path, folder: pathlib.Path, limit: float) -> dict | None:
    _, text = run([sterna, "check", mesh, "--for", "all", "--json", "--quiet", "--threads", "1"], folder, limit)
    report = first_object(text)
    if not report:
        return None
    states = {v["consumer"]: v["state"] for v in report["verdicts"]}
    if report["verdict"] != "VALID":
        states = dict.fromkeys(states, "INVALID")
    missed = before(report)
    return {"cells": report["cells"]["total"], "before": "INVALID" if report["verdict"] != "VALID" else "FAIL" if missed else "pass or warn", "missed": missed, **states}


def mesh_file(arguments, path: pathlib.Path, folder: pathlib.Path) -> str:
    """Makes mesh.sterna from a file; returns the reason if this fails, otherwise an empty string."""
    _, text = run([arguments.sterna, "inspect", path, "--json", "--quiet", "--threads", "1"], folder, arguments.limit)
    described = first_object(text)
    if not described or not described.get("length"):
        return "inspect gives no length"
    status, text = run([arguments.sterna, "mesh", path, "--auto", "--layers", LAYERS, "--first-height", repr(HEIGHT * described["length"]), "--threads", "1", "-o", "mesh.sterna"], folder, arguments.limit)
    errors = [line for line in text.splitlines() if "error" in line]
    return "" if status == 0 else f"no answer within {arguments.limit:.0f} s" if status is None else errors[0].replace(str(path), path.name)[:120] if errors else "no mesh"


def judge_file(arguments, path: pathlib.Path) -> dict:
    """Meshes a file if its mesh does not exist, and judges the mesh. An existing mesh is judged again, because limits may have changed."""
    folder = arguments.folder / path.name
    done, mesh = folder / "verdict.json", folder / "mesh.sterna"
    if done.exists() and not mesh.exists():
        return json.loads(done.read_text())
    folder.mkdir(parents=True, exist_ok=True)
    why = "" if mesh.exists() else mesh_file(arguments, path, folder)
    result = {"why": why} if why else verdicts_of(arguments.sterna, mesh, folder, arguments.limit) or {"why": "check gives no report"}
    if not arguments.keep:
        mesh.unlink(missing_ok=True)
    done.write_text(json.dumps(result))
    return result


def judge_script(arguments, path: pathlib.Path) -> list[tuple[str, dict]]:
    """Runs a script and judges each volume mesh it writes; a script that writes CAD files alone has them meshed as files are."""
    folder = arguments.folder / path.name
    done = folder / "verdict.json"
    if done.exists():
        return [(name, result) for name, result in json.loads(done.read_text()).items()]
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(path.parent, folder)
    status, text = run([arguments.sterna, "run", path.name], folder, 10 * arguments.limit)
    if status != 0:
        errors = [line for line in text.splitlines() if "error" in line]
        return [(path.name, {"why": f"no answer within {10 * arguments.limit:.0f} s" if status is None else errors[0][:120] if errors else "the script failed"})]
    meshes = sorted(file for file in folder.rglob("*") if file.suffix in (".su2", ".cgns"))
    rows = [(f"{path.name}: {mesh.name}", verdicts_of(arguments.sterna, mesh, folder, arguments.limit) or {"why": "check gives no report"}) for mesh in meshes]
    if not meshes:
        rows = [(f"{path.name}: {file.name}", judge_file(arguments, file)) for file in sorted(folder.glob("*.step"))]
    done.write_text(json.dumps(dict(rows)))
    return rows


def words(state: str) -> str:
    return "FAIL" if state == "fail" else state


def table(rows: list[tuple[str, dict]]) -> None:
    print("| file | cells | before | cell-centred | node-centred | hard limits of before that are missed |\n|---|---|---|---|---|---|")
    counts = {key: collections.Counter() for key in ("before", "cell-centred", "node-centred")}
    for name, result in rows:
        if "why" in result:
            print(f"| {name} | - | no mesh: {result['why'].replace('|', '/')} | - | - | - |")
            continue
        for key in counts:
            counts[key][words(result.get(key, "not checked"))] += 1
        print(f"| {name} | {result['cells']} | {result['before']} | {words(result.get('cell-centred', '-'))} | {words(result.get('node-centred', '-'))} | {', '.join(result['missed']) or '-'} |")
    for key, counter in counts.items():
        print(f"\n{key}: " + ", ".join(f"{n} {state}" for state, n in counter.most_common()))


def main(words_of_command: list[str], root: pathlib.Path) -> int:
    parser = argparse.ArgumentParser(prog="verify_gates verdicts", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*", type=pathlib.Path, help="surfaces, models and scripts (.lua: every volume mesh that the script writes, with its own options), or volume meshes to be checked as they are (--meshes); without: clean surfaces, CAD, CPACS, smx of --data")
    parser.add_argument("--folder", type=pathlib.Path, default=pathlib.Path("verdicts"))
    parser.add_argument("--data", type=pathlib.Path, default=root.parent / "shared/data")
    parser.add_argument("--sterna", type=pathlib.Path, default=root / "build/release/sterna")
    parser.add_argument("--limit", type=float, default=60.0, help="seconds for each step of a file")
    parser.add_argument("--keep", action="store_true", help="keep the meshes, so that another program can judge them again")
    parser.add_argument("--meshes", action="store_true", help="the files are volume meshes, as other programs have made them")
    arguments = parser.parse_args(words_of_command)
    arguments.sterna, arguments.folder = arguments.sterna.resolve(), arguments.folder.resolve()
    files = arguments.files or [path for part in ("surfaces/clean", "cad", "cpacs", "smx") for path in sorted((arguments.data / part).glob("*"))]
    if not files:
        print(f"skipped: no files in {arguments.data}")
        return 77
    rows = []
    for path in files:
        path = path.resolve()
        if path.suffix == ".lua":
            rows += judge_script(arguments, path)
            print(f"{path.name}: {rows[-1][1]}", file=sys.stderr, flush=True)
            continue
        if arguments.meshes:
            arguments.folder.mkdir(parents=True, exist_ok=True)
            result = verdicts_of(arguments.sterna, path, arguments.folder, arguments.limit) or {"why": "check gives no report"}
        else:
            result = judge_file(arguments, path)
        rows.append((path.name, result))
        print(f"{path.name}: {result.get('why') or result}", file=sys.stderr, flush=True)
    table(rows)
    return 0
