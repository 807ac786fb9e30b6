#!/usr/bin/python3
"""Reads a mesh with an independent reader and prints what it holds, as "key value" lines for a test to compare.

usage: verify_mesh.py gmsh|meshio|vtk|vtk-cgns FILE

  points N; bounds xmin xmax ymin ymax zmin zmax; cells.TYPE N and volume.TYPE V (signed, VTK's or SIDS' sense: positive = right winding);
  faces.MARKER N (boundary faces by marker number); enclosed V (volume by the divergence theorem over the boundary faces, positive = normals outward);
  layer.LAYER N (cells by layer, VTU only); field.NAME VALUE; patch.NAME MARKER (CGNS).
Exit status 77: the Python module is not installed.
"""
import sys

from independent import module, read_with_gmsh

np, = module("numpy")
if sys.argv[1] == "meshio":
    meshio, = module("meshio")
elif sys.argv[1].startswith("vtk"):
    vtk, support = module("vtk", "vtk.util.numpy_support")
    vtk_to_numpy = support.vtk_to_numpy

# SIDS faces, normals out of the cell.
FACES = {
    "tetra": [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)],
    "pyramid": [(0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
    "wedge": [(0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5), (0, 2, 1), (3, 4, 5)],
    "hexahedron": [(0, 3, 2, 1), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (0, 4, 7, 3), (4, 5, 6, 7)],
}
VTK_NAMES = {10: "tetra", 14: "pyramid", 13: "wedge", 12: "hexahedron", 5: "triangle", 9: "quad", 3: "line", 1: "vertex"}


def flux(points, faces, origin):
    """Sum of the flux of (x - origin)/3 through faces (n x 3 or n x 4 node numbers), each as a fan about its centre."""
    p = points[faces] - origin
    centre = p.mean(axis=1)
    total = np.zeros(len(faces))
    for i in range(faces.shape[1]):
        a, b = p[:, i], p[:, (i + 1) % faces.shape[1]]
        total += np.einsum("ij,ij->i", np.cross(a, b), centre) / 6.0
    return total.sum()


def cell_volume(points, kind, cells):
    origin = points[cells[:, 0]].mean(axis=0)
    return sum(flux(points, cells[:, list(face)], origin) for face in FACES[kind])


def report(points, blocks, markers, layers, fields):
    """blocks: kind -> node numbers; markers, layers: kind -> number per cell (or absent)."""
    print("points", len(points))
    print("bounds", *(f"{x:.17g}" for x in np.stack([points.min(axis=0), points.max(axis=0)]).T.ravel()))
    enclosed = 0.0
    by_marker = {}
    by_layer = {}
    for kind, cells in blocks.items():
        print(f"cells.{kind}", len(cells))
        if kind in FACES:
            print(f"volume.{kind} {cell_volume(points, kind, cells):.17g}")
        if kind in ("triangle", "quad"):
            enclosed += flux(points, cells, points.mean(axis=0))
            for number in markers.get(kind, []):
                by_marker[number] = by_marker.get(number, 0) + 1
        for number in layers.get(kind, []):
            by_layer[number] = by_layer.get(number, 0) + 1
    print(f"enclosed {enclosed:.17g}")
    for number in sorted(by_marker):
        print(f"faces.{number}", by_marker[number])
    for number in sorted(by_layer):
        print(f"layer.{number}", by_layer[number])
    for name, value in fields.items():
        print(f"field.{name} {value}")


def with_meshio(path):
    mesh = meshio.read(path)
    is_su2 = path.endswith(".su2")
    blocks, markers, layers = {}, {}, {}
    for i, block in enumerate(mesh.cells):
        cells = np.asarray(block.data)
        if block.type == "wedge" and is_su2:
            cells = cells[:, [0, 2, 1, 3, 5, 4]]  # meshio 5.0 takes SU2's wedges for SIDS, SU2 means VTK
        numbers = {name: np.asarray(values[i]).ravel() for name, values in mesh.cell_data.items()}
        marker = next((numbers[name] for name in ("su2:tag", "marker", "medit:ref", "gmsh:physical") if name in numbers), None)
        for store, value in ((blocks, cells), (markers, marker), (layers, numbers.get("layer"))):
            if value is not None:
                store[block.type] = np.concatenate([store[block.type], value]) if block.type in store else value
    report(np.asarray(mesh.points), blocks, markers, layers, {k: int(np.ravel(v)[0]) for k, v in mesh.field_data.items()})


def with_vtk(path):
    reader = vtk.vtkHDFReader() if path.endswith(".vtkhdf") else vtk.vtkXMLUnstructuredGridReader()
    errors = []
    reader.AddObserver("ErrorEvent", lambda *event: errors.append(event))
    reader.SetFileName(path)
    reader.Update()
    if errors or reader.GetErrorCode():
        sys.exit(f"VTK error code {reader.GetErrorCode()}")
    grid = reader.GetOutput()
    points = vtk_to_numpy(grid.GetPoints().GetData())
    types = vtk_to_numpy(grid.GetCellTypesArray())
    connectivity = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    offsets = vtk_to_numpy(grid.GetCells().GetOffsetsArray())
    data = grid.GetCellData()
    numbers = {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
    blocks, markers, layers = {}, {}, {}
    for number in np.unique(types):
        which = np.nonzero(types == number)[0]
        kind = VTK_NAMES[int(number)]
        n = offsets[which[0] + 1] - offsets[which[0]]
        cells = connectivity[offsets[which][:, None] + np.arange(n)]
        if kind == "wedge":
            cells = cells[:, [0, 2, 1, 3, 5, 4]]
        blocks[kind] = cells
        if "marker" in numbers:
            markers[kind] = numbers["marker"][which]
        if "layer" in numbers:
            layers[kind] = numbers["layer"][which]
        if "dimension" in numbers:
            markers[kind] = numbers["dimension"][which]
    field = grid.GetFieldData()
    report(points, blocks, markers, layers, {field.GetArrayName(i): int(field.GetArray(i).GetTuple1(0)) for i in range(field.GetNumberOfArrays())})
    # VTK's own opinion of the windings: the signed sizes of its filter.
    sizes = vtk.vtkCellSizeFilter()
    sizes.SetInputData(grid)
    sizes.Update()
    volume = vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Volume"))
    print(f"vtk.volume {volume.sum():.17g}")
    solid = np.isin(types, [10, 12, 13, 14])
    if solid.any():
        print(f"vtk.smallest {volume[solid].min():.17g}")


def blocks_of_grid(grid):
    """kind -> node numbers, in SIDS order as far as the file has them so."""
    types = vtk_to_numpy(grid.GetCellTypesArray())
    connectivity = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    offsets = vtk_to_numpy(grid.GetCells().GetOffsetsArray())
    blocks = {}
    for number in np.unique(types):
        which = np.nonzero(types == number)[0]
        n = offsets[which[0] + 1] - offsets[which[0]]
        blocks[VTK_NAMES[int(number)]] = connectivity[offsets[which][:, None] + np.arange(n)]
    return blocks


def with_vtk_cgns(path):
    reader = vtk.vtkCGNSReader()
    reader.SetFileName(path)
    reader.UpdateInformation()
    reader.EnableAllBases()
    reader.SetLoadBndPatch(1)
    reader.Update()
    zone = reader.GetOutput().GetBlock(0).GetBlock(0)
    inside, patches = zone.GetBlock(0), zone.GetBlock(1)
    points = vtk_to_numpy(inside.GetPoints().GetData())
    blocks = blocks_of_grid(inside)  # VTK does not turn CGNS's wedges: SIDS order
    markers = {}
    for i in range(patches.GetNumberOfBlocks()):
        grid = patches.GetBlock(i)
        own = vtk_to_numpy(grid.GetPoints().GetData())
        if not np.array_equal(own, points):
            sys.exit("a patch has points of its own")
        for kind, cells in blocks_of_grid(grid).items():
            blocks[kind] = np.concatenate([blocks[kind], cells]) if kind in blocks else cells
            markers[kind] = np.concatenate([markers.get(kind, np.zeros(0, int)), np.full(len(cells), i + 1)])
        print(f"patch.{patches.GetMetaData(i).Get(vtk.vtkCompositeDataSet.NAME())} {i + 1}")
    report(points, blocks, markers, {}, {})


def with_gmsh(path):
    points, blocks, markers = read_with_gmsh(path)
    report(points, blocks, markers, {}, {})


{"gmsh": with_gmsh, "meshio": with_meshio, "vtk": with_vtk, "vtk-cgns": with_vtk_cgns}[sys.argv[1]](sys.argv[2])
