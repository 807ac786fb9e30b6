#!/usr/bin/python3
"""Compares the quality of cells that `sterna check --cells FILE.vtu` writes with VTK's MeshQuality.

usage: vtk_quality.py FILE.vtu
Prints "compared N tetrahedra, M hexahedra" and the largest differences as JSON. Exit status 77: VTK is not installed.
"""
import json
import sys

from independent import module

np, vtk, support = module("numpy", "vtk", "vtk.util.numpy_support")

TETRAHEDRON, HEXAHEDRON = 10, 12

reader = vtk.vtkXMLUnstructuredGridReader()
reader.SetFileName(sys.argv[1])
reader.Update()
grid = reader.GetOutput()
kinds = support.vtk_to_numpy(grid.GetCellTypesArray())


def ours(name):
    return support.vtk_to_numpy(grid.GetCellData().GetArray(name))


def theirs(setting):
    quality = vtk.vtkMeshQuality()
    quality.SetInputData(grid)
    getattr(quality, "SetTetQualityMeasureTo" + setting[0])()
    getattr(quality, "SetHexQualityMeasureTo" + setting[1])()
    quality.Update()
    return support.vtk_to_numpy(quality.GetOutput().GetCellData().GetArray("Quality"))


def worst(values, setting, kind, is_relative=False):
    chosen = kinds == kind
    if not chosen.any():
        return 0.0
    a, b = values[chosen], theirs(setting)[chosen]
    return float(np.max(np.abs(a - b) / (np.abs(b) if is_relative else 1.0)))


def dihedral_angles(points):
    """Of tetrahedra (n x 4 x 3), by numpy: n x 6 degrees, edges in the order of the pairs of corners that their faces leave out: 10, 20, 21, 30, 31, 32."""
    normals = []
    for a, b, c in ((1, 3, 2), (0, 2, 3), (0, 3, 1), (0, 1, 2)):
        normal = np.cross(points[:, b] - points[:, a], points[:, c] - points[:, a])
        normals.append(normal / np.linalg.norm(normal, axis=1)[:, None])
    return np.stack([180.0 - np.degrees(np.arccos(np.clip(np.einsum("ij,ij->i", normals[a], normals[b]), -1.0, 1.0))) for a in range(4) for b in range(a)], axis=1)


def dihedral_differences():
    """Largest difference of VTK's MinAngle to numpy's angles, and of numpy's to ours."""
    chosen = np.flatnonzero(kinds == TETRAHEDRON)
    if not len(chosen):
        return 0.0, 0.0
    cells = support.vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    offsets = support.vtk_to_numpy(grid.GetCells().GetOffsetsArray())
    points = support.vtk_to_numpy(grid.GetPoints().GetData())
    angles = dihedral_angles(points[cells[offsets[chosen][:, None] + np.arange(4)]])
    # VTK 9.1 takes at two of the six edges what is left of 180 degrees: its normals there do not both point outwards.
    as_vtk = np.where([False, True, False, False, True, False], 180.0 - angles, angles).min(axis=1)
    vtk_difference = np.abs(theirs(("MinAngle", "ScaledJacobian"))[chosen] - as_vtk).max()
    ours_difference = max(np.abs(ours("min_dihedral")[chosen] - angles.min(axis=1)).max(), np.abs(ours("max_dihedral")[chosen] - angles.max(axis=1)).max())
    return float(vtk_difference), float(ours_difference)


vtk_difference, ours_difference = dihedral_differences()
print(json.dumps({
    "tetrahedra": int((kinds == TETRAHEDRON).sum()),
    "hexahedra": int((kinds == HEXAHEDRON).sum()),
    "tet_scaled_jacobian": worst(ours("scaled_jacobian"), ("ScaledJacobian", "ScaledJacobian"), TETRAHEDRON),
    "tet_dihedral_vtk_deg": vtk_difference,
    "tet_dihedral_ours_deg": ours_difference,
    "tet_volume_relative": worst(ours("volume"), ("Volume", "Volume"), TETRAHEDRON, True),
    "hex_scaled_jacobian": worst(ours("scaled_jacobian"), ("ScaledJacobian", "ScaledJacobian"), HEXAHEDRON),
}))
