#!/usr/bin/python3
"""Draws the triangles of a surface mesh seen along a direction, stretched ones in blue.

usage: build/release/sterna surface wing.xml --leading-edge-chordwise 0.002 ... -o wing.vtu && xvfb-run -a docs/draw_bands.py wing.vtu docs/wing_bands.png 2.35,3.6,0 0.25,0.5,0.8 0.6
(file, picture, point looked at, direction to the eye, half the height of the picture in metres; Debian packages: python3-vtk9, xvfb)
"""
import sys

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

from drawing import add_view, look, new_window, read_mesh, write_picture

SIZE = (1000, 600)
STRETCHED = 2.6  # longest edge by height: 2 for half a square, 1.15 where equilateral
COLOURS = ((0.84, 0.85, 0.88), (0.58, 0.75, 0.92))


def triangles_of(grid):
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputData(grid)
    surface.Update()
    return surface.GetOutput()


def mark_stretched(data):
    points = vtk_to_numpy(data.GetPoints().GetData())
    triangles = vtk_to_numpy(data.GetPolys().GetData()).reshape(-1, 4)[:, 1:]
    a, b, c = (points[triangles[:, k]] for k in range(3))
    longest = np.max([np.linalg.norm(p - q, axis=1) for p, q in ((a, b), (b, c), (c, a))], axis=0)
    stretch = longest**2 / np.maximum(np.linalg.norm(np.cross(b - a, c - a), axis=1), 1e-300)
    data.GetCellData().SetScalars(numpy_to_vtk((stretch > STRETCHED).astype(np.int32), deep=True))


def actor_of(data):
    table = vtk.vtkLookupTable()
    table.SetNumberOfTableValues(2)
    for k, colour in enumerate(COLOURS):
        table.SetTableValue(k, *colour, 1.0)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.SetLookupTable(table)
    mapper.SetScalarRange(0, 1)
    mapper.SetScalarModeToUseCellData()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().EdgeVisibilityOn()
    actor.GetProperty().SetEdgeColor(0.15, 0.15, 0.15)
    actor.GetProperty().SetAmbient(0.4)
    actor.GetProperty().SetDiffuse(0.65)
    return actor


def main():
    source, picture = sys.argv[1:3]
    focus, direction = (np.array([float(x) for x in text.split(",")]) for text in sys.argv[3:5])
    data = triangles_of(read_mesh(source))
    mark_stretched(data)
    window = new_window(SIZE)
    view = add_view(window, (0.0, 0.0, 1.0, 1.0), [actor_of(data)])
    look(view, focus + 10 * direction, focus, 2.0 * float(sys.argv[5]))
    write_picture(window, picture)


main()
