"""Damages volume meshes deliberately in one measure at a time, for `tools/verify_gates`.

The module reads a mesh from a UGRID file (.lb8.ugrid), moves some of its nodes, and writes the mesh again. All cells stay valid: a move after which a cell around
the node has a corner without a positive Jacobian is reverted, and another location is damaged. Nodes on boundaries are not moved."""
import array
import math
import pathlib
from typing import Callable

PRISM_CORNERS = [(0, 1, 2, 3), (1, 2, 0, 4), (2, 0, 1, 5), (3, 5, 4, 0), (4, 3, 5, 1), (5, 4, 3, 2)]  # a corner and the ends of its three edges
KEPT = 1e-7          # share of the smallest Jacobian of a cell that must remain after a damage, except for the cell that is damaged
EDGE_SHARE = 0.3     # relative to the edges of the wall: largest sideways displacement of a growth line, which keeps neighbouring lines apart
RIM = 0.08           # relative to the span: growth lines closer to the plane of symmetry are not damaged

Vector = tuple[float, float, float]


def plus(a: Vector, b: Vector, s: float = 1.0) -> Vector:
    return a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]


def minus(a: Vector, b: Vector) -> Vector:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def length(a: Vector) -> float:
    return math.sqrt(dot(a, a))


def unit(a: Vector) -> Vector:
    size = length(a)
    return a[0] / size, a[1] / size, a[2] / size


class Grid:
    """A mesh of prisms and tetrahedra with its growth lines (nodes from the wall to the envelope), which are found by following the prisms."""

    def __init__(self, path: pathlib.Path):
        data = path.read_bytes()
        self.counts = array.array("i", data[:28])
        n_nodes, n_triangles, n_quads, n_tets, n_pyramids, n_prisms, n_hexahedra = self.counts
        if n_pyramids or n_hexahedra:
            raise ValueError(f"{path} has pyramids or hexahedra, which are not damaged")
        begin = 28 + 24 * n_nodes
        values = array.array("d", data[28:begin])
        self.rest = data[begin:]
        numbers = array.array("i", self.rest)
        self.points: list[Vector] = [tuple(values[3 * i:3 * i + 3]) for i in range(n_nodes)]
        at = 3 * n_triangles + 4 * n_quads
        self.triangles = [tuple(n - 1 for n in numbers[3 * i:3 * i + 3]) for i in range(n_triangles)]
        self.fixed = {n - 1 for n in numbers[:at]}
        at += n_triangles + n_quads
        self.tets = [tuple(n - 1 for n in numbers[at + 4 * i:at + 4 * i + 4]) for i in range(n_tets)]
        at += 4 * n_tets
        self.prisms = [tuple(n - 1 for n in numbers[at + 6 * i:at + 6 * i + 6]) for i in range(n_prisms)]
        self.find_cells()
        self.find_lines()

    def find_cells(self) -> None:
        self.cells: list[list[tuple[int, ...]]] = [[] for _ in self.points]
        for cell in self.tets + self.prisms:
            for node in cell:
                self.cells[node].append(cell)
        self.sign = {True: math.copysign(1.0, self.tet_volume(self.tets[0])) if self.tets else 1.0,
                     False: math.copysign(1.0, min(self.prism_jacobians(self.prisms[0]), key=abs)) if self.prisms else 1.0}

    def find_lines(self) -> None:
        above, below = {}, set()
        self.neighbours: dict[int, set[int]] = {}
        for a, b, c, d, e, f in self.prisms:
            for low, high in ((a, d), (b, e), (c, f)):
                above[low] = high
                below.add(high)
        starts = set(above) - below
        for a, b, c, *_ in self.prisms:
            if a in starts and b in starts and c in starts:
                for p, q, r in ((a, b, c), (b, c, a), (c, a, b)):
                    self.neighbours.setdefault(p, set()).update((q, r))
        self.normals: dict[int, Vector] = {}
        for a, b, c, *_ in self.prisms:
            if a in starts and b in starts and c in starts:
                normal = cross(minus(self.points[b], self.points[a]), minus(self.points[c], self.points[a]))
                for n in (a, b, c):
                    self.normals[n] = plus(self.normals.get(n, (0.0, 0.0, 0.0)), normal)
        span = max(self.points[n][1] for n in starts) - min(self.points[n][1] for n in starts) if starts else 0.0
        floor = min((self.points[n][1] for n in starts), default=0.0) + RIM * span
        self.lines: dict[int, list[int]] = {}
        for start in sorted(starts, key=lambda n: self.points[n]):
            line = [start]
            while line[-1] in above:
                line.append(above[line[-1]])
            if len(line) > 2 and self.points[start][1] > floor and not any(n in self.fixed for n in line[1:]):
                self.lines[start] = line
        deepest = max(map(len, self.lines.values()), default=0)
        self.lines = {start: line for start, line in self.lines.items() if len(line) == deepest}

    def tet_volume(self, cell: tuple[int, ...]) -> float:
        a, b, c, d = (self.points[n] for n in cell)
        return dot(cross(minus(b, a), minus(c, a)), minus(d, a))

    def prism_jacobians(self, cell: tuple[int, ...]) -> list[float]:
        p = [self.points[n] for n in cell]
        return [dot(cross(minus(p[b], p[a]), minus(p[c], p[a])), minus(p[d], p[a])) for a, b, c, d in PRISM_CORNERS]

    def size_of(self, cell: tuple[int, ...]) -> float:
        """Returns the smallest Jacobian of a cell, positive for a valid cell."""
        if len(cell) == 4:
            return self.sign[True] * self.tet_volume(cell)
        return min(self.sign[False] * value for value in self.prism_jacobians(cell))

    def move(self, moves: dict[int, Vector], kept: float = KEPT) -> bool:
        """Moves all given nodes, or no node if a cell would keep less than the share `kept` of its smallest Jacobian."""
        touched = {cell for node in moves for cell in self.cells[node]}
        before = {cell: self.size_of(cell) for cell in touched}
        old = {node: self.points[node] for node in moves}
        for node, point in moves.items():
            self.points[node] = point
        if all(self.size_of(cell) > kept * before[cell] for cell in touched):
            return True
        for node, point in old.items():
            self.points[node] = point
        return False

    def write(self, path: pathlib.Path) -> None:
        with open(path, "wb") as out:
            out.write(self.counts.tobytes())
            array.array("d", [x for point in self.points for x in point]).tofile(out)
            out.write(self.rest)

    def spread(self, items: list, count: int) -> list:
        """Returns all items in an order whose first `count` items are spread evenly; the others follow as a reserve."""
        count = max(1, min(count, len(items)))
        chosen = [int((i + 0.5) * len(items) / count) for i in range(count)]
        taken = set(chosen)
        return [items[i] for i in chosen] + [items[i] for i in range(len(items)) if i not in taken]

    def wall_edge(self, start: int) -> float:
        return min((length(minus(self.points[n], self.points[start])) for n in self.neighbours.get(start, ())), default=0.0)

    def patch_around(self, start: int) -> list[int] | None:
        """Returns the start of a growth line and the starts around it, or None if one of them has no complete line."""
        ring = [start, *sorted(self.neighbours[start])]
        return ring if all(n in self.lines for n in ring) else None


def lean(grid: Grid, count: int, degrees: float, deepest: int = 12) -> int:
    """Tilts the growth lines of a vertex and its neighbours by an angle in their first cells. Further out the displacement remains, and fades towards the envelope."""
    done, used = 0, set()
    for start in grid.spread(list(grid.lines), count):
        if done == count:
            break
        ring = grid.patch_around(start)
        if not ring or used & set(ring):
            continue
        first = max(length(minus(grid.points[grid.lines[n][1]], grid.points[n])) for n in ring)
        if math.tan(math.radians(degrees)) * first > EDGE_SHARE * min(grid.wall_edge(n) for n in ring):  # the first cells must have room for the tilt
            continue
        normal = unit(grid.normals[start])
        along = cross(normal, (1.0, 0.0, 0.0) if abs(normal[0]) < 0.7 else (0.0, 1.0, 0.0))
        along = unit(along)
        most = EDGE_SHARE * min(grid.wall_edge(n) for n in ring)
        moves = {}
        for n in ring:
            line = grid.lines[n]
            foot, top, shift = grid.points[n], len(line) - 1, 0.0
            for k, node in enumerate(line[1:top], start=1):
                height = length(minus(grid.points[node], foot))
                wanted = math.tan(math.radians(degrees)) * height
                if k <= deepest and wanted <= most:
                    shift = wanted
                moves[node] = plus(grid.points[node], along, shift * (1.0 if k < top // 2 else (top - k) / (top - top // 2)))
        if grid.move(moves):
            done += 1
            used |= set(ring)
    return done


def layer_jump(grid: Grid, count: int, ratio: float, at: float = 0.5) -> int:
    """Makes one cell of each growth line so thin that the next cell is `ratio` times as high (at: share of the layers below the cell)."""
    done = 0
    for start in grid.spread(list(grid.lines), count):
        if done == count:
            break
        line = grid.lines[start]
        k = max(1, min(len(line) - 2, int(at * (len(line) - 1))))
        low, high = grid.points[line[k - 1]], grid.points[line[k + 1]]
        done += grid.move({line[k]: plus(low, minus(high, low), 1.0 / (1.0 + ratio))})
    return done


def compress(grid: Grid, count: int, factor: float) -> int:
    """Reduces the height of complete growth lines by a factor; the tetrahedra above them follow."""
    done = 0
    for start in grid.spread(list(grid.lines), count):
        if done == count:
            break
        line = grid.lines[start]
        foot = grid.points[start]
        done += grid.move({node: plus(foot, minus(grid.points[node], foot), factor) for node in line[1:]})
    return done


def last_layer(grid: Grid, count: int, factor: float) -> int:
    """Multiplies the height of the last cell of growth lines by a factor: the envelope moves, and the tetrahedra above it change by the opposite amount."""
    done = 0
    for start in grid.spread(list(grid.lines), count):
        if done == count:
            break
        line = grid.lines[start]
        low, high = grid.points[line[-2]], grid.points[line[-1]]
        done += grid.move({line[-1]: plus(low, minus(high, low), factor)})
    return done


def inner_tets(grid: Grid) -> list[tuple[int, ...]]:
    """Returns the tetrahedra with a node that is neither on a boundary nor on a prism, sorted by the distance from the walls."""
    in_prisms = {n for cell in grid.prisms for n in cell}
    free = [cell for cell in grid.tets if any(n not in grid.fixed and n not in in_prisms for n in cell)]
    walls = [grid.points[n] for n in list(grid.lines)[::20]] or [grid.points[n] for n in list(grid.fixed)[::20]]

    def near(cell: tuple[int, ...]) -> float:
        p = grid.points[cell[0]]
        return min(length(minus(p, wall)) for wall in walls)
    free.sort(key=near)
    grid.free_nodes = {n for cell in free for n in cell if n not in grid.fixed and n not in in_prisms}
    return free


def move_free_nodes(grid: Grid, count: int, share: float, reach: float, target: Callable[[int, tuple[int, ...]], tuple[float, ...]]) -> int:
    """Moves one free node of each of `count` tetrahedra to target(node, cell). The tetrahedra are spread over those nearest to the walls (a share `reach` of all). A node is
    moved only if the cells around it stay positive, and if no node of these cells has been moved. Returns the number of moved nodes."""
    done, used = 0, set()
    tets = inner_tets(grid)
    for cell in grid.spread(tets[:max(20 * count, int(reach * len(tets)))], count):
        if done == count:
            break
        for node in cell:
            if node not in grid.free_nodes or any(n in used for other in grid.cells[node] for n in other):
                continue
            if grid.move({node: target(node, cell)}, min(KEPT, 0.1 * share)):
                done += 1
                used.add(node)
                break
    return done


def flatten(grid: Grid, count: int, share: float, reach: float = 0.1) -> int:
    """Reduces the height of tetrahedra to a share: a free node moves towards the opposite face."""
    def target(node: int, cell: tuple[int, ...]) -> tuple[float, ...]:
        a, b, c = (grid.points[n] for n in cell if n != node)
        normal = unit(cross(minus(b, a), minus(c, a)))
        height = dot(minus(grid.points[node], a), normal)
        return plus(grid.points[node], normal, -(1.0 - share) * height)
    return move_free_nodes(grid, count, share, reach, target)


def shorten(grid: Grid, count: int, share: float, reach: float = 0.1) -> int:
    """Shortens an edge between a free node and a neighbour by a factor. The tetrahedra on the edge lose volume, and the opposite tetrahedra gain volume."""
    def target(node: int, cell: tuple[int, ...]) -> tuple[float, ...]:
        end = grid.points[next(n for n in cell if n != node)]
        return plus(end, minus(grid.points[node], end), share)
    return move_free_nodes(grid, count, share, reach, target)


KINDS = {"lean": lean, "layer_jump": layer_jump, "compress": compress, "last_layer": last_layer, "flatten": flatten, "shorten": shorten}


def count_of(grid: Grid, kind: str, amount: float) -> int:
    """Returns the number of growth lines or tetrahedra: an amount up to 1 is a share, a larger amount is a number."""
    if amount > 1.0:
        return int(amount)
    if kind == "lean":  # one location is a vertex with its neighbours, about seven growth lines
        return max(1, int(amount * len(grid.lines) / 7))
    return max(1, int(amount * (len(grid.tets) if kind in ("flatten", "shorten") else len(grid.lines))))


def damage(source: pathlib.Path, target: pathlib.Path, kind: str, amount: float, **strength: float) -> tuple[int, int]:
    """Writes the damaged mesh; returns the number of damaged locations, and the target number."""
    grid = Grid(source)
    count = count_of(grid, kind, amount)
    done = KINDS[kind](grid, count, **strength)
    if not done:
        raise ValueError(f"no location of {source} takes the damage {kind} {strength}")
    grid.write(target)
    conditions = source.with_suffix("").with_suffix(".mapbc")
    target.with_suffix("").with_suffix(".mapbc").write_text(conditions.read_text())
    return done, count
