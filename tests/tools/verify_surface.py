#!/usr/bin/python3
"""Reads a surface with an independent reader and prints what it holds, as "key value" lines for a test to compare.

usage: verify_surface.py meshio|vtk FILE

  triangles N; enclosed V (volume, positive = normals outward); area A; marker.NAME N (triangles by patch, where the reader has them).
Exit status 77: the Python module is not installed.
"""
import sys
import warnings

try:
    import numpy as np
    if sys.argv[1] == "meshio":
        import meshio
    else:
        import vtk
        from vtk.util.numpy_support import vtk_to_numpy
except ImportError as failure:
    print(failure)
    sys.exit(77)

warnings.filterwarnings("ignore")


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


if __name__ == "__main__":
    with_meshio(sys.argv[2]) if sys.argv[1] == "meshio" else with_vtk(sys.argv[2])
