#!/usr/bin/env python3
"""Independent second opinion on surface files: what is wrong with them, counted without any of sterna's code.

usage: surface_verdict.py FILE...      prints one tab-separated row per file (several files with --joined: one row for all).
       --all: count the crossings also where another defect decides the verdict already (slow).

Reads STL, OBJ, OFF (ASCII and binary) and PLY with readers of its own, welds vertices that are exactly equal, drops facets with a repeated
vertex and copies of a facet, welds boundary vertices within rounding, and counts: boundary edges, edges with more than two triangles,
vertices with more than one fan, components that no choice of orientation makes consistent, and pairs of triangles that meet in more than
their common vertices. The last count uses rational arithmetic (fractions.Fraction) wherever a floating-point filter with a wide margin
cannot decide. Only Python's standard library. Columns two and three are the verdict and its number of places, as in nasty_surfaces.tsv.
"""
import gzip
import math
import re
import struct
import sys
from collections import defaultdict
from fractions import Fraction

# ------------------------------------------------------------------------------------------------ readers


def load(path):
    data = open(path, "rb").read()
    if data[:2] == b"\x1f\x8b":
        data = gzip.decompress(data)
    name = path.lower()
    if name.endswith(".gz"):
        name = name[:-3]
    for extension, reader in ((".stl", read_stl), (".obj", read_obj), (".off", read_off), (".ply", read_ply), (".msh", read_msh), (".ugrid", read_ugrid)):
        if name.endswith(extension):
            return reader(data)
    return None


def fan(polygon):
    return [(polygon[0], polygon[i], polygon[i + 1]) for i in range(1, len(polygon) - 1)]


def read_stl(data):
    if len(data) >= 84 and 84 + 50 * struct.unpack_from("<I", data, 80)[0] == len(data):
        n = struct.unpack_from("<I", data, 80)[0]
        points = []
        for i in range(n):
            f = struct.unpack_from("<9f", data, 84 + 50 * i + 12)
            points += [f[0:3], f[3:6], f[6:9]]
    else:
        points = [tuple(map(float, m)) for m in re.findall(rb"vertex\s+(\S+)\s+(\S+)\s+(\S+)", data)]
    return points, [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(len(points) // 3)]


def read_obj(data):
    points, triangles = [], []
    for line in data.decode("latin-1").splitlines():
        words = line.split()
        if not words:
            continue
        if words[0] == "v":
            points.append(tuple(map(float, words[1:4])))
        elif words[0] == "f":
            index = [int(w.split("/")[0]) for w in words[1:]]
            triangles += fan([i - 1 if i > 0 else len(points) + i for i in index])
    return points, triangles


def read_off(data):
    if data.startswith(b"OFF BINARY"):
        at = data.index(b"\n") + 1
        n_points, n_faces, _ = struct.unpack_from("<3i", data, at)
        at += 12
        points = [struct.unpack_from("<3f", data, at + 12 * i) for i in range(n_points)]
        at += 12 * n_points
        triangles = []
        for _ in range(n_faces):
            k = struct.unpack_from("<i", data, at)[0]
            triangles += fan(struct.unpack_from("<%di" % k, data, at + 4))
            at += 4 + 4 * k
        return points, triangles
    words = b"\n".join(line.split(b"#")[0] for line in data.splitlines()).split()
    at = 1
    n_points, n_faces = int(words[at]), int(words[at + 1])
    at += 3
    points = [tuple(map(float, words[at + 3 * i : at + 3 * i + 3])) for i in range(n_points)]
    at += 3 * n_points
    triangles = []
    for _ in range(n_faces):
        k = int(words[at])
        triangles += fan(list(map(int, words[at + 1 : at + 1 + k])))
        at += 1 + k
    return points, triangles


def read_ply(data):
    end = data.index(b"end_header") + len(b"end_header")
    end = data.index(b"\n", end) + 1
    header = data[:end].decode("latin-1").split("\n")
    n_points = int(next(h for h in header if h.startswith("element vertex")).split()[2])
    n_faces = int(next(h for h in header if h.startswith("element face")).split()[2])
    n_properties = sum(1 for h in header[: next(i for i, h in enumerate(header) if h.startswith("element face"))] if h.startswith("property"))
    points, triangles = [], []
    if "ascii" in header[1]:
        words = data[end:].split()
        for i in range(n_points):
            points.append(tuple(map(float, words[n_properties * i : n_properties * i + 3])))
        at = n_properties * n_points
        for _ in range(n_faces):
            k = int(words[at])
            triangles += fan(list(map(int, words[at + 1 : at + 1 + k])))
            at += 1 + k
        return points, triangles
    assert "little" in header[1] and n_properties == 3
    points = [struct.unpack_from("<3f", data, end + 12 * i) for i in range(n_points)]
    at = end + 12 * n_points
    for _ in range(n_faces):
        k = data[at]
        triangles += fan(struct.unpack_from("<%di" % k, data, at + 1))
        at += 1 + 4 * k
    return points, triangles


def read_msh(data):
    lines = data.decode("latin-1").split("\n")
    points, triangles = {}, []
    at = lines.index("$Nodes") + 1
    for _ in range(1):
        n_blocks = int(lines[at].split()[0])
        at += 1
        for _ in range(n_blocks):
            n = int(lines[at].split()[3])
            for i in range(n):
                points[int(lines[at + 1 + i])] = tuple(map(float, lines[at + 1 + n + i].split()[:3]))
            at += 1 + 2 * n
    tag2index = {tag: i for i, tag in enumerate(points)}
    at = lines.index("$Elements") + 1
    n_blocks = int(lines[at].split()[0])
    at += 1
    for _ in range(n_blocks):
        _, _, kind, n = map(int, lines[at].split())
        if kind == 2:
            triangles += [tuple(tag2index[int(w)] for w in lines[at + 1 + i].split()[1:4]) for i in range(n)]
        at += 1 + n
    return list(points.values()), triangles


def read_ugrid(data):
    n_points, n_triangles = struct.unpack_from("<2i", data, 0)
    points = [struct.unpack_from("<3d", data, 28 + 24 * i) for i in range(n_points)]
    at = 28 + 24 * n_points
    return points, [tuple(v - 1 for v in struct.unpack_from("<3i", data, at + 12 * i)) for i in range(n_triangles)]


# ------------------------------------------------------------------------------------------------ exact geometry

EPSILON = 2.0**-53


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def exact(p):
    return (Fraction(p[0]), Fraction(p[1]), Fraction(p[2]))


def det3(u, v, w):
    return u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) + u[2] * (v[0] * w[1] - v[1] * w[0])


def orient3d(a, b, c, d):
    u, v, w = sub(b, a), sub(c, a), sub(d, a)
    value = det3(u, v, w)
    size = max(map(abs, u)) * max(map(abs, v)) * max(map(abs, w))
    if abs(value) > 100 * EPSILON * size:  # 6 products of 3 rounded factors each: error < 6 * 6 u * size
        return 1 if value > 0 else -1
    a, b, c, d = map(exact, (a, b, c, d))
    value = det3(sub(b, a), sub(c, a), sub(d, a))
    return (value > 0) - (value < 0)


def cross_exact(a, b, c):
    a, b, c = map(exact, (a, b, c))
    u, v = sub(b, a), sub(c, a)
    return (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])


def is_collinear(a, b, c):
    u, v = sub(b, a), sub(c, a)
    size = max(map(abs, u)) * max(map(abs, v))
    n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    if max(map(abs, n)) > 20 * EPSILON * size:
        return False
    return cross_exact(a, b, c) == (0, 0, 0)


def orient2d(a, b, c):
    value = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    return (value > 0) - (value < 0)


def flatten(points, normal):
    """Exact 2-D coordinates of coplanar points: the axis along which the normal is not zero is left out."""
    drop = next(i for i in range(3) if normal[i] != 0)
    keep = [i for i in range(3) if i != drop]
    return [tuple(exact(p)[i] for i in keep) for p in points]


def on_segment_2d(a, b, p):
    return orient2d(a, b, p) == 0 and min(a[0], b[0]) <= p[0] <= max(a[0], b[0]) and min(a[1], b[1]) <= p[1] <= max(a[1], b[1])


def segments_meet_2d(a, b, c, d):
    s1, s2, s3, s4 = orient2d(a, b, c), orient2d(a, b, d), orient2d(c, d, a), orient2d(c, d, b)
    if s1 * s2 < 0 and s3 * s4 < 0:
        return True
    return on_segment_2d(a, b, c) or on_segment_2d(a, b, d) or on_segment_2d(c, d, a) or on_segment_2d(c, d, b)


def in_triangle_2d(t, p):
    signs = [orient2d(t[i], t[(i + 1) % 3], p) for i in range(3)]
    return not (1 in signs and -1 in signs)


def segment_meets_triangle(p, q, t):
    """Closed segment and closed, proper triangle."""
    sp, sq = orient3d(*t, p), orient3d(*t, q)
    if sp * sq > 0:
        return False
    if sp == 0 and sq == 0:
        f = flatten(list(t) + [p, q], cross_exact(*t))
        triangle, a, b = f[:3], f[3], f[4]
        return in_triangle_2d(triangle, a) or in_triangle_2d(triangle, b) or any(segments_meet_2d(triangle[i], triangle[(i + 1) % 3], a, b) for i in range(3))
    if sp == 0 or sq == 0:
        f = flatten(list(t) + [p if sp == 0 else q], cross_exact(*t))
        return in_triangle_2d(f[:3], f[3])
    signs = [orient3d(p, q, t[i], t[(i + 1) % 3]) for i in range(3)]
    return not (1 in signs and -1 in signs)


def triangles_meet_too_much(points, s, t):
    common = [v for v in s if v in t]
    a, b = [points[v] for v in s], [points[v] for v in t]
    if not common:
        for x, y in ((a, b), (b, a)):
            if abs(sum(orient3d(*x, p) for p in y)) == 3:
                return False  # all strictly on one side
        return any(segment_meets_triangle(a[i], a[(i + 1) % 3], b) for i in range(3)) or any(segment_meets_triangle(b[i], b[(i + 1) % 3], a) for i in range(3))
    if len(common) == 1:
        v = common[0]
        so, to = [w for w in s if w != v], [w for w in t if w != v]
        # Beyond the common vertex the triangles meet iff the edge opposite to it in one of them meets the other.
        return segment_meets_triangle(points[so[0]], points[so[1]], b) or segment_meets_triangle(points[to[0]], points[to[1]], a)
    if len(common) == 2:
        p, q = (points[w] for w in common)
        c, d = (points[next(w for w in x if w not in common)] for x in (s, t))
        if orient3d(p, q, c, d) != 0:
            return False
        f = flatten([p, q, c, d], cross_exact(p, q, c))
        return orient2d(f[0], f[1], f[2]) == orient2d(f[0], f[1], f[3])
    return True


def overlapping_pairs(boxes):
    """Pairs of closed boxes (low, high) that overlap: a tree of medians, descended against itself."""

    def build(items):
        low = [min(boxes[i][0][k] for i in items) for k in range(3)]
        high = [max(boxes[i][1][k] for i in items) for k in range(3)]
        if len(items) <= 4:
            return (low, high, items, None)
        axis = max(range(3), key=lambda k: high[k] - low[k])
        items.sort(key=lambda i: boxes[i][0][axis] + boxes[i][1][axis])
        half = len(items) // 2
        return (low, high, build(items[:half]), build(items[half:]))

    def apart(a, b):
        (la, ha), (lb, hb) = a[:2], b[:2]
        return la[0] > hb[0] or lb[0] > ha[0] or la[1] > hb[1] or lb[1] > ha[1] or la[2] > hb[2] or lb[2] > ha[2]

    root = build(list(range(len(boxes))))
    stack = [(root, root)]
    while stack:
        a, b = stack.pop()
        if a is b:
            if a[3] is None:
                for m, i in enumerate(a[2]):
                    for j in a[2][m + 1 :]:
                        if not apart(boxes[i], boxes[j]):
                            yield (i, j) if i < j else (j, i)
            else:
                stack += [(a[2], a[2]), (a[3], a[3]), (a[2], a[3])]
        elif not apart(a, b):
            if a[3] is not None:
                stack += [(a[2], b), (a[3], b)]
            elif b[3] is not None:
                stack += [(a, b[2]), (a, b[3])]
            else:
                for i in a[2]:
                    for j in b[2]:
                        if not apart(boxes[i], boxes[j]):
                            yield (i, j) if i < j else (j, i)


def crossing_pairs(points, triangles):
    boxes = []
    for t in triangles:
        c = list(zip(*(points[v] for v in t)))
        boxes.append(([min(x) for x in c], [max(x) for x in c]))
    return sorted((i, j) for i, j in overlapping_pairs(boxes) if triangles_meet_too_much(points, triangles[i], triangles[j]))


# ------------------------------------------------------------------------------------------------ combinatorics


def weld(points, triangles):
    index, welded, remap = {}, [], []
    for p in points:
        key = (p[0] + 0.0, p[1] + 0.0, p[2] + 0.0)  # -0.0 + 0.0 = 0.0
        if key not in index:
            index[key] = len(welded)
            welded.append(key)
        remap.append(index[key])
    return welded, [tuple(remap[v] for v in t) for t in triangles]


def edges_of(t):
    return [tuple(sorted((t[i], t[(i + 1) % 3]))) for i in range(3)]


def edge_map(triangles):
    result = defaultdict(list)
    for i, t in enumerate(triangles):
        for e in edges_of(t):
            result[e].append(i)
    return result


def drop_doubled_patches(triangles):
    """One of each set of copies stays, but for patches of copies without which every edge at their rim still has an even number of triangles."""
    count = defaultdict(int)
    first = {}
    for i, t in enumerate(triangles):
        key = tuple(sorted(t))
        count[key] += 1
        first.setdefault(key, i)
    keys = sorted(first, key=first.get)
    distinct = [triangles[first[k]] for k in keys]
    doubled = [count[k] > 1 for k in keys]
    edges = edge_map(distinct)
    dropped, visited = set(), set()
    for start in range(len(distinct)):
        if not doubled[start] or start in visited:
            continue
        patch, stack = [], [start]
        visited.add(start)
        rim = set()
        while stack:
            i = stack.pop()
            patch.append(i)
            for e in edges_of(distinct[i]):
                n = sum(1 for j in edges[e] if not doubled[j])
                if n:
                    rim.add(n % 2)
                for j in edges[e]:
                    if doubled[j] and j not in visited:
                        visited.add(j)
                        stack.append(j)
        if rim == {0}:
            dropped.update(patch)
    return [t for i, t in enumerate(distinct) if i not in dropped]


def find(parent, x):
    while parent[x] != x:
        parent[x] = parent[parent[x]]
        x = parent[x]
    return x


def split_touching(points, triangles):
    """A vertex (not an edge) that several edge-connected components share becomes one vertex for each of them."""
    edges = edge_map(triangles)
    parent = {i: i for i in range(len(triangles))}
    for ts in edges.values():
        for j in ts[1:]:
            parent[find(parent, j)] = find(parent, ts[0])
    points, owner, copy_of = list(points), {}, {}
    result = []
    for i, t in enumerate(triangles):
        c = find(parent, i)
        new = []
        for v in t:
            if owner.setdefault(v, c) != c:
                if (v, c) not in copy_of:
                    copy_of[v, c] = len(points)
                    points.append(points[v])
                v = copy_of[v, c]
            new.append(v)
        result.append(tuple(new))
    return points, result


def defects(triangles):
    """Edges with one triangle, edges with more than two, vertices with more than one fan, by edges."""
    edges = edge_map(triangles)
    boundary = [e for e, ts in edges.items() if len(ts) == 1]
    crowded = [e for e, ts in edges.items() if len(ts) > 2]
    parent = {(i, v): (i, v) for i, t in enumerate(triangles) for v in t}
    for e, ts in edges.items():
        for v in e:
            for j in ts[1:]:
                parent[find(parent, (ts[0], v))] = find(parent, (j, v))
    roots = defaultdict(set)
    for x in parent:
        roots[x[1]].add(find(parent, x))
    pinched = [v for v, r in roots.items() if len(r) > 1]
    return boundary, crowded, pinched, edges


def orientation(triangles, edges):
    """Components over edges with exactly two triangles; the parity of each triangle; components without a consistent choice."""
    shell, bad_shells, n_shells = {}, set(), 0
    flipped = [0] * len(triangles)
    for start in range(len(triangles)):
        if start in shell:
            continue
        shell[start] = n_shells
        stack = [start]
        while stack:
            i = stack.pop()
            t = triangles[i]
            for k in range(3):
                a, b = t[k], t[(k + 1) % 3]
                ts = edges[tuple(sorted((a, b)))]
                if len(ts) != 2:
                    continue
                j = ts[0] if ts[1] == i else ts[1]
                u = triangles[j]
                same = any((u[m], u[(m + 1) % 3]) == (a, b) for m in range(3))
                want = flipped[i] ^ same
                if j not in shell:
                    shell[j], flipped[j] = n_shells, want
                    stack.append(j)
                elif flipped[j] != want:
                    bad_shells.add(n_shells)
        n_shells += 1
    return shell, flipped, n_shells, bad_shells


def weld_near(points, triangles):
    """Boundary vertices within the automatic tolerance become one, if that closes edges and makes no other defect."""
    boundary, crowded, pinched, _ = defects(triangles)
    if not boundary:
        return points, triangles, 0
    used = sorted({v for t in triangles for v in t})
    length = max(max(points[v][k] for v in used) - min(points[v][k] for v in used) for k in range(3))
    tolerance = 1e-9 * length
    if all(struct.unpack("f", struct.pack("f", x))[0] == x for v in used for x in points[v]):
        tolerance = max(tolerance, 2.5e-7 * max(abs(x) for v in used for x in points[v]))
    rim = sorted({v for e in boundary for v in e}, key=lambda v: points[v])
    parent = {v: v for v in rim}
    for i, v in enumerate(rim):
        for w in rim[i + 1 :]:
            if points[w][0] - points[v][0] > tolerance:
                break
            if math.dist(points[v], points[w]) <= tolerance:
                r, s = sorted((find(parent, v), find(parent, w)))
                parent[s] = r
    n_welded = sum(1 for v in rim if find(parent, v) != v)
    if not n_welded:
        return points, triangles, 0
    new = [tuple(find(parent, v) if v in parent else v for v in t) for t in triangles]
    new = drop_doubled_patches([t for t in new if len(set(t)) == 3])
    after = defects(new)
    if len(after[0]) < len(boundary) and len(after[1]) <= len(crowded) and len(after[2]) <= len(pinched):
        return points, new, n_welded
    return points, triangles, -n_welded


def signed_volumes(points, triangles, shell, flipped, n_shells):
    volume = [0.0] * n_shells
    for i, t in enumerate(triangles):
        v = det3(*(points[k] for k in t)) / 6
        volume[shell[i]] += -v if flipped[i] else v
    return volume


def examine(name, points, triangles):
    n_read = len(triangles)
    points, triangles = weld(points, triangles)
    repeated = sum(1 for t in triangles if len(set(t)) < 3)
    triangles = [t for t in triangles if len(set(t)) == 3]
    n = len(triangles)
    triangles = drop_doubled_patches(triangles)
    copies = n - len(triangles)
    points, triangles, n_near = weld_near(points, triangles)
    points, triangles = split_touching(points, triangles)
    flat = {i for i, t in enumerate(triangles) if is_collinear(*(points[v] for v in t))}
    boundary, crowded, pinched, edges = defects(triangles)
    shell, flipped, n_shells, bad = orientation(triangles, edges)
    n_flipped, n_total = [0] * n_shells, [0] * n_shells
    for i, s in shell.items():
        n_flipped[s] += flipped[i]
        n_total[s] += 1
    n_inconsistent = sum(min(f, m - f) for f, m in zip(n_flipped, n_total))
    proper = [t for i, t in enumerate(triangles) if i not in flat]
    is_needed = not (crowded or boundary or pinched or bad) or "--all" in sys.argv
    crossings = crossing_pairs(points, proper) if proper and is_needed else []
    volumes = signed_volumes(points, triangles, shell, flipped, n_shells)
    if crowded:
        verdict = ("non_manifold_surface", len(crowded) + len(pinched))
    elif boundary:
        verdict = ("open_surface", len(boundary))
    elif pinched:
        verdict = ("non_manifold_surface", len(pinched))
    elif bad:
        verdict = ("not_orientable", len(bad))
    elif crossings:
        verdict = ("self_intersection", len(crossings))
    else:
        verdict = ("valid", 0)
    print(
        "%s\t%s\t%d\ttriangles=%d\tkept=%d\trepeated=%d\tcopies=%d\tnear=%d\tflat=%d\tboundary=%d\tcrowded=%d\tpinched=%d\tshells=%d\tnot_orientable=%d\tto_flip=%d\tinside_out=%d\tcrossings=%s"
        % (name, *verdict, n_read, len(triangles), repeated, copies, n_near, len(flat), len(boundary), len(crowded), len(pinched), n_shells, len(bad), n_inconsistent, sum(1 for v in volumes if v < 0), len(crossings) if is_needed else "-"),
        flush=True,
    )


def main(arguments):
    joined = "--joined" in arguments
    paths = [a for a in arguments if not a.startswith("--")]
    all_points, all_triangles = [], []
    for path in paths:
        soup = load(path)
        if soup is None:
            print("%s\tunsupported_format" % path.split("/")[-1], flush=True)
            continue
        if joined:
            all_triangles += [tuple(v + len(all_points) for v in t) for t in soup[1]]
            all_points += soup[0]
        else:
            examine(path.split("/")[-1], *soup)
    if joined:
        examine("+".join(p.split("/")[-1] for p in paths), all_points, all_triangles)


if __name__ == "__main__":
    main(sys.argv[1:])
