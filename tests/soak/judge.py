"""Runs a case of the soak and says what became of it: VALID, forced (VALID where places are forced), refused (with place and remedy), or wrong.

Wrong is: a mesh that soak_mesh_audit refuses or that an other format does not hold again, a crash, a run beyond its limit, an error without place or remedy, and what was asked and neither
done nor told to be left undone (first height, number of layers, farfield, tunnel, attitude, patches, volume of the parts, wake sheets, periodic sides, deflections); and a mesh that is another
when the run is stopped behind a step and continued.
"""
import json
import math
import os
import pathlib
import re
import resource
import signal
import subprocess
import tempfile
import time

import cases
import surfaces

MEMORY = 8 << 30  # bytes of address space of each process
WALL = 12.0       # seconds of the clock for each of the processor: other programs run, too


class Run:
    """A finished child: its output, and how it ended."""

    def __init__(self, command, folder, limit):
        cap = int(limit) + 1

        def bound():
            resource.setrlimit(resource.RLIMIT_CPU, (cap, cap + 5))
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        environment = {**os.environ, "TMPDIR": str(folder)}
        with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
            child = subprocess.Popen([str(word) for word in command], cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=out, stderr=err, preexec_fn=bound, start_new_session=True)
            end = time.monotonic() + WALL * limit
            ended, status, usage = os.wait4(child.pid, os.WNOHANG)
            while not ended and time.monotonic() < end:
                time.sleep(0.02)
                ended, status, usage = os.wait4(child.pid, os.WNOHANG)
            self.is_late = not ended
            if self.is_late:
                os.killpg(child.pid, signal.SIGKILL)
                _, status, usage = os.wait4(child.pid, 0)
            child.returncode = self.status = os.waitstatus_to_exitcode(status)
            self.out, self.err = (file.seek(0) or file.read().decode(errors="replace") for file in (out, err))
        self.seconds = usage.ru_utime + usage.ru_stime  # of the processor
        self.is_late = self.is_late or self.status == -signal.SIGXCPU

    def trouble(self):
        """Of a process that did not end by itself."""
        if self.is_late:
            return "hang"
        return f"crash: {signal.Signals(-self.status).name}" if self.status < 0 else ""


def is_honest(text):
    """Whether an error names a place (coordinates, or by name what it is about) and a remedy."""
    message = text[text.find("error:"):] if "error:" in text else ""
    has_place = re.search(r"\(-?[\d.e+-]+, -?[\d.e+-]+, -?[\d.e+-]+\)", message) or re.search(r'"[^"]+"', message) or re.search(r"\b(input|converted|mesh|other)\.\w+|case\.lua:\d+: \w+: \w+: .*, expected ", message)
    return bool(has_place) and bool(re.search(r"^\s*try: \S|, expected .* in ", message, re.MULTILINE))  # what is out of range names the range


def turned(point, attitude):
    """Where the attitude brings a point: roll first, then pitch (nose up), then yaw (nose to starboard), about axes that stay."""
    x, y, z = (point[k] - float(attitude["about"][k]) for k in range(3))
    a, b = math.radians(float(attitude["pitch"])), math.radians(float(attitude["yaw"]))
    x, z = x * math.cos(a) + z * math.sin(a), z * math.cos(a) - x * math.sin(a)
    x, y = x * math.cos(b) + y * math.sin(b), y * math.cos(b) - x * math.sin(b)
    return [x + float(attitude["about"][0]), y + float(attitude["about"][1]), z + float(attitude["about"][2])]


def plate_normal(sums):
    """The direction that most of a patch's area faces, of the sums of area times n n^T (xx, xy, xz, yy, yz, zz): by the power method."""
    xx, xy, xz, yy, yz, zz = sums
    n = max(([1.0, 0.0, 0.0], xx), ([0.0, 1.0, 0.0], yy), ([0.0, 0.0, 1.0], zz), key=lambda pair: pair[1])[0]
    for _ in range(200):
        n = [xx * n[0] + xy * n[1] + xz * n[2], xy * n[0] + yy * n[1] + yz * n[2], xz * n[0] + yz * n[1] + zz * n[2]]
        length = math.hypot(*n)
        n = [x / length for x in n]
    return n


def normal_sums(soup):
    """Area times n n^T of triangles, as soak_mesh_audit sums it for markers."""
    sums = [0.0] * 6
    for a, b, c in soup:
        u, v = [b[k] - a[k] for k in range(3)], [c[k] - a[k] for k in range(3)]
        n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        length = math.hypot(*n)
        if length > 0:
            for at, (i, j) in enumerate(((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))):
                sums[at] += n[i] * n[j] / (2 * length)
    return sums


class Judge:
    def __init__(self, sterna, audit, data, limit):
        self.sterna, self.audit, self.data, self.limit = sterna, audit, data, limit
        self.names = None  # of the options of the steps

    def run_audit(self, path, folder, walls=(), near=(), pairs=()):
        """What soak_mesh_audit says, or nothing and why."""
        words = [self.audit, path] + [word for wall in walls for word in ("--wall", wall)]
        for point in near:
            words += ["--near", ",".join(repr(x) for x in point)]
        for first, second in pairs:
            words += ["--pair", first, second]
        done = Run(words, folder, self.limit)
        if done.trouble() or done.status not in (0, 3):
            return None, f"audit of {path}: {done.trouble() or done.err.strip()}"
        return json.loads(done.out), ""

    def __call__(self, case, folder):
        """{"verdict", "why", "seconds"}; "why" of what is wrong begins with its class."""
        folder = pathlib.Path(folder)
        verdict, why, seconds = self.verdict(case, folder)
        return {"verdict": verdict, "why": why, "seconds": round(seconds, 1)}

    def verdict(self, case, folder):
        """Verdict, reason, and the processor seconds of the script."""
        script = cases.script_of(case, folder, self.data)
        (folder / "case.lua").write_text(script)
        (folder / "case.json").write_text(json.dumps(case, indent=1))
        if convert := case.get("convert"):
            done = Run([self.sterna, "convert", *convert], folder, self.limit)
            if done.trouble():
                return "wrong", "convert: " + done.trouble(), done.seconds
            if done.status:
                return *self.refusal(done), done.seconds
        done = Run([self.sterna, "run", "case.lua", "--threads", "1"], folder, self.limit)
        (folder / "log").write_text(done.out + done.err)
        if done.trouble():
            return "wrong", done.trouble() + ": " + " ".join((done.out + done.err).split()[-12:]), done.seconds
        if done.status:
            return *self.refusal(done), done.seconds
        if not (folder / "mesh.su2").exists() or not (folder / "mesh.su2.json").exists():
            return "wrong", "no mesh: exit status 0, but no mesh.su2 or no manifest", done.seconds
        return *self.judge_mesh(case, folder, done), done.seconds

    def refusal(self, done):
        text = done.out + done.err
        if done.status == 3:
            return "wrong", "invalid: " + first_error(text)
        return ("refused" if is_honest(text) else "wrong"), ("" if is_honest(text) else "dishonest error: ") + first_error(text)

    def judge_mesh(self, case, folder, done):
        manifest = json.loads((folder / "mesh.su2.json").read_text())
        written = dict(re.findall(r'patch "([^"]*)" is written as marker "([^"]*)"', done.out + done.err))  # told: names that SU2 does not take
        for patch in manifest["patches"] + manifest["layer"]["patches"]:
            patch["name"] = written.get(patch["name"], patch["name"])
        kinds = {patch["name"]: patch["kind"] for patch in manifest["patches"]}
        walls = [name for name, kind in kinds.items() if kind == "wall"]
        told = dict(re.findall(r"^SOAK (\w+) (.*)$", done.out, re.MULTILINE))
        told["patches"] = "|".join(written.get(name, name) for name in told["patches"].split("|"))
        near = []
        if "seen" in told and not case.get("half"):
            point = [float(word) for word in told["seen"].split()]
            near = [turned(point, case["attitude"]) if case.get("attitude") else point]
        found, trouble = self.run_audit("mesh.su2", folder, walls, near, [pair[:2] for pair in case.get("periodic", [])])
        if not found:
            return "wrong", "unreadable: " + trouble
        if found["findings"]:
            return "wrong", "audit: " + json.dumps(found["findings"])
        for look in (self.asked_layers, self.asked_truncation, self.asked_patches, self.asked_farfield, self.asked_tunnel, self.asked_attitude, self.asked_volume, self.asked_wakes, self.asked_periodic):
            if why := look(case, manifest, found, told, done.out + done.err):
                return "wrong", "silent: " + why
        if why := self.asked_deflections(case, folder, found):
            return "wrong", "silent: " + why
        if why := self.again_when_continued(case, folder):
            return "wrong", why
        if why := self.other_format(case, folder, found):
            return "wrong", why
        forced = manifest.get("quality", {}).get("forced") or manifest["improvement"]["forced"] or manifest["layer"]["collapsed_area"] > 0
        return ("forced" if forced else "VALID"), ", ".join(sorted(manifest.get("quality", {}).get("failed", [])))

    # ---- what was asked ----

    def asked_layers(self, case, manifest, found, told, text):
        asked = case["relative"] | case["volume"] if "relative" in case else case["volume"]
        length = float(told["length"])
        height = float(asked["first_height"]) * (length if "relative" in case else 1)
        own = {"tunnel", "tunnel_floor", "tunnel_right", "tunnel_ceiling", "tunnel_left"}
        for name, marker in found["markers"].items():
            if name in own or name not in told["patches"].split("|") or not marker["layers"]:
                continue
            most = int(asked["layers"]) * (20 if "open_ridges" in asked else 1)
            if marker["layers"]["most"] > most and not case.get("tunnel"):
                return f'{marker["layers"]["most"]:.0f} layers on {name}, asked for {asked["layers"]}'
            patch = next((patch for patch in manifest["layer"]["patches"] if patch["name"] == name), None)
            is_told = patch is None or patch["full"] < 0.6 or patch["compressed"] > 0.3
            # Along its line or above the wall's triangle: lines that lean, at edges and corners, are longer than high.
            off = min((marker[which]["median"] / height for which in ("first_edge", "first_height")), key=lambda share: abs(math.log(share)))
            least = 0.98 * float(asked.get("height_floor", "0.938"))  # to which smoothing may lower heights
            is_told = is_told or marker["faces"] < 100  # at edges and corners heights of facets differ from those of vertices
            if (off > 1.5 and marker["faces"] >= 10) or (not least < off < 1.2 and not is_told):
                return f'first height on {name} {off * height:g}, asked for {height:g}'
            if marker["layers"]["median"] < int(asked["layers"]) and "truncate" not in asked and not is_told:
                return f'{marker["layers"]["median"]:.0f} layers on {name}, asked for {asked["layers"]}'
        return ""

    def asked_truncation(self, case, manifest, found, told, text):
        """Where lines are lower than layers times first height, though not collapsed, `truncate = "always"` leaves columns of fewer prisms (`growth = "local"`: of uniform growth `compressed` counts lines whose first cells alone are lower). Of lines a little lower than asked for all layers may stay: one less would be a step of more than
        max_growth."""
        if case["volume"].get("truncate") != '"always"' or case["volume"].get("growth") != '"local"' or case.get("tunnel"):
            return ""
        for patch in manifest["layer"]["patches"]:
            layers = found["markers"].get(patch["name"], {}).get("layers")
            if layers and patch["compressed"] > 0.02 and layers["least"] >= layers["most"]:
                return f'{patch["name"]} has lines lower than layers times first height, all of its columns have {layers["most"]:.0f} prisms'
        return ""

    def asked_patches(self, case, manifest, found, told, text):
        for name in told["patches"].split("|"):
            if found["markers"].get(name, {"faces": 0})["faces"] == 0:
                return f'patch "{name}" of the wall is no marker'
        disc = case.get("disc")
        for name in [disc["name"], disc["name"] + ".back"] if disc else []:
            if found["markers"].get(name, {"faces": 0})["faces"] == 0:
                return f'the disc\'s patch "{name}" is no marker'
        return ""

    def asked_farfield(self, case, manifest, found, told, text):
        outer = [marker for name, marker in found["markers"].items() if next((p["kind"] for p in manifest["patches"] if p["name"] == name), "") == "farfield"]
        boxes = [marker["box"] for marker in outer if "box" in marker]
        low, high = ([f(box[side][k] for box in boxes) for k in range(3)] if boxes else None for f, side in ((min, 0), (max, 1)))
        field = dict(case["farfield"])
        if "relative_farfield" in case:
            field = {"shape": "sphere", "radius": float(case["relative_farfield"]) * float(told["length"])}
        if field.get("shape") == "sphere":
            radius = float(field["radius"])
            if low is None or not 0.9 < (high[0] - low[0]) / (2 * radius) < 1.01:
                return f"farfield of radius {radius:g} has the box {low} .. {high}"
        elif field.get("shape") in ("cylinder", "surface"):
            return self.outer_shape(case, field, told, found)
        elif field.get("shape") == "box":
            if why := self.outer_shape(case, field, told, found):
                return why
            if field.get("sides"):
                return ""
            for asked, made in ((field["low"], low), (field["high"], high)):
                if made is None or any(abs(float(asked[k]) - made[k]) > 1e-6 * abs(float(field["high"][0])) for k in range(3) if not (case.get("half") and k == 1)):
                    return f"farfield box asked for {field['low']} .. {field['high']}, made {low} .. {high}"
        return ""

    def outer_shape(self, case, field, told, found):
        """The box of all that is neither the model's nor a plane of symmetry nor a disc, against the box, cylinder or surface that was asked for; and that sides with kinds of their own are where they belong."""
        disc = case.get("disc", {}).get("name")
        outer = {name: marker for name, marker in found["markers"].items()
                 if marker["faces"] and name not in told["patches"].split("|") and not name.startswith("symmetry") and name.partition(".")[0] != disc}
        if not outer:
            return "no farfield"
        low, high = ([f(marker["box"][side][k] for marker in outer.values()) for k in range(3)] for f, side in ((min, 0), (max, 1)))
        if field["shape"] == "box":
            asked = [[float(x) for x in field[side]] for side in ("low", "high")]
            least = asked
        elif field["shape"] == "cylinder":
            r = float(field["radius"])
            asked = [[float(field["from"]), -r, -r], [float(field["to"]), r, r]]
            least = [[asked[0][0], -0.95 * r, -0.95 * r], [asked[1][0], 0.95 * r, 0.95 * r]]
        else:
            soup = [p for t in cases.far_surface(field) for p in t]
            asked = [[f(p[k] for p in soup) for k in range(3)] for f in (min, max)]
            least = [[x - 0.05 * (x - 0.5 * (asked[0][k] + asked[1][k])) for k, x in enumerate(side)] for side in asked]
        slack = 1e-5 * max(high[k] - low[k] for k in range(3))
        for k in range(3):
            if case.get("half") and k == 1:
                continue
            if not (asked[0][k] - slack <= low[k] <= least[0][k] + slack and least[1][k] - slack <= high[k] <= asked[1][k] + slack):
                return f"{field['shape']} asked for {asked[0]} .. {asked[1]}, made {low} .. {high}"
        for name, x in (("inflow", asked[0][0]), ("outflow", asked[1][0])) if field.get("sides") else ():
            side = found["markers"].get(name)
            if not side or not side["faces"] or max(abs(side["box"][i][0] - x) for i in (0, 1)) > slack:
                return f'side "{name}" is not at x = {x:g}'
        return ""

    def asked_tunnel(self, case, manifest, found, told, text):
        if "tunnel_box" not in case:
            return ""
        outer = [marker["box"] for name, marker in found["markers"].items() if marker["faces"] and (name in ("inflow", "outflow") or name.partition("_")[0] == "tunnel")]
        for side, f in enumerate((min, max)):
            for k in range(3):
                asked, made = float(case["tunnel_box"][side][k]), f((box[side][k] for box in outer), default=math.inf)
                if abs(made - asked) > (1e-4 if k == 0 or "diameter" not in case["tunnel"] else 0.1) * abs(asked):
                    return f"tunnel asked for {case['tunnel_box']}, side {'xyz'[k]} at {made:g}"
        return ""

    def asked_wakes(self, case, manifest, found, told, text):
        """Prisms that stand on no boundary triangle are those of wake sheets and opened ridges: there, and as far downstream as asked, or none."""
        free = found["free_prisms"]
        if case.get("wakes"):
            if not free["n"]:
                return "no cells of a wake sheet"
            reach = free["box"][1][0] - free["box"][0][0]
            return "" if reach >= float(case["wake_reach"]) else f"wake sheets are {reach:g} long, {case['wake_reach']} and more were asked for"
        if "open_ridges" in case["volume"]:
            if any(part["name"] == "main_wing" and "trailing_edge = 0," in part["lua"] for part in case.get("components", [])) and "have several normals" not in text and "stay closed" not in text:
                return "a sharp trailing edge and open_ridges, and not a word about normals"
            is_opened = "have several normals" in text and "stay closed" not in text
            return "several normals are told, no cell has them" if is_opened and not free["n"] and not found["hexahedra"] else ""
        return f"{free['n']} prisms stand on no wall" if free["n"] else ""

    def asked_periodic(self, case, manifest, found, told, text):
        for (first, second, asked), made in zip(case.get("periodic", []), found["pairs"]):
            size = max(abs(float(x)) for x in asked)
            if not made["faces"][0] or made["nodes"][0] != made["nodes"][1] or made["faces"][0] != made["faces"][1] or made["faces_without_image"] or made["worst"] > 1e-9 * size:
                return f"periodic sides {first} and {second} do not match: {made}"
            if any(abs(float(x) - y) > 1e-5 * size for x, y in zip(asked, made["translation"])):
                return f"periodic side {second} is {made['translation']} from {first}, not {asked}"
        return ""

    def asked_deflections(self, case, folder, found):
        """Each deflected patch's plate has turned by about the angle against the mesh without deflections (the ends, where the skin returns to the wing, turn less)."""
        if not case.get("turned") or not (folder / "plain.stl").exists():
            return ""
        plain = surfaces.read_stl_patches(folder / "plain.stl")
        for asked in case["turned"]:
            name, angle = asked["patch"], abs(float(asked["angle"]))
            if angle < 4 or (case.get("half") and name not in found["markers"]):
                continue
            if name not in plain or not found["markers"].get(name, {"faces": 0})["faces"]:
                return f'deflected patch "{name}" is no marker'
            before, after = plate_normal(normal_sums(plain[name])), plate_normal(found["markers"][name]["normals"])
            if case.get("attitude"):
                before = turned(before, case["attitude"] | {"about": ["0", "0", "0"]})
            turn = math.degrees(math.acos(min(1, abs(sum(x * y for x, y in zip(before, after))))))
            if not 0.4 * angle < turn < 1.6 * angle + 1:
                return f'"{name}" turned by {turn:.3g} degrees, asked for {angle:g}'
        return ""

    def again_when_continued(self, case, folder):
        """The same bytes when the mesh is made again behind a step that its .sterna file keeps."""
        if not case.get("continued"):
            return ""
        self.names = self.names or {verb: cases.names_of(self.sterna, verb) for verb in ("tetrahedra", "finish_mesh")}
        (folder / "continued.lua").write_text(cases.continued_script(case, self.names))
        done = Run([self.sterna, "run", "continued.lua", "--threads", "1"], folder, self.limit)
        if done.trouble() or done.status:
            return f"continued behind the {case['continued']}: " + (done.trouble() or first_error(done.out + done.err))
        same = (folder / "mesh.su2").read_bytes() == (folder / "continued.su2").read_bytes()
        return "" if same else f"continued behind the {case['continued']}: another mesh"

    def asked_attitude(self, case, manifest, found, told, text):
        if not found["near"] or found["near"][0] is None:
            return ""
        limit = 0.15 * float(case["surface"]["max_edge"])
        return f'the wing\'s leading edge is {found["near"][0]:g} away from where the attitude brings it' if found["near"][0] > limit else ""

    def asked_volume(self, case, manifest, found, told, text):
        """What the walls enclose is the model's volume but for the facets'. Not where other boundaries close it: tunnels, discs, the plane of a half model."""
        if "volume" not in told or case.get("tunnel") or case.get("disc") or case.get("half"):
            return ""
        asked = float(told["volume"])
        if "read" in told and not math.isclose(asked, float(told["read"]), rel_tol=1e-3):
            return f"the model read from {case['through']} has {told['read']}, written was {asked:g}"
        walls = [marker for name, marker in found["markers"].items() if name in told["patches"].split("|")]
        made = -sum(marker["flux"] for marker in walls)
        return f"the walls enclose {made:g}, the model has {asked:g}" if not 0.8 < made / asked < 1.1 else ""

    def other_format(self, case, folder, found):
        """The mesh in another format, read again and written as SU2, is the same one."""
        if not case["output"]:
            return ""
        name = cases.output_name(case)
        done = Run([self.sterna, "convert", name, "again.su2"], folder, self.limit)
        if done.trouble() or done.status:
            return f"format {case['output']}: " + (done.trouble() or first_error(done.out + done.err))
        again, trouble = self.run_audit("again.su2", folder)
        if not again:
            return f"format {case['output']}: {trouble}"
        if again["findings"]:
            return f"format {case['output']}: audit: " + json.dumps(again["findings"])
        for key in ("nodes", "tetrahedra", "prisms", "pyramids", "hexahedra"):
            if again[key] != found[key]:
                return f"format {case['output']}: {again[key]} {key}, were {found[key]}"
        mine, theirs = ({name: marker["faces"] for name, marker in which["markers"].items()} for which in (found, again))
        if mine != theirs:
            return f"format {case['output']}: patches {theirs}, were {mine}"
        return "" if math.isclose(again["volume"], found["volume"], rel_tol=1e-5) else f"format {case['output']}: volume {again['volume']}, was {found['volume']}"


def first_error(text):
    lines = text.splitlines()
    at = next((i for i, line in enumerate(lines) if "error:" in line), None)
    if at is None:
        return "no message; the last line is: " + (lines[-1] if lines else "(nothing)")
    return " / ".join(line.strip() for line in lines[at:at + 8])[:700]
