"""Cases of the kind `model`: CAD files (STEP, IGES, BREP) and aircraft files (sumo, CPACS), these with control surfaces turned.

Edges and heights are shares of the model's longest side, because its unit is the file's. "turned" is what the judge measures: by how much the plate of each patch has turned against a mesh
of the same model without deflections, which the script leaves in plain.stl.
"""
import pathlib

TESTS = pathlib.Path(__file__).resolve().parent.parent / "data/cad"

# Of the shared data; without it only those of tests/data/cad.
CAD = ["cad/ansys_bracket.iges", "cad/dealii_cad_wing.iges", "cad/dlr_f6_dlr_f6.brep", "cad/flow360_evtol_evtol.egads.brep", "cad/gmsh_parts_mambo_s34.step", "cad/gmsh_parts_sewfaces.step",
       "cad/gmsh_t106_blade_mesh_T106_V3.step", "cad/gmsh_wing_fuselage_wing_fuselage.step", "cad/gmsh_parts_bad_step_intersects.step.gz", "cad/netgen_parts_screw.step", "cad/netgen_parts_frame.step",
       "cad/onera_m6_su2_geom_oneram6.IGS", "cad/refine_m6_onera-m6-sharp-te.egads.brep", "cad/tigl_d150_D150WithGuides_wing.igs", "cad/tigl_nacelle_nacelle.stp", "cad/tigl_simplewing_simplewing.brep",
       "cad/pythonocc_example_45_faces.iges", "cad/nasty_trimesh_featuretype.STEP", "formats/box.brep", "formats/box.igs", "formats/box.step"]
TESTS_CAD = ["box_doubled_face.brep", "box_gap.brep", "box_inside_out.brep", "box_mm.step", "box_open.iges", "edges_apart.brep", "tail_assembly.step"]

# Aircraft, and of each control the patches that it turns.
AIRCRAFT = {
    "smx/bjet.smx": {"Elevator": ["RightElevator", "LeftElevator"], "Aileron": ["RightAileron", "LeftAileron"], "Rudder": ["Rudder"]},
    "smx/delta.smx": {"Elevator": ["RightElevon", "LeftElevon"], "Rudder": ["Rudder"]},
    "smx/utility.smx": {"Elevator": ["RightElevator", "LeftElevator"], "Rudder": ["Rudder"]},
    "smx/widebody.smx": {"Elevator": ["RightElevator", "LeftElevator"]},
    "smx/torture.smx": {},
    "smx/underwingnacelle.smx": {},
    "cpacs/CPACS_30_D150.xml": {"D150_VAMP_HL1_CompSeg1_elevator": ["D150_VAMP_HL1_CompSeg1_elevator", "D150_VAMP_HL1_CompSeg1_elevatorLeft"],
                                "D150_VAMP_W1_CompSeg1_aileron": ["D150_VAMP_W1_CompSeg1_aileron", "D150_VAMP_W1_CompSeg1_aileronLeft"],
                                "D150_VAMP_SL1_CompSeg1_rudder": ["D150_VAMP_SL1_CompSeg1_rudder"]},
    "cpacs/boxWing.xml": {"D150_VAMP_SL1_CompSeg1_rudder": ["D150_VAMP_SL1_CompSeg1_rudder"]},
    "cpacs/canards.xml": {"Canard": ["Canard", "CanardLeft"]},
    "cpacs/d150.xml": {"InnerFlap": ["InnerFlap", "InnerFlapLeft"], "OuterFlap": ["OuterFlap", "OuterFlapLeft"], "Aileron": ["Aileron", "AileronLeft"], "Elevator": ["Elevator", "ElevatorLeft"],
                       "Rudder": ["Rudder"]},
    "cpacs/simpletest-flaps.cpacs.xml": {"FlapInner": ["FlapInner", "FlapInnerLeft"], "FlapOuter": ["FlapOuter", "FlapOuterLeft"]},
    "cpacs/simpletest.cpacs.xml": {},
    "cpacs/simpletest-halfmodel.cpacs.xml": {},
    "cpacs/simpletest-pylon-nacelle.cpacs.xml": {},
    "cpacs/onera_m6.xml": {},
}


def draw(rng, data, num):
    """What is read, and how: {"file", "of", "deflections", "turned", "half", "surface", "relative"}."""
    case = {"kind": "model", "of": "shared" if data else "tests", "deflections": {}, "turned": []}
    if data and rng.random() < 0.55:
        case["file"] = rng.choice(sorted(AIRCRAFT))
        controls = AIRCRAFT[case["file"]]
        for name in rng.sample(sorted(controls), min(len(controls), rng.choice([0, 1, 1, 2]))):
            angle = rng.choice([-1, 1]) * rng.uniform(3, 18)
            case["deflections"][name] = num(angle)
            case["turned"] += [{"patch": patch, "angle": num(angle)} for patch in controls[name]]
        if rng.random() < 0.25 and "nacelle" not in case["file"]:
            case["half"] = True
        if case.get("half"):  # half of a turned rudder is half of no aircraft
            for name in [name for name in case["deflections"] if "udder" in name]:
                del case["deflections"][name]
                case["turned"] = [entry for entry in case["turned"] if entry["patch"] not in controls[name]]
        if not case.get("half") and rng.random() < 0.3:
            case["attitude"] = {"about": ["0", "0", "0"], "pitch": num(rng.uniform(-5, 14)), "yaw": num(rng.uniform(-6, 6))}
    else:
        case["file"] = rng.choice(CAD) if data else rng.choice(TESTS_CAD)
    long = rng.uniform(0.05, 0.09)
    case["surface"] = {"max_edge": num(long) + " * span", "min_edge": num(long * rng.uniform(0.06, 0.15)) + " * span", "curvature_angle": f"{num(rng.uniform(25, 40))}*deg",
                       "growth": num(rng.uniform(1.4, 1.8)), "narrow": num(rng.uniform(4, 20))}
    case["relative"] = {"layers": str(rng.randint(2, 8)), "first_height": num(10 ** rng.uniform(-6, -3.7))}
    return case


def path_of(case, data):
    return (data / case["file"]) if case["of"] == "shared" else TESTS / case["file"]


def reader(case, data, deflections):
    path = path_of(case, data)
    verb = {".smx": "read_smx", ".xml": "read_cpacs"}.get(path.suffix, "read_cad")
    turns = ", ".join(f'["{name}"] = {angle}*deg' for name, angle in deflections.items())
    return f'{verb}{{ "{path}"' + (f", deflections = {{ {turns} }}" if turns else "") + " }"


def script(case, data, table_of, turn):
    """Lua up to `wall`; `turn`: the attitude, ":rotate{...}" or nothing."""
    read = reader(case, data, case["deflections"])
    lines = [f"local model = {read if read.startswith('read_cad') else f'aircraft{{ {read} }}'}{turn}",
             "local span = math.max(model.max[1] - model.min[1], model.max[2] - model.min[2], model.max[3] - model.min[3])"]
    if case["turned"]:
        plain = table_of(reader(case, data, {}), case["surface"] | {"crossings": '"ignore"'})
        lines.append(f'surface_mesh{plain}:write "plain.stl"')
    lines.append('if model.is_closed then print("SOAK volume " .. string.format("%.17g", model:measures().volume)) end')
    if case.get("half"):
        lines.append("model = half(model)")
    return lines + [f"local wall = surface_mesh{table_of('model', case['surface'])}"]
