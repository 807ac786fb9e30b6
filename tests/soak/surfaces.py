"""Triangle soups for the soak: simple shapes, files, damage. A soup is a list of triangles, each three points (x, y, z); patches are (name, soup)."""
import math
import random
import struct


def box(low, high):
    """Twelve triangles, outwards."""
    corner = [(low[0] if i & 1 == 0 else high[0], low[1] if i & 2 == 0 else high[1], low[2] if i & 4 == 0 else high[2]) for i in range(8)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return [(corner[a], corner[b], corner[c]) for q in quads for a, b, c in ((q[0], q[1], q[2]), (q[0], q[2], q[3]))]


def refined(soup, times):
    """Each triangle in four, so often."""
    for _ in range(times):
        fine = []
        for a, b, c in soup:
            ab, bc, ca = (tuple((p[k] + q[k]) / 2 for k in range(3)) for p, q in ((a, b), (b, c), (c, a)))
            fine += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        soup = fine
    return soup


def of_grid(point, n_u, n_v):
    """Triangles of a tube: point(u, v) closed in u, v from one pole (v = 0) to the other (v = 1)."""
    rows = [[point(i / n_u, j / n_v) for i in range(n_u)] for j in range(n_v + 1)]
    soup = []
    for j in range(n_v):
        for i in range(n_u):
            a, b, c, d = rows[j][i], rows[j][(i + 1) % n_u], rows[j + 1][(i + 1) % n_u], rows[j + 1][i]
            if j > 0:
                soup.append((a, b, c))
            if j < n_v - 1:
                soup.append((a, c, d))
    return soup


def ellipsoid(a, b, c, n):
    def point(u, v):
        r = math.sin(math.pi * v) if 0 < v < 1 else 0.0
        return (-a * math.cos(math.pi * v), b * r * math.cos(2 * math.pi * u), c * r * math.sin(2 * math.pi * u))
    return outwards(of_grid(point, n, n))


def thick_wing(rng, n):
    """A straight wing of round section with a blunt end at each tip, chord 1 at the root."""
    span, taper, sweep, thick = rng.uniform(1, 4), rng.uniform(0.4, 1), rng.uniform(0, 0.8), rng.uniform(0.1, 0.2)

    def point(u, v):
        s = min(max((v - 0.1) / 0.8, 0), 1)
        grow = 0.0 if v in (0.0, 1.0) else 1.0
        chord = 1 + (taper - 1) * s
        t = 2 * math.pi * u
        x = 0.5 * (1 + math.cos(t))
        z = 0.5 * thick * math.sin(t) * (1.6 - x)
        middle = (sweep * s + 0.5 * chord, span * s, 0.0)
        return (middle[0] + grow * chord * (x - 0.5), middle[1], grow * chord * z)
    return outwards(of_grid(point, 2 * n, n + 2))


def volume(soup):
    return sum(a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]) for a, b, c in soup) / 6


def outwards(soup):
    return soup if volume(soup) > 0 else [(a, c, b) for a, b, c in soup]


def moved(soup, by):
    return [tuple((p[0] + by[0], p[1] + by[1], p[2] + by[2]) for p in t) for t in soup]


def scaled(soup, by):
    return [tuple((p[0] * by, p[1] * by, p[2] * by) for p in t) for t in soup]


def size_of(soup):
    points = [p for t in soup for p in t]
    return max(max(p[k] for p in points) - min(p[k] for p in points) for k in range(3))


# ---- Damage: each takes (rng, soup, strength), strength in 0 .. 1, and gives a soup ------------------------------------------------------------

def by_vertex(soup, change):
    """The same change at each place, however many triangles have it."""
    seen = {}
    for t in soup:
        for p in t:
            if p not in seen:
                seen[p] = change(p)
    return [tuple(seen[p] for p in t) for t in soup]


def noise(rng, soup, strength):
    edge = sum(math.dist(t[0], t[1]) for t in soup) / len(soup)
    sigma = edge * 10 ** (-5 + 4 * strength)
    return by_vertex(soup, lambda p: tuple(x + rng.gauss(0, sigma) for x in p))


def slivers(rng, soup, strength):
    """Points very near to corners, on edges of two triangles each."""
    by_edge = {}
    for i, t in enumerate(soup):
        for k in range(3):
            by_edge.setdefault(frozenset((t[k], t[(k + 1) % 3])), []).append(i)
    pairs = [(edge, owners) for edge, owners in by_edge.items() if len(owners) == 2 and len(edge) == 2]
    made, touched = list(soup), set()
    for edge, owners in sorted(rng.sample(pairs, min(len(pairs), 1 + int(10 * strength))), key=lambda pair: pair[1]):
        if touched & set(owners):
            continue
        touched |= set(owners)
        a, b = sorted(edge)
        share = 10 ** rng.uniform(-5, -2)
        q = tuple(a[k] + share * (b[k] - a[k]) for k in range(3))
        for i in owners:
            t = soup[i]
            k = next(k for k in range(3) if t[k] in edge and t[(k + 1) % 3] in edge)
            made[i] = (t[k], q, t[(k + 2) % 3])
            made.append((q, t[(k + 1) % 3], t[(k + 2) % 3]))
    return made


def gaps(rng, soup, strength):
    """Each triangle has its own corners."""
    sigma = size_of(soup) * 10 ** (-9 + 4 * strength)
    return [tuple(tuple(x + rng.uniform(-sigma, sigma) for x in p) for p in t) for t in soup]


def duplicates(rng, soup, strength):
    return soup + rng.sample(soup, min(len(soup), 1 + int(10 * strength)))


def flipped(rng, soup, strength):
    chosen = set(rng.sample(range(len(soup)), min(len(soup), 1 + int(len(soup) * 0.2 * strength))))
    return [(t[0], t[2], t[1]) if i in chosen else t for i, t in enumerate(soup)]


def holes(rng, soup, strength):
    chosen = set(rng.sample(range(len(soup)), min(len(soup) - 4, 1 + int(5 * strength))))
    return [t for i, t in enumerate(soup) if i not in chosen]


DAMAGE = {"noise": noise, "slivers": slivers, "gaps": gaps, "duplicates": duplicates, "flipped": flipped, "holes": holes}


# ---- Files -----------------------------------------------------------------------------------------------------------------------------------

def read_stl(path):
    data = path.read_bytes()
    if len(data) >= 84 and len(data) == 84 + 50 * struct.unpack_from("<I", data, 80)[0]:
        return [tuple(struct.unpack_from("<3f", data, at + 12 * k) for k in (1, 2, 3)) for at in range(84, len(data), 50)]
    points = [tuple(map(float, line.split()[1:4])) for line in data.decode(errors="replace").splitlines() if line.strip().lower().startswith("vertex")]
    return [tuple(points[i:i + 3]) for i in range(0, len(points) - 2, 3)]


def read_stl_patches(path):
    """Soups by the names of the solids of a text file."""
    soups, points = {}, []
    for line in path.read_text(errors="replace").splitlines():
        words = line.split()
        if words[:1] == ["solid"]:
            soup = soups.setdefault(" ".join(words[1:]), [])
        elif words[:1] == ["vertex"]:
            points.append(tuple(map(float, words[1:4])))
            if len(points) == 3:
                soup.append(tuple(points))
                points = []
    return soups


def read_off(path):
    words = [word for line in path.read_text().splitlines() for word in line.partition("#")[0].split()]
    words = words[1:] if words[0].upper() == "OFF" else words
    n_points, n_faces = int(words[0]), int(words[1])
    points = [tuple(map(float, words[3 + 3 * i:6 + 3 * i])) for i in range(n_points)]
    at, soup = 3 + 3 * n_points, []
    for _ in range(n_faces):
        n = int(words[at])
        corners = [points[int(word)] for word in words[at + 1:at + 1 + n]]
        soup += [(corners[0], corners[k], corners[k + 1]) for k in range(1, n - 1)]
        at += 1 + n
    return soup


def write_stl(path, patches, binary):
    if binary:
        soup = [t for _, part in patches for t in part]
        path.write_bytes(b"\0" * 80 + struct.pack("<I", len(soup)) + b"".join(struct.pack("<12fH", 0, 0, 0, *t[0], *t[1], *t[2], 0) for t in soup))
        return
    with open(path, "w", encoding="ascii") as file:
        for name, soup in patches:
            file.write(f"solid {name}\n")
            for t in soup:
                file.write("facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {p[0]!r} {p[1]!r} {p[2]!r}\n" for p in t) + "endloop\nendfacet\n")
            file.write(f"endsolid {name}\n")


def indexed(patches):
    number, faces = {}, []
    for name, soup in patches:
        for t in soup:
            faces.append((name, [number.setdefault(p, len(number)) for p in t]))
    return list(number), faces


def write_obj(path, patches):
    points, faces = indexed(patches)
    with open(path, "w", encoding="ascii") as file:
        file.writelines(f"v {p[0]!r} {p[1]!r} {p[2]!r}\n" for p in points)
        last = None
        for name, corners in faces:
            if name != last:
                file.write(f"g {name}\n")
                last = name
            file.write("f " + " ".join(str(i + 1) for i in corners) + "\n")


def write_off(path, patches):
    points, faces = indexed(patches)
    with open(path, "w", encoding="ascii") as file:
        file.write(f"OFF\n{len(points)} {len(faces)} 0\n")
        file.writelines(f"{p[0]!r} {p[1]!r} {p[2]!r}\n" for p in points)
        file.writelines("3 " + " ".join(map(str, corners)) + "\n" for _, corners in faces)


def write(path, patches, form):
    if form == "obj":
        write_obj(path, patches)
    elif form == "off":
        write_off(path, patches)
    else:
        write_stl(path, patches, form == "stl binary")


def generator(seed, *what):
    return random.Random(f"{seed}/" + "/".join(map(str, what)))
