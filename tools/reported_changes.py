"""Shortens the report of sterna on the changes of a surface; used by tools/measure_dirty and tools/measure_auto."""
import re

NUMBER = r"([-+.\deE]+)"
SHORT = [("dropped", "dropped"), ("welded", "welded"), ("seams zipped", "seams"), ("open boundary of the half model", "half"), ("holes filled", "holes"),
         ("cut where facets cross", "cut"), ("sheets without", "sheets"), ("facets inside", "inside"), ("small parts", "parts"),
         ("touching vertices", "parted"), ("touching parts", "joined"), ("short edges", "collapsed"), ("crossing facets replaced", "replaced"), ("orientation changed", "turned")]


def short(change):
    """Returns a change in short words, and its largest distances (of retained facets, of all) in metres."""
    kind, _, rest = change.partition(": ")
    if kind == "wrapped":
        found = re.search(rf"wrap to input at most {NUMBER} m outside closed openings, {NUMBER} m in closed openings; input to wrap at most {NUMBER} m", rest)
        kept, closed, back = (float(x) for x in found.groups())
        closures = re.search(r"closed (\d+) place", rest)
        words = [f"{closures.group(1)} closed"] if closures else []
        words += [f"{len(re.findall('leak: ', rest))} leaks"] if "leak: " in rest else []
        return ", ".join(words), kept, max(kept, closed, back)
    words, kept, far = [], 0.0, 0.0
    for part in rest.split("; "):
        found = re.match(r"(.*?): (\d+) places? \((\d+) facets?\)", part)
        if found:
            name = next((b for a, b in SHORT if found.group(1).startswith(a)), found.group(1))
            words.append(f"{name} {found.group(2)} ({found.group(3)})")
        found = re.match(rf"retained facets moved by at most {NUMBER} m, the new surface is at most {NUMBER} m from the input surface, and the input surface at most {NUMBER} m", part)
        if found:
            kept, far = float(found.group(1)), max(float(x) for x in found.groups())
    return ", ".join(words) or rest[:60], kept, far


def remeshed(changes):
    """Returns the number of triangles before remesh, and the largest distance of the new triangles from them in metres; None if remesh did not run."""
    found = re.search(rf"remeshed: ([\d ]+) -> [\d ]+ triangles, at most {NUMBER} m from the given ones", "\n".join(changes))
    return (found.group(1).replace(" ", ""), float(found.group(2))) if found else None
