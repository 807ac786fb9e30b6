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


print(json.dumps({
    "tetrahedra": int((kinds == TETRAHEDRON).sum()),
    "hexahedra": int((kinds == HEXAHEDRON).sum()),
    "tet_scaled_jacobian": worst(ours("scaled_jacobian"), ("ScaledJacobian", "ScaledJacobian"), TETRAHEDRON),
    # VTK's MinAngle does not tell an angle from what is left of 180 degrees.
    "tet_dihedral_deg": worst(np.minimum(ours("min_dihedral"), 180.0 - ours("max_dihedral")), ("MinAngle", "ScaledJacobian"), TETRAHEDRON),
    "tet_volume_relative": worst(ours("volume"), ("Volume", "Volume"), TETRAHEDRON, True),
    "hex_scaled_jacobian": worst(ours("scaled_jacobian"), ("ScaledJacobian", "ScaledJacobian"), HEXAHEDRON),
}))
