"""Runs a case of the soak and says what became of it: VALID, forced (VALID where places are forced), refused (with place and remedy), or wrong.

Wrong is: a mesh that soak_mesh_audit refuses or that an other format does not hold again, a crash, a run beyond its limit, an error without place or remedy, and what was asked and neither
done nor told to be left undone (first height, number of layers, farfield, attitude, patches, volume of the parts).
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


class Judge:
    def __init__(self, sterna, audit, data, limit):
        self.sterna, self.audit, self.data, self.limit = sterna, audit, data, limit

    def run_audit(self, path, folder, walls=(), near=()):
        """What soak_mesh_audit says, or nothing and why."""
        words = [self.audit, path] + [word for wall in walls for word in ("--wall", wall)]
        for point in near:
            words += ["--near", ",".join(repr(x) for x in point)]
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
        kinds = {patch["name"]: patch["kind"] for patch in manifest["patches"]}
        walls = [name for name, kind in kinds.items() if kind == "wall"]
        told = dict(re.findall(r"^SOAK (\w+) (.*)$", done.out, re.MULTILINE))
        near = []
        if "seen" in told and not case.get("half"):
            point = [float(word) for word in told["seen"].split()]
            near = [turned(point, case["attitude"]) if case.get("attitude") else point]
        found, trouble = self.run_audit("mesh.su2", folder, walls, near)
        if not found:
            return "wrong", "unreadable: " + trouble
        if found["findings"]:
            return "wrong", "audit: " + json.dumps(found["findings"])
        for look in (self.asked_layers, self.asked_patches, self.asked_farfield, self.asked_attitude, self.asked_volume):
            if why := look(case, manifest, found, told, done.out + done.err):
                return "wrong", "silent: " + why
        if why := self.other_format(case, folder, found):
            return "wrong", why
        forced = manifest.get("quality", {}).get("forced") or manifest["improvement"]["forced"] or manifest["layer"]["collapsed_area"] > 0
        return ("forced" if forced else "VALID"), ", ".join(sorted(manifest.get("quality", {}).get("failed", [])))

    # ---- what was asked ----

    def asked_layers(self, case, manifest, found, told, text):
        asked = case.get("volume", {}) if case["kind"] != "surface" else case["relative"] | case["volume"]
        length = float(told["length"])
        height = float(asked["first_height"]) * (length if case["kind"] == "surface" else 1)
        own = {"tunnel_floor", "tunnel_right", "tunnel_ceiling", "tunnel_left"}
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
            if off > 1.5 or (not least < off < 1.2 and not is_told):
                return f'first height on {name} {off * height:g}, asked for {height:g}'
            if marker["layers"]["median"] < int(asked["layers"]) and "truncate" not in asked and not is_told:
                return f'{marker["layers"]["median"]:.0f} layers on {name}, asked for {asked["layers"]}'
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
        elif field.get("shape") == "box":
            for asked, made in ((field["low"], low), (field["high"], high)):
                if made is None or any(abs(float(asked[k]) - made[k]) > 1e-6 * abs(float(field["high"][0])) for k in range(3) if not (case.get("half") and k == 1)):
                    return f"farfield box asked for {field['low']} .. {field['high']}, made {low} .. {high}"
        return ""

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
