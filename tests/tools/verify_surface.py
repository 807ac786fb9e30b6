#!/usr/bin/python3
"""Reads a surface with an independent reader and prints what it holds, as "key value" lines for a test to compare.

usage: verify_surface.py gmsh|meshio|vtk FILE

  triangles N; enclosed V (volume, positive = normals outward); area A; marker.NAME N (triangles by patch, where the reader has them).
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


def report(points, triangles, markers):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    print("triangles", len(triangles))
    print(f"enclosed {np.einsum('ij,ij->i', a, np.cross(b, c)).sum() / 6.0:.17g}")
    print(f"area {np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2.0:.17g}")
    if markers is not None:
        for marker in sorted(set(markers)):
            print(f"marker.{marker}", int(np.sum(markers == marker)))


def with_meshio(path):
    mesh = meshio.read(path)
    blocks = [i for i, block in enumerate(mesh.cells) if block.type == "triangle"]
    triangles = np.concatenate([mesh.cells[i].data for i in blocks])
    markers = None
    for name in ("marker", "su2:tag", "gmsh:physical", "nastran:ref", "patch"):
        if name in mesh.cell_data:
            markers = np.concatenate([mesh.cell_data[name][i] for i in blocks])
            break
    report(np.asarray(mesh.points, dtype=float)[:, :3], triangles, markers)


def with_vtk(path):
    readers = {".stl": vtk.vtkSTLReader, ".obj": vtk.vtkOBJReader, ".ply": vtk.vtkPLYReader, ".vtk": vtk.vtkDataSetReader, ".vtp": vtk.vtkXMLPolyDataReader,
               ".vtu": vtk.vtkXMLUnstructuredGridReader}
    reader = readers[path[path.rindex("."):]]()
    reader.SetFileName(path)
    if path.endswith(".stl"):
        reader.ScalarTagsOn()
    reader.Update()
    if reader.GetErrorCode() != 0:
        sys.exit("vtk: error " + str(reader.GetErrorCode()))
    grid = reader.GetOutput()
    cells = grid.GetCells() if path.endswith(".vtu") else grid.GetPolys()
    triangles = vtk_to_numpy(cells.GetConnectivityArray()).reshape(-1, 3)
    marker = grid.GetCellData().GetArray("STLSolidLabeling" if path.endswith(".stl") else "marker")
    report(vtk_to_numpy(grid.GetPoints().GetData()).astype(float), triangles, None if marker is None else vtk_to_numpy(marker))


def with_gmsh(path):
    points, blocks, markers = read_with_gmsh(path)
    numbers = markers["triangle"]
    report(points, blocks["triangle"], numbers if len(set(numbers)) > 1 else None)  # of one entity: the file has no patches


if __name__ == "__main__":
    {"gmsh": with_gmsh, "meshio": with_meshio, "vtk": with_vtk}[sys.argv[1]](sys.argv[2])
