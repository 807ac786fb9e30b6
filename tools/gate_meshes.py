"""Defines the meshes of `tools/verify_gates`: sound meshes of many bodies at three sizes, and damaged meshes of a wing and an aircraft. The bodies have walls that can be
re-meshed to about a thousand triangles, so that a run takes about a minute."""
import pathlib

import verify_aircraft

SIZED = """local function sized(surface, target)
  local refinement, wall = 0.4
  for attempt = 1, 4 do
    wall = remesh{ surface, refinement = refinement }
    if math.abs(wall.triangles / target - 1) < 0.2 then break end
    refinement = refinement * math.sqrt(target / wall.triangles)
  end
  return wall
end
"""
VOLUME = """local cells = volume_mesh{{ wall, {first}farfield = sphere{{ radius = 15*wall.length }}{more} }}
cells:write "mesh.sterna"
cells:write "mesh.lb8.ugrid"
print("counts", wall.triangles, wall.length)
"""
LAYERS = "first_height = {height}*wall.length, "
Y_PLUS = "first_height = y_plus{ 1, mach = 0.2, altitude = 0, length = wall.length }, "
SMALL, LARGE, REFINED = 500, 800, 2000  # number of triangles of the wall


class Body:
    """A wall: `make` writes its script for a number of triangles; `file` is in the data folder, or empty."""

    def __init__(self, name: str, make, file: str = ""):
        self.name, self.make, self.file = name, make, file


def of_surface(name: str, file: str, options: str = "", is_half: bool = False) -> Body:
    def make(data: pathlib.Path, triangles: int) -> str:
        surface = f'read_surface{{ "{data / file}", split_angle = 60*deg{", " + options if options else ""} }}'
        return f"local wall = sized({f'half{{ {surface} }}' if is_half else surface}, {triangles})\n"
    return Body(name, make, file)


def of_model(name: str, reader: str, file: str, is_half: bool = True, unite: bool = True) -> Body:
    def make(data: pathlib.Path, triangles: int) -> str:
        model = f'{reader} "{data / file}"'
        surface = f"surface_mesh{{ {f'union{{ {model} }}' if unite else model}, refinement = 0.5, curvature_angle = 24*deg }}"
        return f"local wall = sized({f'half{{ {surface} }}' if is_half else surface}, {triangles})\n"
    return Body(name, make, file)


def of_script(name: str, script: str, end: str, is_half: bool = True) -> Body:
    def make(_: pathlib.Path, triangles: int) -> str:
        surface = "surface_mesh{ union{ model }, refinement = 0.5, curvature_angle = 24*deg }"
        return verify_aircraft.script_before(script, end) + f"local wall = sized({f'half{{ {surface} }}' if is_half else surface}, {triangles})\n"
    return Body(name, make)


BODIES = [
    of_script("first_mesh", "01_first_mesh.lua", "-- The wall:"),
    of_surface("geom2", "surfaces/clean/vspgeom_geom2_geom2.stl", is_half=True),
    of_surface("wing_body", "surfaces/clean/wing_body_79k.stl", is_half=True),
    of_surface("bwb", "surfaces/clean/pygeo_bwb.stl"),
    of_surface("airplane", "surfaces/clean/flow360_airplane_airplaneGeometry.stl", is_half=True),
    of_surface("cessna", "surfaces/clean/flowpanel_cessna_cessna.msh", "unit = ft", is_half=True),
    of_surface("swept_wing", "surfaces/clean/flowpanel_sweptwing_sweptwing-openvsp.msh"),
    of_surface("duct", "surfaces/clean/flowpanel_duct_duct_remeshed_refined.msh"),
    of_surface("caturbs", "surfaces/clean/caturbs_wing_wing.stl"),
    of_surface("ka6d", "surfaces/clean/meshpy_ka6d_ka-6d.ply"),
    of_surface("lab_plane", "surfaces/clean/pymeshlab_airplane_airplane.obj"),
    of_surface("fandisk", "surfaces/clean/pmp_fandisk.off"),
    of_model("m6_cpacs", "read_cpacs", "cpacs/onera_m6.xml"),
    of_model("m6_sharp", "read_cad", "cad/refine_m6_onera-m6-sharp-te.egads.brep", is_half=False, unite=False),
    of_model("m6_igs", "read_cad", "cad/onera_m6_su2_geom_oneram6.IGS", is_half=False, unite=False),
    of_model("simple_wing", "read_cad", "cad/tigl_simplewing_simplewing.brep", is_half=False, unite=False),
    of_surface("coupling", "surfaces/clean/cgal_data_couplingdown.off"),
    of_model("simple_test", "read_cpacs", "cpacs/simpletest.cpacs.xml"),
    of_surface("crm", "surfaces/clean/derived_crm_wb_dpw_coarse_full.off"),
    of_model("D150", "read_cpacs", "cpacs/CPACS_30_D150.xml"),
    of_model("utility", "read_smx", "smx/utility.smx"),
    of_model("box_wing", "read_cpacs", "cpacs/boxWing.xml"),
    of_model("canards", "read_cpacs", "cpacs/canards.xml"),
    of_script("light", "07_aircraft_to_mesh.lua", "-- Without numbers"),
    of_surface("dlr_f6", "surfaces/clean/dlr_f6_184k.stl", "unit = mm", is_half=True),
    of_model("delta", "read_smx", "smx/delta.smx"),
    of_model("bjet", "read_smx", "smx/bjet.smx"),
    of_script("fighter", "04_fighter_with_stores.lua", "model:write"),
    of_model("widebody", "read_smx", "smx/widebody.smx"),
]
LARGE_BODIES = ["first_mesh", "geom2", "wing_body", "bwb", "airplane", "cessna", "swept_wing", "caturbs", "m6_sharp", "lab_plane", "duct", "fandisk", "m6_cpacs"]
REFINED_BODIES = ["wing_body", "geom2", "airplane", "caturbs", "lab_plane", "light", "bjet", "crm", "swept_wing", "simple_wing", "dlr_f6", "first_mesh", "duct", "m6_cpacs",
                  "fandisk", "cessna", "D150", "canards", "bwb", "utility", "m6_sharp", "simple_test", "box_wing", "ka6d", "m6_igs", "delta", "coupling", "fighter", "widebody"]
REFINED_FINE_BODIES = ["wing_body", "geom2", "airplane", "caturbs", "lab_plane", "first_mesh", "swept_wing"]  # with y+ 1 at the refined size
FINE_BODIES = ["wing_body", "first_mesh", "m6_cpacs"]  # with y+ 1 at the small size

# A wing with a blunt trailing edge: no gate of its mesh exceeds a hard limit for cell-centred solvers. --short uses the small wing.
WING = """local shape = wing{{ name = "wing", symmetric = true, trailing_edge = {width}, sections = {{ {{ y = 0, chord = 1, airfoil = "{airfoil}" }}, {{ y = {span}, chord = 0.7, sweep = 20*deg }} }} }}
local wall = surface_mesh{{ half(aircraft{{ shape }}), max_edge = {edge}, curvature_angle = 24*deg, min_edge = {least} }}
"""


def wing(width: float = 0.06, airfoil: str = "naca0021", span: float = 1.0, edge: float = 0.2, least: float = 0.037) -> str:
    return WING.format(width=width, airfoil=airfoil, span=span, edge=edge, least=least)


class Mesh:
    """A mesh of the experiment. Either `script` makes the mesh from the data folder, or `of` names the mesh whose nodes `damage` moves."""

    def __init__(self, name: str, script=None, of: str = "", damage: tuple | None = None, file: str = "", what: str = ""):
        self.name, self.script, self.of, self.damage, self.file, self.what = name, script, of, damage, file, what


def sound(body: Body, triangles: int, first: str, suffix: str) -> Mesh:
    def script(data: pathlib.Path) -> str:
        return SIZED + body.make(data, triangles) + VOLUME.format(first=first, more="")
    return Mesh(body.name + suffix, script, file=body.file, what=f"about {triangles} triangles" + (", y+ 1" if first == Y_PLUS else ""))


def made(name: str, wall: str, options: str, what: str, of: str = "wing") -> Mesh:
    """Returns a mesh of the wing with other options of volume_mesh."""
    return Mesh(name, lambda _: wall + VOLUME.format(first="", more=", " + options), of=of, what=what)


def damaged(of: str, kind: str, amount: float, **strength: float) -> Mesh:
    where = f"{amount:.0f}" if amount > 1 else f"{100 * amount:g}pc"
    name = "_".join([of, kind, *(f"{value:g}" for value in strength.values()), where])
    words = ", ".join(f"{key} {value:g}" for key, value in strength.items())
    return Mesh(name, of=of, damage=(kind, amount, strength), what=f"{kind}: {words}; " + (f"{amount:.0f} locations" if amount > 1 else f"{100 * amount:g} %"))


THIN = "first_height = 2e-5, "  # the first cells are so thin that they can be tilted by 89.5 degrees without contact with their neighbours
BASES = [Mesh("thin_wing", lambda _: wing() + VOLUME.format(first=THIN, more=""), what="the same with thinner first cells"),
         Mesh("wing", lambda _: wing() + VOLUME.format(first="first_height = 5e-4, ", more=""), what="the wing that is damaged"),
         sound(BODIES[0], SMALL, LAYERS.format(height=1e-4), "_small")]
DAMAGES = [
    [("lean", 4, {"degrees": 85})],
    [("lean", 0.1, {"degrees": d}) for d in (80, 85)],
    [("flatten", 4, {"share": s}) for s in (0.1, 1e-3, 1e-5)],
    [("flatten", 0.01, {"share": s}) for s in (0.1, 0.01)],
    [("shorten", 0.01, {"share": 0.02})],
    [("layer_jump", 1.0, {"ratio": r}) for r in (2, 5, 20)],
    [("layer_jump", 0.01, {"ratio": r}) for r in (50, 1000)],
    [("layer_jump", 1.0, {"ratio": 3, "at": 0.0})],
    [("compress", 4, {"factor": 0.02})],
    [("compress", 0.1, {"factor": f}) for f in (0.5, 0.1)],
    [("last_layer", 1.0, {"factor": f}) for f in (0.3, 0.1, 0.02)],
    [("last_layer", 0.01, {"factor": 0.1})],
]
MORE_DAMAGES = [  # of a strength between those above
    [("layer_jump", 1.0, {"ratio": r}) for r in (50, 3)],
    [("layer_jump", 1.0, {"ratio": 20, "at": 0.0})],
    [("compress", 0.1, {"factor": 0.02})],
    [("lean", 4, {"degrees": 80})],
    [("flatten", 0.01, {"share": 1e-3})],
    [("flatten", 4, {"share": 0.01})],
    [("shorten", 4, {"share": s}) for s in (0.05, 0.001)],
    [("compress", 4, {"factor": f}) for f in (0.1, 0.5)],
    [("layer_jump", 0.01, {"ratio": 20})],
    [("last_layer", 0.01, {"factor": 0.005})],
]
ON_THIN = [("lean", 4, {"degrees": 89}), ("lean", 0.1, {"degrees": 89}), ("lean", 4, {"degrees": 89.5}), ("lean", 0.1, {"degrees": 85}), ("lean", 0.1, {"degrees": 89.5})]
ON_BODY = [("flatten", 0.01, {"share": 0.01}), ("layer_jump", 1.0, {"ratio": 20}), ("compress", 0.1, {"factor": 0.1}), ("last_layer", 1.0, {"factor": 0.1})]
BY_OPTIONS = [
    made("wing_growth_1.5", wing(), "first_height = 5e-4, max_growth = 1.5", "layers grow by 1.5"),
    made("wing_growth_2", wing(), "first_height = 5e-4, max_growth = 2", "layers grow by 2"),
    made("wing_growth_3", wing(), "first_height = 5e-4, max_growth = 3", "layers grow by 3"),
    made("wing_low_layer", wing(), "first_height = 5e-4, layers = 12", "12 layers: last cells far too low for the tetrahedra"),
    made("wing_lower_layer", wing(), "first_height = 5e-4, layers = 8, max_growth = 1.1", "8 layers that grow by 1.1: last cells lower still"),
    made("wing_high_layer", wing(), "first_height = 5e-4, layers = 12, total_height = 0.35", "12 layers, 0.35 m high: last cells far too high"),
    made("wing_sharp_9pc", wing(0.0, "naca0009", edge=0.2, least=0.037), "first_height = 5e-4", "sharp trailing edge of a section of 9 %", ""),
    made("wing_sharp_6pc", wing(0.0, "naca0006", edge=0.2, least=0.037), "first_height = 5e-4", "sharp trailing edge of a section of 6 %", ""),
    made("wing_sharp_3pc", wing(0.0, "naca0003", edge=0.2, least=0.037), "first_height = 5e-4", "sharp trailing edge of a section of 3 %", ""),
]


def all_meshes() -> list[Mesh]:
    """Returns the meshes in the order of the runs: first the meshes that are damaged later, then sound and damaged meshes in turns, finer and larger meshes last."""
    def on_wing(groups: list) -> list[Mesh]:
        return [damaged("wing", kind, amount, **strength) for group in groups for kind, amount, strength in group]
    bodies = {body.name: body for body in BODIES}
    sound_ones = [sound(body, SMALL, LAYERS.format(height=1e-4), "_small") for body in BODIES[1:]]
    first, turns = [damaged("thin_wing", kind, amount, **strength) for kind, amount, strength in ON_THIN] + on_wing(DAMAGES) + BY_OPTIONS, []
    for i in range(max(len(first), len(sound_ones))):
        turns += first[i:i + 1] + sound_ones[i:i + 1]
    large = [sound(bodies[name], LARGE, LAYERS.format(height=1e-4), "_large") for name in LARGE_BODIES]
    fine = [sound(bodies[name], SMALL, Y_PLUS, "_y1") for name in FINE_BODIES]
    refined = [sound(bodies[name], REFINED, LAYERS.format(height=1e-4), "_refined") for name in REFINED_BODIES]
    refined += [sound(bodies[name], REFINED, Y_PLUS, "_refined_y1") for name in REFINED_FINE_BODIES]
    return BASES + turns + large[:7] + fine + refined + on_wing(MORE_DAMAGES) + [damaged("first_mesh_small", kind, amount, **strength) for kind, amount, strength in ON_BODY] + large[7:]


SHORT_WING = wing(0.05, "naca0021", 0.8, 0.22, 0.04)


def short_meshes() -> list[Mesh]:
    base = Mesh("wing", lambda _: SHORT_WING + VOLUME.format(first=THIN, more=""), what="a small wing")
    return [base, damaged("wing", "lean", 4, degrees=89), damaged("wing", "flatten", 4, share=1e-3)]
