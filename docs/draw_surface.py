#!/usr/bin/python3
"""Draws a surface mesh: the whole above, close-ups below, triangles coloured by their least angle.

usage: sterna surface airliner.step -o airliner.vtu && xvfb-run -a docs/draw_surface.py airliner.vtu docs/surface_mesh.png x,y,z,height,azimuth,elevation ...

Each close-up shows what is around (x, y, z), `height` metres from its lower to its upper border, seen from ahead and starboard at these angles (degrees). Triangles are
drawn as they are, without any smoothing of their colours. (Debian packages: python3-vtk9, xvfb)
"""
import sys

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

from drawing import add_view, look, look_at_all, new_window, read_mesh, towards_eye, write_picture

SIZE = (1400, 1150)         # pixels
SPLIT = 0.42                # part of the height that the close-ups take
GAP = 0.006                 # between views, of the window
LEGEND = 0.05               # of the height
CLASSES = [(10, (0.65, 0.05, 0.10)), (20, (0.88, 0.30, 0.15)), (30, (0.96, 0.62, 0.25)), (40, (0.96, 0.88, 0.55)), (50, (0.72, 0.84, 0.80)), (60.001, (0.48, 0.68, 0.86))]  # degrees: below


def least_angles(points, triangles):
    corners = points[triangles]
    least = np.full(len(triangles), 180.0)
    for k in range(3):
        a, b = corners[:, (k + 1) % 3] - corners[:, k], corners[:, (k + 2) % 3] - corners[:, k]
        cosine = np.einsum("ij,ij->i", a, b) / (np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1))
        least = np.minimum(least, np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))
    return least


def coloured(grid):
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputData(grid)
    surface.Update()
    data = surface.GetOutput()
    points = vtk_to_numpy(data.GetPoints().GetData())
    triangles = vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    kind = np.searchsorted([limit for limit, _ in CLASSES], least_angles(points, triangles), side="right")
    colours = (255 * np.array([colour for _, colour in CLASSES]))[np.minimum(kind, len(CLASSES) - 1)].astype(np.uint8)
    array = numpy_to_vtk(colours, deep=True)
    array.SetName("colour")
    data.GetCellData().SetScalars(array)
    return data, points


def actor(data, line_width):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.SetScalarModeToUseCellData()
    mapper.SetColorModeToDirectScalars()
    result = vtk.vtkActor()
    result.SetMapper(mapper)
    style = result.GetProperty()
    style.SetInterpolationToFlat()
    style.SetAmbient(0.45)
    style.SetDiffuse(0.60)
    if line_width > 0:
        style.EdgeVisibilityOn()
        style.SetEdgeColor(0.16, 0.18, 0.22)
        style.SetLineWidth(line_width)
    return result


def add_legend(renderer):
    for i, (limit, colour) in enumerate(CLASSES):
        text = vtk.vtkTextActor()
        text.SetInput(f"  {10 * i} - {min(60, int(limit))}  ")
        style = text.GetTextProperty()
        style.SetFontSize(22)
        style.SetColor(0.1, 0.1, 0.1)
        style.SetBackgroundColor(*colour)
        style.SetBackgroundOpacity(1.0)
        text.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
        text.SetPosition(0.30 + 0.085 * i, 0.25)
        renderer.AddActor2D(text)
    title = vtk.vtkTextActor()
    title.SetInput("least angle of each triangle, degrees")
    title.GetTextProperty().SetFontSize(22)
    title.GetTextProperty().SetColor(0.1, 0.1, 0.1)
    title.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    title.SetPosition(0.01, 0.25)
    renderer.AddActor2D(title)


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    data, points = coloured(read_mesh(sys.argv[1]))
    window = new_window(SIZE)
    add_view(window, (0, 0, 1, 1), [])  # white between the others
    add_legend(add_view(window, (0, 0, 1, LEGEND), []))
    top = add_view(window, (0, LEGEND + SPLIT, 1, 1), [actor(data, 0.3)])
    look_at_all(top, points, 35.0, 30.0, SIZE[0] / (SIZE[1] * (1 - SPLIT - LEGEND)))
    closeups = [[float(x) for x in text.split(",")] for text in sys.argv[3:]]
    for i, (x, y, z, height, azimuth, elevation) in enumerate(closeups):
        view = add_view(window, (i / len(closeups) + (GAP if i else 0), LEGEND, (i + 1) / len(closeups), LEGEND + SPLIT - GAP), [actor(data, 1.0)])
        focus = np.array([x, y, z])
        look(view, focus + 1000.0 * towards_eye(azimuth, elevation), focus, height)
    write_picture(window, sys.argv[2])


main()
