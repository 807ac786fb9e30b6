"""Random cases for the soak: what is asked, as a dictionary that JSON holds, and the Lua script that asks it.

A case has "kind" (aircraft, parts, surface; model is in described.py), what its kind is made of (below), and what all have:
  surface   options of surface_mesh or read_surface, Lua text by name
  volume    options of volume_mesh, Lua text by name
  farfield  {"shape": "sphere", "radius": r} and so on, or nothing
  output    a second format beside SU2
and what some have: "wakes" (Lua text), "through" (a CAD format that the model is written to and read from again), "periodic" (pairs of sides and the way between them), "turned" (patches that a
deflection turns), "continued" (the step behind which the mesh is made again from its .sterna file).
Everything in a list or a table can be left out on its own: that is how a failure is reduced (reduce.py). Figures are drawn from seed and index alone.
"""
import math
import pathlib
import re
import subprocess

import described
import surfaces

OUTPUTS = [".vtu", ".cgns", ".b8.ugrid", ".lb8.ugrid", ".msh", ".fluent.msh", ".meshb", ".mesh", ".vtkhdf", ".taumesh", ".sterna", ".bmsh", "polymesh", ".adf.cgns", ".lb8l.ugrid", ".ugrid",
           ".v2.bmsh", ".bin.msh"]
INPUTS = ["stl text", "stl binary", "obj", "off"]
CONVERTED_INPUTS = [".ply", ".msh", ".su2", ".vtu", ".vtp", ".smesh", ".tri", ".nas", ".meshb", ".cgns", ".vtk", ".poly", ".bdf", ".vtkhdf", ".bin.tri", ".sterna"]
THROUGH = [".step", ".igs", ".brep"]


def num(value):
    return f"{value:.6g}"


# ---- Options from the manual's tables ---------------------------------------------------------------------------------------------------------

# What is not drawn: what cases ask for on their own, limits of the machine, folders, and what only makes a case long.
NOT_DRAWN = {"layers", "first_height", "memory_limit", "time_limit", "helper_folder", "max_new_points", "refinement", "family_wake", "solve_for", "total_height", "ends_max_triangles",
             "fall_back_on_limits", "optimiser_evaluations", "max_thickness", "size_max", "max_triangles", "max_edge", "min_edge", "chord_error", "curvature_angle", "gap_cells",
             "feature_angle", "crossings", "truncate", "ends_growth", "farfield_surface", "max_growth", "open_ridges", "thickness_factor", "narrow", "max_relative_height", "engine", "size_growth", "improve_rounds"}


def options_of(sterna, verb):
    """(name, default, range) of each option of a verb that can be drawn from its range, out of `sterna manual`."""
    manual = subprocess.run([sterna, "manual"], capture_output=True, text=True, check=True).stdout
    section = manual.partition(f"\n### {verb}\n")[2].partition("\n### ")[0].partition("\npatches = ")[0]
    rows = re.findall(r"^\| `(\w+)` \| (.*?) \| (.*?) \| ", section, re.MULTILINE)
    return [row for row in rows if row[0] not in NOT_DRAWN and not row[0].startswith("farfield_")]


def names_of(sterna, verb):
    """The names of all options of a verb."""
    manual = subprocess.run([sterna, "manual"], capture_output=True, text=True, check=True).stdout
    section = manual.partition(f"\n### {verb}\n")[2].partition("\n### ")[0].partition("\n## ")[0].partition("\npatches = ")[0]
    return set(re.findall(r"^\| `(\w+)` \|", section, re.MULTILINE))


def in_range(rng, default, limits):
    """A value within the limits, in Lua, mostly near the default; nothing where there is no knowing what is sensible."""
    if default in ("true", "false"):
        return rng.choice(["true", "false"])
    if limits.startswith("one of "):
        return '"' + rng.choice(limits.removeprefix("one of ").split(", ")) + '"'
    found = re.fullmatch(r"(\S+?)( deg)? \.\. (\S+?)( deg)?", limits)
    if not found or not re.match(r"[-+\d]", default):
        return None
    low, high, middle = float(found[1]), float(found[3]), float(default.split()[0].strip('"'))
    reach = 3.0 if rng.random() < 0.8 else 10.0
    value = middle * math.exp(rng.uniform(-1, 1) * math.log(reach)) if middle > 0 else rng.uniform(low, low + 0.2 * (high - low))
    inset = 1e-3 * (high - low) if found[2] else 0  # limits in degrees are rounded in the manual
    value = min(max(value, low + inset), high - inset)
    if "." not in default and "e" not in default and not found[2] and high >= 10:
        value = round(value)
    return num(value) + ("*deg" if found[2] else "")


def draw_options(rng, table, n):
    drawn = {}
    for name, default, limits in rng.sample(table, min(n, len(table))):
        value = in_range(rng, default, limits)
        if value is not None:
            drawn[name] = value
    return drawn


# ---- Aircraft -----------------------------------------------------------------------------------------------------------------------------------

def airfoil(rng, thin=False):
    thick = rng.randint(8, 12) if thin else rng.randint(10, 18)
    form = rng.random()
    if thin or form < 0.3:
        return f"naca00{thick:02d}"
    return f"naca{rng.choice(['24', '14', '44', '22', '34'])}{thick}" if form < 0.8 else f"naca230{thick}"


def fuselage(rng, size):
    d, n = size * rng.uniform(0.08, 0.14), rng.randint(2, 4)
    rise = rng.uniform(-0.1, 0.3) * d
    frames = [(0.04, rng.uniform(0.35, 0.55), -0.1 * d), (0.14, rng.uniform(0.75, 0.95), -0.03 * d)]
    frames += [(0.25 + 0.4 * i / n, 1.0, 0.0) for i in range(n + 1)]
    frames += [(0.82, rng.uniform(0.55, 0.8), 0.5 * rise), (0.97, rng.uniform(0.2, 0.35), rise)]
    shape = rng.choice(["", "", ', shape = "superellipse", exponent = ' + num(rng.uniform(2.0, 3.2)), ', shape = "double_ellipse", offset = ' + num(rng.uniform(-0.2, 0.2))])
    wide = rng.choice([1.0, 1.0, rng.uniform(0.8, 1.3)])
    lines = [f"{{ x = {num(x * size)}, width = {num(r * d * wide)}, height = {num(r * d)}, z = {num(z)}{shape} }}" for x, r, z in frames]
    tail = rng.choice(["", "", ', tail = "flat"'])
    along = rng.choice(["monotone", "akima"])
    return d, f'fuselage{{ along = "{along}"{tail}, name = "body", frames = {{ {", ".join(lines)} }} }}'


def wing_text(rng, name, position, chord, half_span, symmetric, edge, upright=False, winglet=False, thin=False):
    """A wing of two to four sections; `edge`: thickness of its trailing edge over the root's chord."""
    n = rng.choice([2, 2, 3, 3, 4])
    sweep, dihedral, taper = rng.uniform(-5, 35), rng.uniform(-3, 8), rng.uniform(0.35, 0.9)
    sections = [f'{{ {"" if upright else "y = 0, "}chord = {num(chord)}, airfoil = "{airfoil(rng, thin)}", twist = {num(rng.uniform(-1, 4))}*deg }}']
    for i in range(1, n):
        share = i / (n - 1)
        own = chord * (1 + (taper - 1) * share) * rng.uniform(0.92, 1.08)
        where = f"z = {num(half_span * share)}" if upright else f"y = {num(half_span * share)}, dihedral = {num(dihedral + rng.uniform(-2, 2))}*deg"
        other = f', airfoil = "{airfoil(rng, thin)}"' if rng.random() < 0.3 else ""
        sections.append(f"{{ {where}, chord = {num(own)}, sweep = {num(sweep + rng.uniform(-4, 4))}*deg, twist = {num(rng.uniform(-3, 2))}*deg{other} }}")
    tip = rng.choice(['tip = "round"', 'tip = "round"', 'tip = "flat"'])
    more = f", winglet = {{ height = {num(0.12 * half_span)}, cant = {num(rng.uniform(45, 85))}*deg, taper = {num(rng.uniform(0.4, 0.8))} }}" if winglet else ""
    cubic = ', spanwise = "cubic"' if n > 2 and rng.random() < 0.2 else ""
    return (f'wing{{ name = "{name}", {"symmetric = true, " if symmetric else ""}position = {{ {", ".join(num(x) for x in position)} }}, trailing_edge = {num(edge * chord)}, {tip}{cubic}, '
            f'sections = {{ {", ".join(sections)} }}{more} }}')


def aircraft(rng, table):
    size = 10 ** rng.uniform(-0.3, 1.7)
    d, body = fuselage(rng, size)
    parts = [{"name": "body", "lua": body, "needs": []}]
    case = {"kind": "aircraft", "size": size, "components": parts}
    chord, half_span = size * rng.uniform(0.14, 0.24), size * rng.uniform(0.3, 0.6)
    root = (size * rng.uniform(0.28, 0.42), 0, d * rng.uniform(-0.35, 0.3))
    edge = rng.choice([rng.uniform(0.008, 0.02), rng.uniform(0.008, 0.02), rng.uniform(0.004, 0.008), 0])
    main = {"name": "main_wing", "lua": wing_text(rng, "wing", root, chord, half_span, True, edge, winglet=rng.random() < 0.25), "needs": [], "after": []}
    if rng.random() < 0.35:
        other = rng.choice(["same", "opposite"])
        place = f'"flap", from = {{ {num(rng.uniform(0.4, 0.55))}, {num(rng.uniform(0.68, 0.78))} }}, to = {{ {num(rng.uniform(0.7, 0.85))}, {num(rng.uniform(0.68, 0.78))} }}'
        angle = num(rng.uniform(-20, 20))
        main["after"].append(f'main_wing:deflect{{ {place}, angle = {angle}*deg, other_side = "{other}" }}')
        main["plain"] = f"main_wing:control{{ {place} }}"
        case["turned"] = [{"patch": patch, "angle": angle} for patch in ("flap", "flapLeft")]
    parts.append(main)
    tail = rng.choice(["low", "low", "high", "none", "vee"])
    if tail in ("low", "high"):
        tail_x, fin_chord, fin_height = size * rng.uniform(0.78, 0.84), size * rng.uniform(0.11, 0.15), size * rng.uniform(0.12, 0.18)
        parts.append({"name": "fin", "lua": wing_text(rng, "fin", (tail_x, 0, 0.1 * d), fin_chord, fin_height, False, max(edge, 0.008), upright=True, thin=True), "needs": []})
        z = 0.15 * d if tail == "low" else 0.1 * d + 0.75 * fin_height
        parts.append({"name": "tailplane", "lua": wing_text(rng, "tailplane", (tail_x + 0.02 * size, 0, z), size * rng.uniform(0.08, 0.11), size * rng.uniform(0.12, 0.2), True, max(edge, 0.008),
                                                            thin=True), "needs": ["fin"] if tail == "high" else []})
    elif tail == "vee":
        parts.append({"name": "vee", "lua": f'wing{{ name = "vee", symmetric = true, position = {{ {num(size * 0.8)}, {num(0.1 * d)}, {num(0.1 * d)} }}, trailing_edge = {num(0.01 * size * 0.12)}, sections = {{ '
                      f'{{ y = 0, chord = {num(size * 0.12)}, airfoil = "{airfoil(rng, True)}" }}, {{ span = {num(size * 0.17)}, chord = {num(size * 0.07)}, sweep = 25*deg, '
                      f'dihedral = {num(rng.uniform(30, 50))}*deg }} }} }}', "needs": []})
    extra = rng.random()
    if extra < 0.22:
        length, y = chord * rng.uniform(0.8, 1.1), half_span * rng.uniform(0.3, 0.5)
        diameter = length * rng.uniform(0.4, 0.55)
        case["engine"] = diameter
        x, z = root[0] - rng.uniform(0.2, 0.5) * length + 0.3 * y * rng.uniform(0.5, 1), root[2] - diameter * rng.uniform(0.75, 0.95)
        parts.append({"name": "engine", "lua": f'nacelle{{ name = "engine", symmetric = true, position = {{ {num(x)}, {num(y)}, {num(z)} }}, length = {num(length)}, diameter = {num(diameter)}, '
                      f'intake = "fan_face", exhaust = "nozzle" }}', "needs": []})
        parts.append({"name": "strut", "lua": f'pylon{{ main_wing, engine, name = "pylon", thickness = {num(rng.uniform(0.08, 0.14))} }}', "needs": ["main_wing", "engine"]})
    elif extra < 0.32:
        parts.append({"name": "belly", "lua": f'fairing{{ name = "belly", position = {{ {num(root[0] - 0.1 * chord)}, 0, {num(-0.35 * d)} }}, length = {num(1.3 * chord)}, width = {num(0.8 * d)}, '
                      f'height = {num(0.5 * d)} }}', "needs": []})
    elif extra < 0.42:
        y = half_span * rng.uniform(0.5, 0.8)
        parts.append({"name": "tank", "lua": f'body_of_revolution{{ name = "tank", symmetric = true, position = {{ {num(root[0])}, {num(y)}, {num(root[2] - 0.35 * d)} }}, '
                      f'profile = {{ {{0, 0}}, {{{num(0.1 * chord)}, {num(0.08 * d)}}}, {{{num(0.5 * chord)}, {num(0.14 * d)}}}, {{{num(1.1 * chord)}, {num(0.12 * d)}}}, {{{num(1.5 * chord)}, 0}} }} }}', "needs": []})
    surroundings(rng, case, d)
    max_edge = size * rng.uniform(0.08, 0.14)  # coarse on purpose: a case takes seconds
    case["surface"] = {"max_edge": num(max_edge), "min_edge": num(max_edge * rng.uniform(0.1, 0.25)), "curvature_angle": f"{num(rng.uniform(30, 48))}*deg", "growth": num(rng.uniform(1.4, 1.9)),
                       "narrow": num(rng.uniform(8, 40)), "trailing_edge_factor": "1", "intersection_factor": num(rng.uniform(0.6, 1)), "tip_strips": rng.choice(["true", "false"])}
    if "engine" in case:  # edges longer than a cowl is thick cross each other, which is refused
        case["surface"]["patches"] = f'{{ ["engine*"] = {{ max_edge = {num(0.5 * case["engine"])}, min_edge = {num(0.05 * case["engine"])} }} }}'
    case["volume"] = layers(rng, size) | draw_options(rng, table, rng.choice([0, 0, 1, 2, 4]))
    if not case.get("tunnel") and rng.random() < 0.12:
        case["through"] = ".step" if "engine" in case else rng.choice(THROUGH)  # the others lose names
        if case["through"] != ".step":
            case.pop("turned", None)
    if rng.random() < 0.2:
        wakes(rng, case, chord)
    case["output"] = rng.choice(OUTPUTS)
    return case


def wakes(rng, case, chord, wing="wing*"):
    """Layers go on behind the wing. Not together with discs and opened ridges, which sheets refuse."""
    if case.get("disc") or "open_ridges" in case["volume"]:
        return
    length = 2.0
    case["wakes"] = '"auto"'
    if case.get("through", ".step") == ".step" and rng.random() < 0.7:
        length = rng.uniform(1, 3)
        case["wakes"] = f'{{ wake_sheet{{ wing = "{wing}", length = {num(length)}, growth = {num(rng.uniform(1.15, 1.5))}, height_growth = {num(rng.uniform(1, 1.4))} }} }}'
    case["wake_reach"] = num(0.3 * length * chord * 0.3)  # the wing tapers to 0.3 of its chord at the least


def surroundings(rng, case, d):
    """Attitude, half, farfield, tunnel and sting, disc."""
    size = case["size"]
    where = rng.choice(["free", "free", "free", "half", "half", "tunnel", "disc"])
    if where == "half":
        case["half"] = True
        for part in case["components"]:
            if part["name"] == "fin":  # half of a twisted fin is half of no aircraft
                part["lua"] = re.sub(r"twist = [^,} ]+", "twist = 0", part["lua"])
    elif rng.random() < 0.4:
        case["attitude"] = {"about": [num(rng.choice([0, 1]) * size), "0", "0"], "pitch": num(rng.uniform(-5, 14)), "yaw": num(rng.choice([0, rng.uniform(-6, 6)]))}
    if where == "tunnel":
        case["components"].append({"name": "support", "lua": f'sting{{ name = "sting", from = {{ {num(0.8 * size)}, 0, 0 }}, to = {{ {num(2.2 * size)}, 0, 0 }}, diameter = {num(0.35 * d)} }}', "needs": []})
        walls = rng.choice(['"slip"', '"slip"', f"{{ layers = {rng.randint(3, 8)}, first_height = {num(size * 1e-3)} }}"])
        width, height = rng.uniform(2.2, 3) * size, rng.uniform(1.6, 2.4) * size
        if rng.random() < 0.25:
            height = width
            section = f"diameter = {num(width)}"
        else:
            section = f"width = {num(width)}, height = {num(height)}"
        case["tunnel"] = (f"test_section{{ length = {num(4 * size)}, {section}, upstream = {num(1.5 * size)}, "
                          f"max_edge = {num(0.35 * size)}, walls = {walls}" + (', through = "sting"' if rng.random() < 0.5 else "") + " }")
        case["tunnel_box"] = [[num(-1.5 * size), num(-0.5 * width), num(-0.5 * height)], [num(2.5 * size), num(0.5 * width), num(0.5 * height)]]
        case["farfield"] = {}
    else:
        case["farfield"] = farfield(rng, size, where == "half", case.get("attitude"))
    if where == "disc" or (where == "tunnel" and rng.random() < 0.3):
        case["disc"] = {"name": "prop", "center": [num(-0.12 * size), "0", "0"], "radius": num(size * rng.uniform(0.08, 0.2)), "inner": rng.choice(["0", num(0.03 * size)]), "edge": num(0.03 * size)}


def farfield(rng, size, is_half, attitude=None):
    shape = rng.choice(["sphere", "sphere", "sphere", "box", "none given", "cylinder", "surface"])
    if shape == "sphere":
        return {"shape": "sphere", "radius": num(size * 10 ** rng.uniform(0.7, 2))}
    if shape == "box":
        r = size * 10 ** rng.uniform(0.5, 1.3)
        low = [-r, 0.0 if is_half else -r, -r]
        made = {"shape": "box", "low": [num(x) for x in low], "high": [num(2 * r), num(r), num(r)]}
        return made | ({"sides": True} if rng.random() < 0.5 else {})
    if shape == "cylinder":
        r = size * 10 ** rng.uniform(0.6, 1.3)
        return {"shape": "cylinder", "from": num(-r), "to": num(rng.uniform(1.5, 3) * r), "radius": num(r)} | ({"sides": True} if rng.random() < 0.5 else {})
    if shape == "surface":
        r = size * 10 ** rng.uniform(0.6, 1.3)
        return {"shape": "surface", "radii": [num(r * rng.uniform(1, 2)), num(r), num(r * rng.uniform(0.8, 1))], "center": [num(0.5 * size), "0", "0"], "n": rng.randint(12, 20)}
    return {}


def quick(rng):
    """Few tetrahedra and little time for their improvement."""
    return {"size_growth": num(rng.uniform(1.5, 2)), "improve_rounds": str(rng.randint(2, 8))}


def layers(rng, size):
    made = quick(rng) | {"layers": str(rng.randint(2, 8)), "first_height": num(size * 10 ** rng.uniform(-6, -3.3))}
    if rng.random() < 0.5:
        made["max_growth"] = num(rng.uniform(1.15, 1.6))
    if rng.random() < 0.1:
        made["open_ridges"] = '"always"'
    if rng.random() < 0.15:
        made["truncate"] = rng.choice(['"auto"', '"always"'])
        if made["truncate"] == '"always"':
            made["growth"] = '"local"'  # with uniform growth lines are told as compressed that keep all layers, with lower first cells
    return made


# ---- Mechanical parts -----------------------------------------------------------------------------------------------------------------------------

def parts(rng, table):
    """Boxes, cylinders and turned parts that stick in each other; half of the cases on a grid, where faces come to lie in one plane."""
    size, n, grid = 10 ** rng.uniform(-2, 2), rng.randint(2, 5), rng.random() < 0.4
    step = (lambda x: round(x * 4) / 4) if grid else (lambda x: x)
    made, last = [], (0.0, 0.0, 0.0)
    for i in range(n):
        at = tuple(step(last[k] + rng.uniform(-0.5, 0.5)) for k in range(3)) if i else last
        half = [max(0.25, step(rng.uniform(0.2, 0.7))) for _ in range(3)]
        form = rng.choice(["box", "box", "cylinder", "cylinder", "turned"])
        low, high = [size * (at[k] - half[k]) for k in range(3)], [size * (at[k] + half[k]) for k in range(3)]
        name = f"part{i}"
        if form == "box":
            lua = f'box{{ {{ {", ".join(map(num, low))} }}, {{ {", ".join(map(num, high))} }}, name = "{name}" }}'
        elif form == "cylinder":
            axis = rng.randrange(3)
            ends = [[size * at[k] if k != axis else end[k] for k in range(3)] for end in (low, high)]
            lua = f'cylinder{{ {{ {", ".join(map(num, ends[0]))} }}, {{ {", ".join(map(num, ends[1]))} }}, radius = {num(size * min(half))}, name = "{name}" }}'
        else:
            x, r = 2 * half[0] * size, 0.6 * half[1] * size
            lua = (f'body_of_revolution{{ name = "{name}", position = {{ {num(low[0])}, {num(size * at[1])}, {num(size * at[2])} }}, straight = {rng.choice(["true", "false"])}, '
                   f"profile = {{ {{0, 0}}, {{{num(0.2 * x)}, {num(0.7 * r)}}}, {{{num(0.6 * x)}, {num(r)}}}, {{{num(x)}, {num(0.5 * r)}}} }} }}")
        made.append({"name": name, "lua": lua, "needs": []})
        last = at
    case = {"kind": "parts", "size": 2 * size, "components": made, "triangulated": rng.random() < 0.3, "farfield": farfield(rng, 2 * size, False)}
    case["surface"] = {"max_edge": num(size * rng.uniform(0.18, 0.4)), "min_edge": num(size * 0.02), "curvature_angle": f"{num(rng.uniform(20, 40))}*deg", "growth": num(rng.uniform(1.3, 1.7))}
    if rng.random() < 0.3:
        case["attitude"] = {"about": ["0", "0", "0"], "pitch": num(rng.uniform(-30, 30)), "yaw": num(rng.uniform(-30, 30))}
    if not case["triangulated"] and rng.random() < 0.25:
        case["through"] = rng.choice(THROUGH)
    case["volume"] = layers(rng, 2 * size) | draw_options(rng, table, rng.choice([0, 0, 1, 2, 4]))
    case["output"] = rng.choice(OUTPUTS)
    return case


# ---- Rows: two sides of a tunnel are each other's image ------------------------------------------------------------------------------------------------

def row(rng, table):
    """A wing or a bar from side to side, or a body between them, in a tunnel whose sides match; sometimes floor and ceiling, too."""
    size = 10 ** rng.uniform(-1, 1)
    width, height = size * rng.uniform(1.2, 3), size * rng.uniform(2, 4)
    form = rng.choice(["wing", "bar", "body", "bar and body"])
    made, through = [], ""
    if form == "wing":
        made.append({"name": "blade", "lua": f'wing{{ name = "blade", symmetric = true, position = {{ {num(-0.3 * size)}, 0, {num(rng.uniform(-0.2, 0.2) * size)} }}, trailing_edge = {num(0.012 * size)}, '
                     f'sections = {{ {{ y = 0, chord = {num(0.8 * size)}, airfoil = "{airfoil(rng)}", twist = {num(rng.uniform(-3, 6))}*deg }}, {{ y = {num(width)} }} }} }}', "needs": []})
        through = ', through = "blade"'
    if "bar" in form:
        r = rng.uniform(0.15, 0.35) * size
        made.append({"name": "bar", "lua": f'cylinder{{ {{ 0, {num(-width)}, 0 }}, {{ 0, {num(width)}, 0 }}, radius = {num(r)}, name = "bar" }}', "needs": []})
        through = ', through = "bar"'
    if "body" in form:
        x, r = 1.2 * size if made else 0, rng.uniform(0.15, 0.3) * size
        made.append({"name": "pod", "lua": f'body_of_revolution{{ name = "pod", position = {{ {num(x)}, {num(rng.uniform(-0.1, 0.1) * width)}, 0 }}, profile = {{ {{0, 0}}, {{{num(0.1 * size)}, {num(0.6 * r)}}}, '
                     f"{{{num(0.4 * size)}, {num(r)}}}, {{{num(size)}, 0}} }} }}", "needs": []})
    case = {"kind": "parts", "size": size, "components": made, "triangulated": False, "farfield": {}}
    case["tunnel"] = f'test_section{{ length = {num(5 * size)}, width = {num(width)}, height = {num(height)}, upstream = {num(1.5 * size)}, max_edge = {num(0.4 * size)}, walls = "slip"{through} }}'
    case["tunnel_box"] = [[num(-1.5 * size), num(-0.5 * width), num(-0.5 * height)], [num(3.5 * size), num(0.5 * width), num(0.5 * height)]]
    case["periodic"] = [["tunnel_left", "tunnel_right", ["0", num(width), "0"]]]
    if rng.random() < 0.3:
        case["periodic"].append(["tunnel_floor", "tunnel_ceiling", ["0", "0", num(height)]])
    case["surface"] = {"max_edge": num(size * rng.uniform(0.1, 0.25)), "min_edge": num(size * 0.02), "curvature_angle": f"{num(rng.uniform(20, 40))}*deg", "growth": num(rng.uniform(1.3, 1.7))}
    case["volume"] = layers(rng, size) | draw_options(rng, table, rng.choice([0, 0, 1, 2]))
    if form == "wing" and rng.random() < 0.4:
        wakes(rng, case, 0.8 * size, "blade")
    case["output"] = rng.choice(OUTPUTS)
    return case


# ---- Models in files -------------------------------------------------------------------------------------------------------------------------------

def model(rng, table, data):
    case = described.draw(rng, data, num)
    case["farfield"] = {}
    if rng.random() < 0.5:
        case["relative_farfield"] = num(10 ** rng.uniform(0.5, 2))
    case["volume"] = quick(rng) | draw_options(rng, table, rng.choice([0, 0, 1, 2]))
    case["output"] = rng.choice(OUTPUTS)
    return case


# ---- Given surfaces, damaged ----------------------------------------------------------------------------------------------------------------------

REAL = ["surfaces/clean/caturbs_wing_wing.stl", "surfaces/clean/cgal_data_couplingdown.off", "surfaces/clean/gmsh_stl_TwoObjects.stl.gz", "surfaces/clean/meshpy_ka6d_ka-6d.ply",
        "surfaces/nasty/nasty_arrangements_two_spheres.stl", "surfaces/nasty/derived_f16xl_wgs_full.off", "surfaces/nasty/netgen_parts_part1.stl", "surfaces/nasty/hd_airframe_HD-airframe-aileron-gap.stl",
        "surfaces/nasty/axom_surf_naca0012.stl", "surfaces/nasty/nasty_openscad_nonmanifold.stl"]


def surface(rng, table, data):
    made = rng.choice(["ellipsoid", "wing", "box", "two", "real", "real"])
    if made == "real" and data is None:
        made = "wing"
    case = {"kind": "surface", "form": made, "form_seed": rng.randrange(10 ** 9), "damage": []}
    if made == "real":
        case["file"] = rng.choice(REAL)
    for name in rng.sample(sorted(surfaces.DAMAGE), rng.choice([0, 0, 1, 1, 2, 3])):
        case["damage"].append([name, round(rng.random(), 3), rng.randrange(10 ** 9)])
    case["scale"] = rng.choice(["1", "1", "1", "0.001", "1e-06", "1e+06", "1000"])
    case["offset"] = rng.choice([None, None, None, [num(rng.choice([1e3, 1e6])), "0", num(-1e3)]])
    case["input"] = rng.choice(INPUTS)
    if rng.random() < 0.3:
        case["converted"] = rng.choice(CONVERTED_INPUTS)
    # auto wraps where nothing else helps, with 60 000 triangles: that takes a minute, so it is rare.
    case["remedy"] = rng.choice(["none", "repair", "repair", "repair", "wrap"] * 2 + ["auto"]) if case["damage"] or made in ("real", "two") else rng.choice(["none", "none", "none", "auto"])
    case["relative"] = {"layers": str(rng.randint(3, 12)), "first_height": num(10 ** rng.uniform(-5.5, -3.3))}
    case["surface"] = {"split_angle": f"{num(rng.uniform(30, 60))}*deg"} if rng.random() < 0.3 else {}
    case["volume"] = quick(rng) | draw_options(rng, table, rng.choice([0, 0, 1, 2]))
    if rng.random() < 0.5:
        case["relative_farfield"] = num(10 ** rng.uniform(0.5, 2))
    case["farfield"] = {}
    case["output"] = rng.choice(OUTPUTS)
    return case


def soup_of(case, data):
    """The triangles of a surface case in its own unit: patches of (name, soup); nothing for a real file that stays as it is."""
    rng = surfaces.generator(case["form_seed"])
    form = case["form"]
    if form == "real":
        path = data / case["file"]
        if path.suffix not in (".stl", ".off"):
            return None
        patches = [("wall", surfaces.read_stl(path) if path.suffix == ".stl" else surfaces.read_off(path))]
    elif form == "ellipsoid":
        patches = [("wall", surfaces.ellipsoid(1, rng.uniform(0.2, 1), rng.uniform(0.2, 1), rng.randint(10, 22)))]
    elif form == "wing":
        patches = [("wall", surfaces.thick_wing(rng, rng.randint(8, 16)))]
    elif form == "box":
        patches = [("wall", surfaces.refined(surfaces.box((0, 0, 0), (1, rng.uniform(0.3, 1), rng.uniform(0.2, 1))), rng.randint(2, 3)))]
    else:
        one = surfaces.ellipsoid(1, 0.4, 0.4, rng.randint(10, 16))
        two = surfaces.moved(surfaces.refined(surfaces.box((-0.3, -0.3, -0.3), (0.3, 0.3, 0.3)), 2), (rng.uniform(-0.5, 1.5), rng.uniform(-0.3, 0.3), rng.uniform(-0.2, 0.2)))
        patches = [("body", one), ("block", two)]
    for name, strength, seed in case["damage"]:
        own = surfaces.generator(seed)
        patches = [(patch, surfaces.DAMAGE[name](own, soup, strength)) for patch, soup in patches]
    for chunk in case.get("removed", []):  # the reducer's
        patches = [(patch, [t for i, t in enumerate(soup) if not chunk[0] <= i < chunk[1]]) for patch, soup in patches]
    if case["offset"]:
        length = max(surfaces.size_of(soup) for _, soup in patches)
        patches = [(patch, surfaces.moved(soup, [float(x) * length for x in case["offset"]])) for patch, soup in patches]
    return [(patch, surfaces.scaled(soup, float(case["scale"]))) for patch, soup in patches]


# ---- The script -----------------------------------------------------------------------------------------------------------------------------------

def table_of(first, entries):
    return "{ " + ", ".join([first] + [f"{name} = {value}" for name, value in entries.items()]) + " }"


def pairs_of(case):
    return "{ " + ", ".join(f'{{ "{first}", "{second}" }}' for first, second, _ in case["periodic"]) + " }"


def volume_table(case, entries):
    entries = dict(entries)
    field = case["farfield"]
    if field.get("shape") == "sphere":
        entries["farfield"] = f"sphere{{ radius = {field['radius']} }}"
    elif field.get("shape") == "box":
        sides = ', sides = { x_min = "inflow", x_max = "outflow" }' if field.get("sides") else ""
        entries["farfield"] = f"box{{ {{ {', '.join(field['low'])} }}, {{ {', '.join(field['high'])} }}, edge = {num(float(field['high'][0]) / 4)}{sides} }}"
    elif field.get("shape") == "cylinder":
        sides = ', sides = { start = "inflow", ["end"] = "outflow" }' if field.get("sides") else ""
        entries["farfield"] = f"cylinder{{ {{ {field['from']}, 0, 0 }}, {{ {field['to']}, 0, 0 }}, radius = {field['radius']}, edge = {num(float(field['radius']) / 3)}{sides} }}"
    elif field.get("shape") == "surface":
        entries["farfield"] = '"far.stl"'
    if case.get("wakes"):
        entries["wakes"] = case["wakes"]
    if case.get("periodic"):
        entries["periodic"] = pairs_of(case)
    if case.get("continued"):
        entries["stages"] = '"stopped.sterna"'
    if disc := case.get("disc"):
        inner = f", inner_radius = {disc['inner']}" if disc["inner"] != "0" else ""
        entries["interfaces"] = f'{{ actuator_disc{{ name = "{disc["name"]}", center = {{ {", ".join(disc["center"])} }}, radius = {disc["radius"]}{inner}, edge = {disc["edge"]} }} }}'
    return table_of("wall", entries)


def output_name(case):
    output = case["output"]
    return output if not output or output.startswith(".") is False else "other" + output


def script_of(case, folder, data):
    """The Lua text; writes input files into the folder."""
    if case["kind"] == "model":
        lines = described.script(case, data, table_of, attitude_of(case))
    else:
        lines = surface_script(case, folder, data) if case["kind"] == "surface" else model_script(case)
    if case["farfield"].get("shape") == "surface":
        surfaces.write(pathlib.Path(folder) / "far.stl", [("outer", far_surface(case["farfield"]))], "stl binary")
    lines += ['print("SOAK patches " .. table.concat(wall.patches, "|"))', 'print("SOAK length " .. string.format("%.17g", wall.length))']
    volume = dict(case["volume"])
    if "relative" in case:
        volume = {"layers": case["relative"]["layers"], "first_height": case["relative"]["first_height"] + " * wall.length"} | volume
        if "relative_farfield" in case:
            volume["farfield"] = f"sphere{{ radius = {case['relative_farfield']} * wall.length }}"
    outputs = ['"mesh.su2"'] + ([f'"{output_name(case)}"'] if case["output"] else [])
    lines += [f"local mesh = volume_mesh{volume_table(case, volume)}", "mesh:check()", f"mesh:write({', '.join(outputs)})"]
    return "\n".join(lines) + "\n"


def far_surface(field):
    return surfaces.moved(surfaces.ellipsoid(*map(float, field["radii"]), field["n"]), list(map(float, field["center"])))


def attitude_of(case):
    if turned := case.get("attitude"):
        return f":rotate{{ about = {{ {', '.join(turned['about'])} }}, pitch = {turned['pitch']}*deg, yaw = {turned['yaw']}*deg }}"
    return ""


def continued_script(case, names):
    """Lua that makes the same mesh behind a step that is kept in stopped.sterna; `names`: of the options of `tetrahedra` and `finish_mesh`."""
    of = {verb: {name: value for name, value in case["volume"].items() if name in names[verb]} for verb in names}
    lines = ['local kept = read_stages "stopped.sterna"', "local tets = kept.tetrahedra"]
    if case["continued"] == "envelope":
        lines[1] = f"local tets = tetrahedra{table_of('kept.envelope', of['tetrahedra'])}"
    return "\n".join(lines + [f"finish_mesh{table_of('kept.envelope, tets', of['finish_mesh'])}:write \"continued.su2\""]) + "\n"


def model_script(case):
    lines = []
    for part in case["components"]:
        if part.get("plain") and part.get("after"):
            without = table_of(f"{part['name']}:model()", {name: value for name, value in case["surface"].items() if name != "patches"} | {"crossings": '"ignore"'})
            lines.append(f'do local {part["name"]} = {part["lua"]}; {part["plain"]}; surface_mesh{without}:write "plain.stl" end')
    for part in case["components"]:
        lines += [f"local {part['name']} = {part['lua']}"] + part.get("after", [])
    names = ", ".join(part["name"] for part in case["components"])
    if any(part["name"] == "main_wing" for part in case["components"]):
        lines.append('local seen = main_wing:at(0.5, 0); print(string.format("SOAK seen %.17g %.17g %.17g", seen[1], seen[2], seen[3]))')
    turn = attitude_of(case)
    if case["kind"] == "parts" and case.get("triangulated"):
        pieces = [f"surface_mesh{table_of(part['name'], case['surface'])}" for part in case["components"]]
        return lines + [f"local wall = union{{ {', '.join(pieces)} }}" + turn]
    lines.append(f"local model = {'aircraft' if case['kind'] == 'aircraft' else 'union'}{{ {names} }}{turn}")
    lines.append('print("SOAK volume " .. string.format("%.17g", model:measures().volume))')
    if case.get("through"):
        lines.append(f'model:write "model{case["through"]}"; model = read_cad "model{case["through"]}"; print("SOAK read " .. string.format("%.17g", model:measures().volume))')
    if case.get("half"):
        lines.append("model = half(model)")
    target = "model, " + case["tunnel"] if case.get("tunnel") else "model"
    alike = {"periodic": pairs_of(case)} if case.get("periodic") else {}  # borders of periodic sides are cut alike
    return lines + [f"local wall = surface_mesh{table_of(target, case['surface'] | alike)}"]


def surface_script(case, folder, data):
    patches = soup_of(case, data)
    if patches is None:
        name = str(data / case["file"])
    else:
        form = case["input"]
        name = "input." + form.split()[0]
        surfaces.write(pathlib.Path(folder) / name, patches, form)
    entries = dict(case["surface"])
    if case["remedy"] != "none":
        coarse = f"{{ edge = {num(0.04 * max(surfaces.size_of(soup) for _, soup in patches) / float(case['scale']))} }}" if case["remedy"] == "wrap" and patches else "true"
        entries[case["remedy"]] = coarse
    entries["unit"] = num(1 / float(case["scale"]))
    if converted := case.get("converted"):
        case["convert"] = [name, "converted" + converted]
        name = "converted" + converted
    first = '"' + name + '"'
    return [f"local wall = read_surface{table_of(first, entries)}"]


def only_possible(case):
    """Takes out what was drawn together though the program says that it cannot be had together."""
    volume = case["volume"]
    if volume.get("boundary_splits") == '"always"' and (case.get("half") or case.get("tunnel") or case.get("wakes") or case.get("periodic") or case.get("disc") or "open_ridges" in volume or case["kind"] in ("surface", "model")):
        del volume["boundary_splits"]  # engines may not split triangles of boundaries with rims
    return case


def make(seed, index, table, data):
    """The case of this seed and index."""
    rng = surfaces.generator(seed, index)
    kind = rng.choices(["aircraft", "parts", "row", "surface", "model"], [45, 15, 6, 20, 14])[0]
    case = {"aircraft": lambda: aircraft(rng, table), "parts": lambda: parts(rng, table), "row": lambda: row(rng, table), "surface": lambda: surface(rng, table, data),
            "model": lambda: model(rng, table, data)}[kind]()
    if rng.random() < 0.2:
        case["continued"] = rng.choice(["envelope", "tetrahedra"])
    return {"seed": seed, "index": index} | only_possible(case)
