#!/usr/bin/python3
"""Draws docs/first_mesh.png from the mesh of scripts/01_first_mesh.lua.

usage: xvfb-run -a docs/draw_first_mesh.py first_mesh.vtu docs/first_mesh.png      (Debian packages: python3-vtk9, xvfb)

Left the aircraft and the cells that the symmetry plane cuts, right the cells that a station of the wing cuts. Cells are drawn whole, never sliced, so every
edge in the picture is an edge of the mesh.
"""
import sys

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

from drawing import add_view, look, new_window, patch_markers, read_mesh, write_picture

SIZE = (1200, 700)          # pixels
SPLIT = 0.6                 # part of the width that the left view takes
WING_STATION = -2.9         # m along y: half way out on the wing
PRISM_COLOUR = (0.98, 0.78, 0.42)
TET_COLOUR = (0.62, 0.76, 0.90)
WALL_COLOUR = (0.90, 0.90, 0.92)


def farfield_marker(grid):
    found = [marker for marker, kind, _ in patch_markers(grid) if kind == "farfield"]
    if not found:
        sys.exit("the mesh has no farfield patch")
    return found[0]


def cell_ranges(grid):
    """Lowest and highest node of every cell, two arrays (cells, 3)."""
    cells = grid.GetCells()
    starts = vtk_to_numpy(cells.GetOffsetsArray())[:-1]
    corners = vtk_to_numpy(grid.GetPoints().GetData())[vtk_to_numpy(cells.GetConnectivityArray())]
    return np.minimum.reduceat(corners, starts), np.maximum.reduceat(corners, starts)


def pick(grid, chosen):
    ids = numpy_to_vtk(np.flatnonzero(chosen), deep=True, array_type=vtk.VTK_ID_TYPE)
    node = vtk.vtkSelectionNode()
    node.SetFieldType(vtk.vtkSelectionNode.CELL)
    node.SetContentType(vtk.vtkSelectionNode.INDICES)
    node.SetSelectionList(ids)
    selection = vtk.vtkSelection()
    selection.AddNode(node)
    extract = vtk.vtkExtractSelection()
    extract.SetInputData(0, grid)
    extract.SetInputData(1, selection)
    extract.Update()
    return extract.GetOutput()


def actor(part, colour, edge_colour, line_width):
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputData(part)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(surface.GetOutputPort())
    mapper.ScalarVisibilityOff()
    result = vtk.vtkActor()
    result.SetMapper(mapper)
    look = result.GetProperty()
    look.SetColor(colour)
    look.EdgeVisibilityOn()
    look.SetEdgeColor(edge_colour)
    look.SetLineWidth(line_width)
    look.SetAmbient(0.35)
    look.SetDiffuse(0.7)
    return result


def cut(grid, low, high, is_tet, is_prism, y, box):
    """The actors of the cells that the plane y cuts inside box = (x0, x1, z0, z1)."""
    inside = (low[:, 1] <= y) & (high[:, 1] > y) & (low[:, 0] > box[0]) & (high[:, 0] < box[1]) & (low[:, 2] > box[2]) & (high[:, 2] < box[3])
    return [actor(pick(grid, inside & is_prism), PRISM_COLOUR, (0.45, 0.28, 0.05), 1),
            actor(pick(grid, inside & is_tet), TET_COLOUR, (0.20, 0.32, 0.45), 1)]


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    grid = read_mesh(sys.argv[1])
    low, high = cell_ranges(grid)
    kind = vtk_to_numpy(grid.GetCellTypesArray())
    marker = vtk_to_numpy(grid.GetCellData().GetArray("marker"))
    wall = (marker > 0) & (marker != farfield_marker(grid))
    is_tet, is_prism = kind == vtk.VTK_TETRA, kind == vtk.VTK_WEDGE

    window = new_window(SIZE)
    wall_actor = actor(pick(grid, wall), WALL_COLOUR, (0.58, 0.59, 0.61), 0.5)
    left = add_view(window, (0, 0, SPLIT, 1), [wall_actor] + cut(grid, low, high, is_tet, is_prism, 0.0, (-2, 9.5, -2, 4)))
    look(left, (-6, -18, 8), (3.6, -1, 0.45), 8.0)
    right = add_view(window, (SPLIT, 0, 1, 1), cut(grid, low, high, is_tet, is_prism, WING_STATION, (-1, 6, -2, 3)))
    look(right, (2.55, -30, 0.9), (2.55, 0, 0.9), 3.1)
    write_picture(window, sys.argv[2])


main()
