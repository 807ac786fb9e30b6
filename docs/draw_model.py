#!/usr/bin/python3
"""Draws the surface mesh of a model that a script wrote: coloured by patch, edges between patches and sharp edges in black.

usage: build/release/tests/surface_models -out . airliner.step && xvfb-run -a docs/draw_model.py airliner.vtu docs/airliner.png [azimuth elevation]
(Debian packages: python3-vtk9, xvfb)

Patches that begin with "tunnel", "inflow" or "outflow" are drawn transparent; a mirror image ("...Left") has the colour of its original.
"""
import sys

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

from drawing import add_view, look_at_all, new_window, patch_markers, read_mesh, write_picture

SIZE = (1200, 700)
SHARP = 25.0                # degrees: edges of the surface itself
SEE_THROUGH = ("tunnel", "inflow", "outflow")
COLOURS = [(0.80, 0.82, 0.86), (0.55, 0.70, 0.88), (0.93, 0.69, 0.38), (0.60, 0.78, 0.55), (0.85, 0.55, 0.52), (0.72, 0.62, 0.82), (0.50, 0.75, 0.76), (0.88, 0.80, 0.50), (0.62, 0.62, 0.66)]


def read_patches(path):
    """The triangles of each patch: [(name, vtkPolyData)]."""
    grid = read_mesh(path)
    names = patch_markers(grid)
    if not names:
        sys.exit(f"{path}: no patches")
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputData(grid)
    surface.Update()
    patches = []
    for number, _, name in names:
        pick = vtk.vtkThreshold()
        pick.SetInputData(surface.GetOutput())
        pick.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_CELLS, "marker")
        pick.SetThresholdFunction(vtk.vtkThreshold.THRESHOLD_BETWEEN)
        pick.SetLowerThreshold(number)
        pick.SetUpperThreshold(number)
        part = vtk.vtkDataSetSurfaceFilter()
        part.SetInputConnection(pick.GetOutputPort())
        part.Update()
        if part.GetOutput().GetNumberOfCells():
            patches.append((name, part.GetOutput()))
    return patches


def face_actor(data, colour, opacity):
    normals = vtk.vtkPolyDataNormals()
    normals.SetInputData(data)
    normals.SetFeatureAngle(SHARP)
    normals.ConsistencyOff()
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(normals.GetOutputPort())
    mapper.ScalarVisibilityOff()
    result = vtk.vtkActor()
    result.SetMapper(mapper)
    look = result.GetProperty()
    look.SetColor(colour)
    look.SetOpacity(opacity)
    look.SetAmbient(0.30)
    look.SetDiffuse(0.75)
    return result


def edge_actor(data):
    edges = vtk.vtkFeatureEdges()
    edges.SetInputData(data)
    edges.SetFeatureAngle(SHARP)
    edges.ManifoldEdgesOff()
    edges.NonManifoldEdgesOff()
    edges.ColoringOff()
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(edges.GetOutputPort())
    mapper.ScalarVisibilityOff()
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0, -4)
    result = vtk.vtkActor()
    result.SetMapper(mapper)
    result.GetProperty().SetColor(0.15, 0.15, 0.18)
    result.GetProperty().SetLineWidth(1.2)
    result.GetProperty().LightingOff()
    return result


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    azimuth, elevation = (float(sys.argv[3]), float(sys.argv[4])) if len(sys.argv) > 4 else (35.0, 25.0)
    colours, actors, shown = {}, [], []
    for name, data in read_patches(sys.argv[1]):
        colour = colours.setdefault(name.removesuffix("Left"), COLOURS[len(colours) % len(COLOURS)])
        is_wall = name.startswith(SEE_THROUGH)
        actors += [face_actor(data, colour, 0.12 if is_wall else 1.0), edge_actor(data)]
        shown.append(vtk_to_numpy(data.GetPoints().GetData()))
    window = new_window(SIZE)
    look_at_all(add_view(window, (0, 0, 1, 1), actors), np.vstack(shown), azimuth, elevation, SIZE[0] / SIZE[1])
    write_picture(window, sys.argv[2])


main()
