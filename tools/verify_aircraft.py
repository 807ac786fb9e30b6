"""Meshes and runs aircraft of every kind with cases of foam_case: `tools/verify_flow aircraft`. Twelve aircraft run at Mach 0.2 with Spalart-Allmaras, six of them
also at Mach 0.5, and four with k-omega SST. A run has converged if Allrun ends without divergence, and if drag and lift change by at most 0.5 % of the larger of both
over the last 100 of at most 600 iterations.

Each aircraft and each run has its own folder. A run with a result.json is not repeated, so the tool can be stopped and started again. Aircraft without a file in the
data folder (--data, ../shared/data) are skipped with a message."""
import json
import os
import pathlib
import re
import shutil

ROOT = pathlib.Path(__file__).resolve().parent.parent
FAMILY_BAND = 0.03         # share: drag of the two finest meshes of a family
WINDOW, BAND = 100, 0.005  # iterations, share: a run has converged if its forces stay within this band
REFERENCE = 0.1            # reference area over the square of the length
CREVICE = 0.005            # width over the length, up to which crevices are filled at trailing edges that overhang a body; real aircraft have a fillet there


def script_before(name: str, end: str) -> str:
    text = (ROOT / "scripts" / name).read_text()
    return text[:text.index(end)]


def model_mesh(model: str, refinement: float) -> str:
    """Cuts the complete wall at the plane of symmetry and re-meshes it, because the plane contains edges of some models, which are hard to cut."""
    return f"local wall = remesh{{ half{{ surface_mesh{{ union{{ {model} }}, refinement = 0.5, curvature_angle = 24*deg }} }}, refinement = {refinement} }}\n"


def file_mesh(reader: str, file: pathlib.Path, refinement: float) -> str:
    return model_mesh(f'{reader} "{file}"', refinement)


def surface_mesh(file: pathlib.Path, options: str, refinement: float) -> str:
    return f'local wall = remesh{{ half{{ read_surface{{ "{file}", {options} }} }}, refinement = {refinement} }}\n'


class Aircraft:
    """`make` writes the script of the wall from the data folder; `file` is in that folder, or empty; `has_crevices`: crevices are filled; `fast`: also at Mach 0.5; `sst`: also with k-omega SST; `has_engines`: has patches nozzle and fan_face."""

    def __init__(self, name: str, make, file: str = "", fast: bool = False, sst: bool = False, has_engines: bool = False,
                 has_crevices: bool = False):
        self.name, self.make, self.file, self.fast, self.sst, self.has_engines, self.has_crevices = name, make, file, fast, sst, has_engines, has_crevices

    def script(self, data: pathlib.Path) -> str:
        """Returns the script of the wall, with filled crevices."""
        return self.make(data) + (f"wall = fill_crevices{{ wall, width = {CREVICE}*wall.length }}\n" if self.has_crevices else "")

    def is_there(self, data: pathlib.Path) -> bool:
        return not self.file or (data / self.file).exists()


def of_file(name: str, reader: str, file: str, refinement: float, **more) -> Aircraft:
    return Aircraft(name, lambda data: file_mesh(reader, data / file, refinement), file, **more)


def of_surface(name: str, file: str, options: str, refinement: float, **more) -> Aircraft:
    file = "surfaces/clean/" + file
    return Aircraft(name, lambda data: surface_mesh(data / file, options, refinement), file, **more)


AIRCRAFT = [
    Aircraft("airliner", lambda _: script_before("03_airliner.lua", "model:write") + model_mesh("model", 0.1), fast=True, sst=True, has_engines=True),
    Aircraft("light", lambda _: script_before("07_aircraft_to_mesh.lua", "-- Without numbers") + model_mesh("model", 0.3), fast=True, sst=True),
    of_file("bjet", "read_smx", "smx/bjet.smx", 0.28, fast=True),
    of_file("widebody", "read_smx", "smx/widebody.smx", 0.19, has_crevices=True),
    of_file("delta", "read_smx", "smx/delta.smx", 0.3, fast=True, has_crevices=True),
    of_file("D150", "read_cpacs", "cpacs/CPACS_30_D150.xml", 0.33, fast=True, has_crevices=True),
    of_file("box_wing", "read_cpacs", "cpacs/boxWing.xml", 0.3, has_crevices=True),
    of_surface("geom2", "vspgeom_geom2_geom2.stl", "split_angle = 60*deg", 0.6, sst=True),
    of_surface("wing_body", "wing_body_79k.stl", "split_angle = 60*deg", 0.6),
    of_surface("dlr_f6", "dlr_f6_184k.stl", "unit = mm, split_angle = 60*deg", 0.26),
    of_surface("cessna", "flowpanel_cessna_cessna.msh", "unit = ft, split_angle = 60*deg", 0.36, sst=True),
    of_surface("airplane", "flow360_airplane_airplaneGeometry.stl", "split_angle = 60*deg", 0.5, fast=True),
]
# One aircraft on walls of about 6 000, 12 000 and 24 000 triangles: how much of drag and lift is due to the mesh.
FAMILY = [of_surface(f"airplane_family_{i}", "flow360_airplane_airplaneGeometry.stl", "split_angle = 60*deg", refinement) for i, refinement in enumerate((0.5, 0.7, 1.0))]
SHORT = ["light", "bjet"]  # bjet diverged at iteration 15 when four vertices of its plane of symmetry had no layer
SHORT_ITERATIONS = 24

MESH = """
local stream = flow{ mach = 0.2, altitude = 0, length = wall.length }
local cells = volume_mesh{ wall, first_height = y_plus{ 1, stream },
  farfield = sphere{ radius = 20*wall.length } }
cells:write "mesh.sterna"
print("counts", wall.triangles, wall.length)
"""
CASE = """local cells = read_mesh "../mesh.sterna"
cells:foam_case{{ "case", flow{{ mach = {mach}, altitude = 0, length = {length} }}, alpha = 2*deg, reference_area = {area}, model = "{model}", iterations = {iterations}{boundaries} }}
"""
SEA_LEVEL = 101325.0  # Pa
JET, FACE = 1.1, 0.4  # relative to the stagnation pressure rise: total pressure in the nozzle, pressure at the fan face; engines with little thrust


SEA_LEVEL_TEMPERATURE = 288.15  # K


def engine_boundaries(mach: float) -> str:
    rise = SEA_LEVEL * ((1.0 + 0.2 * mach ** 2) ** 3.5 - 1.0)
    hot = f", total_temperature = {SEA_LEVEL_TEMPERATURE * (1.0 + 0.2 * mach ** 2):.2f}" if mach >= 0.3 else ""  # only for compressible flow; the jet has the temperature of the free stream
    return f", boundaries = {{ nozzle = {{ total_pressure = {SEA_LEVEL + JET * rise:.0f}{hot} }}, fan_face = {{ pressure = {SEA_LEVEL + FACE * rise:.0f} }} }}"


class Run:
    """One aircraft at one Mach number with one turbulence model."""

    def __init__(self, aircraft: Aircraft, mach: float, model: str):
        self.aircraft, self.mach, self.model = aircraft, mach, model

    def folder(self) -> str:
        return f"mach_{self.mach}_{self.model}"


def runs_of(names: list[str], is_short: bool) -> list[Run]:
    chosen = [aircraft for aircraft in AIRCRAFT + FAMILY if aircraft.name in names]
    runs = [Run(a, 0.2, "SpalartAllmaras") for a in chosen]
    if is_short:
        return runs
    return runs + [Run(a, 0.5, "SpalartAllmaras") for a in chosen if a.fast] + [Run(a, 0.2, "kOmegaSST") for a in chosen if a.sst]


def mesh_of(tools, arguments, aircraft: Aircraft, folder: pathlib.Path) -> dict:
    """Makes the mesh of the aircraft, once for all its runs."""
    done = folder / "mesh.result.json"
    if done.exists():
        return json.loads(done.read_text())
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    shutil.copytree(ROOT / "scripts" / "data", folder / "data")
    (folder / "mesh.lua").write_text(aircraft.script(arguments.data.resolve()) + MESH)
    seconds = tools.run([arguments.sterna, "run", "mesh.lua"], folder, "log.sterna")
    log = (folder / "log.sterna").read_text()
    found = re.search(r"^counts\s+(\d+)\s+(\S+)$", log, re.M)
    layers = re.search(r"(\d+) layers that grow by", log)
    result = {"seconds": round(seconds, 1), "triangles": int(found[1]), "length": float(found[2]), "layers": int(layers[1])}
    done.write_text(json.dumps(result))
    return result


def coefficient_rows(paths: list[pathlib.Path]) -> list[tuple[float, float, float]]:
    """Returns (iteration, CD, CL) of all parts of a run; where parts overlap, of the later part."""
    rows = {}
    for path in paths:
        names = []
        for line in path.read_text().splitlines():
            if line.startswith("# Time"):
                names = line.lstrip("# ").split()
            elif line and not line.startswith("#"):
                value = dict(zip(names, map(float, line.split())))
                rows[value["Time"]] = (value["Time"], value["Cd"], value["Cl"])
    return [rows[key] for key in sorted(rows)]


def spread(rows: list[tuple[float, float, float]]) -> float:
    """Returns the largest change of CD or CL over the last iterations. Lift is relative to the larger of both at the end, because it may be near zero."""
    last = [row for row in rows if row[0] > rows[-1][0] - WINDOW]
    drag, lift = [row[1] for row in last], [row[2] for row in last]
    scale = max(abs(drag[-1]), abs(lift[-1]))
    return max((max(drag) - min(drag)) / abs(drag[-1]), (max(lift) - min(lift)) / scale)


def solve(tools, arguments, run: Run, mesh: dict, folder: pathlib.Path, iterations: int) -> dict:
    done = folder / "result.json"
    if done.exists():
        return json.loads(done.read_text())
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (folder / "case.lua").write_text(CASE.format(mach=run.mach, length=mesh["length"], area=REFERENCE * mesh["length"] ** 2, model=run.model, iterations=iterations,
                                                        boundaries=engine_boundaries(run.mach) if run.aircraft.has_engines else ""))
    tools.run([arguments.sterna, "run", "case.lua"], folder, "log.sterna")
    angle = re.search(r"largest angle .* is ([\d.]+) degrees", (folder / "case/system/fvSchemes").read_text())
    result = {"cells": tools.mesh_numbers(folder / "case"), "angle": float(angle[1]) if angle else None}
    try:
        result["seconds"] = round(tools.run(["case/Allrun"], folder, "log.Allrun"), 1)
        result["outcome"] = "ended"
    except tools.subprocess.CalledProcessError:
        result["outcome"] = "stopped"
    says = [line for line in (folder / "log.Allrun").read_text().splitlines() if line and not line.startswith("#")]
    result["says"] = says[-1] if says else ""
    rows = coefficient_rows(tools.parts(folder / "case", "forceCoeffs", "coefficient.dat"))
    if rows:
        result.update(iterations=rows[-1][0], CD=rows[-1][1], CL=rows[-1][2], spread=spread(rows))
    done.write_text(json.dumps(result, indent=1))
    if not arguments.keep:
        for part in (folder / "case").iterdir():
            if part.name == "constant" or re.fullmatch(r"[1-9]\d*", part.name):
                shutil.rmtree(part)
    return result


def aircraft(tools, arguments) -> None:
    names = arguments.aircraft or (SHORT if arguments.short else [a.name for a in AIRCRAFT])
    compute(tools, arguments, names)


def family(tools, arguments) -> None:
    """Runs three meshes of one aircraft; requires that the drag of the two finest agrees within 3 %."""
    results = compute(tools, arguments, [a.name for a in FAMILY])
    drags = [result["CD"] for result in results if "CD" in result]
    if len(drags) < len(FAMILY):
        return
    change = abs(drags[-1] - drags[-2]) / drags[-1]
    print(f"drag of the two finest meshes differs by {100 * change:.1f} %")
    arguments.require(change <= FAMILY_BAND, f"family: drag of the two finest meshes differs by {100 * change:.1f} %, the limit is {100 * FAMILY_BAND:.0f} %")


def compute(tools, arguments, names: list[str]) -> list[dict]:
    """Meshes and runs aircraft, prints their table and returns their results."""
    results = []
    place = arguments.folder / ("aircraft_short" if arguments.short else "aircraft")
    if arguments.short:  # a test must not use meshes of another program
        shutil.rmtree(place, ignore_errors=True)
    print("| aircraft | Mach, model | triangles, layers | cells | largest angle | iterations | CD | CL | change over the last 100 | seconds: mesh, solver |\n"
          "|---|---|---|---|---|---|---|---|---|---|")
    for run in runs_of(names, arguments.short):
        body = run.aircraft
        if not body.is_there(arguments.data):
            print(f"skipped: {body.name}, whose file {arguments.data / body.file} is not there", flush=True)
            arguments.require(os.environ.get("STERNA_REQUIRE_DATA") != "1", f"{body.name} was skipped, which STERNA_REQUIRE_DATA=1 does not allow")
            continue
        folder = place / body.name
        label = f"{body.name} at Mach {run.mach} with {run.model}"
        try:
            mesh = mesh_of(tools, arguments, body, folder)
            result = solve(tools, arguments, run, mesh, folder / run.folder(), SHORT_ITERATIONS if arguments.short else arguments.iterations)
        except tools.subprocess.CalledProcessError as failure:
            arguments.require(False, f"{label}: {failure}; the log is in {folder}")
            continue
        results.append(result)
        has_forces = "spread" in result
        print(f"| {body.name} | {run.mach}, {run.model} | {mesh['triangles']}, {mesh['layers']} | {result['cells']} | {result['angle']} | " +
              (f"{result['iterations']:.0f} | {result['CD']:.4f} | {result['CL']:.4f} | {100 * result['spread']:.2f} %" if has_forces else "- | - | - | -") +
              f" | {mesh['seconds']:.0f}, {result.get('seconds', 0):.0f} |", flush=True)
        arguments.require(result["outcome"] == "ended" and has_forces, f"{label}: {result['says']}")
        if not arguments.short and has_forces:
            arguments.require(result["spread"] <= BAND, f"{label}: forces change by {100 * result['spread']:.2f} % over the last {WINDOW} iterations")
    return results
