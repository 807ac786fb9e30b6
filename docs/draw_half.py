#!/usr/bin/python3
"""Draws a half model: its symmetry plane with the layer's footprint and the wall, the whole above, close-ups below.

usage: sterna mesh aircraft.stl --half ... -o half.vtu && xvfb-run -a docs/draw_half.py half.vtu docs/half_model.png x,z,height ...

Each view looks along y at the plane about (x, z), `height` metres high: quadrilaterals of the layer's sides orange, triangles of the plane blue, the wall grey behind.
(Debian packages: python3-vtk9, xvfb)
"""
import sys

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

from drawing import add_view, look, new_window, patch_markers, read_mesh, write_picture

SIZE = (1500, 1000)
GAP = 0.006
COLOURS = {"wall": (0.75, 0.75, 0.75), "triangle": (0.62, 0.76, 0.90), "quad": (0.97, 0.68, 0.33)}


def faces_of(grid, wanted, kind_of_cell):
    """An actor of the boundary faces of patches with these markers, of one VTK cell type."""
    markers = vtk_to_numpy(grid.GetCellData().GetArray("marker"))
    types = vtk_to_numpy(grid.GetCellTypesArray())
    ids = np.flatnonzero(np.isin(markers, wanted) & (types == kind_of_cell))
    if len(ids) == 0:
        return None
    extract = vtk.vtkExtractCells()
    extract.SetInputData(grid)
    cells = vtk.vtkIdList()
    for i in ids:
        cells.InsertNextId(int(i))
    extract.SetCellList(cells)
    surface = vtk.vtkGeometryFilter()
    surface.SetInputConnection(extract.GetOutputPort())
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(surface.GetOutputPort())
    mapper.ScalarVisibilityOff()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    return actor


def main():
    grid = read_mesh(sys.argv[1])
    views = [tuple(float(v) for v in text.split(",")) for text in sys.argv[3:]]
    patches = patch_markers(grid)
    plane = [marker for marker, kind, _ in patches if kind == "symmetry"]
    wall = [marker for marker, kind, _ in patches if kind == "wall"]
    actors = []
    for wanted, cell, colour in ((wall, vtk.VTK_TRIANGLE, "wall"), (plane, vtk.VTK_TRIANGLE, "triangle"), (plane, vtk.VTK_QUAD, "quad")):
        actor = faces_of(grid, wanted, cell)
        if actor is None:
            sys.exit(f"{sys.argv[1]}: no faces to draw as {colour}")
        actor.GetProperty().SetColor(COLOURS[colour])
        actor.GetProperty().LightingOff()
        actor.GetProperty().EdgeVisibilityOn()
        actor.GetProperty().SetEdgeColor(0.15, 0.15, 0.2)
        actor.GetProperty().SetLineWidth(0.6)
        actors.append(actor)
    window = new_window(SIZE)
    below = len(views) - 1
    for i, (x, z, height) in enumerate(views):
        port = (0, 0.5 + GAP, 1, 1) if i == 0 else ((i - 1) / below + GAP / 2, 0, i / below - GAP / 2, 0.5)
        renderer = add_view(window, port, actors)
        look(renderer, (x, -1000.0, z), (x, 0.0, z), height)
    write_picture(window, sys.argv[2])


main()
