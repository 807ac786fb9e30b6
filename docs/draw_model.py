#!/usr/bin/python3
"""Draws a STEP file that a script wrote: faces coloured by name, edges of faces in black.

usage: xvfb-run -a docs/draw_model.py airliner.step docs/airliner.png [azimuth elevation]      (Debian packages: python3-vtk9, python3-gmsh, xvfb)

Triangles come from Gmsh (an independent reader of our STEP files), fine enough that facets do not show; names are those in the file. Faces of names that begin with
"tunnel", "inflow" or "outflow" are drawn transparent.
"""
import math
import sys

import gmsh
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

SIZE = (1200, 700)
COLOUR_STEP = 8             # of 256: coarse colours shrink the file and do not show
ANGLE_STEPS = 40            # triangles in a full turn
SEE_THROUGH = ("tunnel", "inflow", "outflow")
COLOURS = [(0.80, 0.82, 0.86), (0.55, 0.70, 0.88), (0.93, 0.69, 0.38), (0.60, 0.78, 0.55), (0.85, 0.55, 0.52), (0.72, 0.62, 0.82), (0.50, 0.75, 0.76), (0.88, 0.80, 0.50), (0.62, 0.62, 0.66)]


def tessellate(path):
    """[(name, points, triangles)] of every face, and polylines of every edge."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Verbosity", 1)
    gmsh.option.setString("Geometry.OCCTargetUnit", "M")
    gmsh.model.occ.importShapes(path, highestDimOnly=False)
    gmsh.model.occ.synchronize()
    box = gmsh.model.getBoundingBox(-1, -1)
    size = max(box[3] - box[0], box[4] - box[1], box[5] - box[2])
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", ANGLE_STEPS)
    gmsh.option.setNumber("Mesh.MeshSizeMax", size / 40)
    gmsh.option.setNumber("Mesh.MeshSizeMin", size / 4000)
    gmsh.option.setNumber("Mesh.Algorithm", 1)
    gmsh.model.mesh.generate(2)
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    index = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    index[tags.astype(np.int64)] = np.arange(len(tags))
    points = coordinates.reshape(-1, 3)
    faces, lines = [], []
    for _, face in gmsh.model.getEntities(2):
        name = gmsh.model.getEntityName(2, face).split("/")[-1] or "face"
        kinds, _, nodes = gmsh.model.mesh.getElements(2, face)
        for kind, corner in zip(kinds, nodes):
            if kind == 2:
                faces.append((name, index[corner.astype(np.int64)].reshape(-1, 3)))
    for _, edge in gmsh.model.getEntities(1):
        kinds, _, nodes = gmsh.model.mesh.getElements(1, edge)
        for kind, corner in zip(kinds, nodes):
            if kind == 1:
                lines.append(index[corner.astype(np.int64)].reshape(-1, 2))
    gmsh.finalize()
    return points, faces, lines


def cells_of(rows):
    cells = vtk.vtkCellArray()
    flat = np.hstack([np.full((len(rows), 1), rows.shape[1], dtype=np.int64), rows]).ravel()
    cells.SetCells(len(rows), numpy_to_vtkIdTypeArray(flat, deep=True))
    return cells


def actor(points, rows, colour, is_line, opacity=1.0):
    data = vtk.vtkPolyData()
    vtk_points = vtk.vtkPoints()
    vtk_points.SetData(numpy_to_vtk(points, deep=True))
    data.SetPoints(vtk_points)
    mapper = vtk.vtkPolyDataMapper()
    if is_line:
        data.SetLines(cells_of(rows))
        mapper.SetInputData(data)
        mapper.SetResolveCoincidentTopologyToPolygonOffset()
        mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0, -4)
    else:
        data.SetPolys(cells_of(rows))
        normals = vtk.vtkPolyDataNormals()
        normals.SetInputData(data)
        normals.SplittingOff()
        normals.ConsistencyOff()
        mapper.SetInputConnection(normals.GetOutputPort())
    result = vtk.vtkActor()
    result.SetMapper(mapper)
    look = result.GetProperty()
    look.SetColor(colour)
    look.SetOpacity(opacity)
    look.SetLineWidth(1.2)
    look.SetAmbient(0.30 if not is_line else 1.0)
    look.SetDiffuse(0.75 if not is_line else 0.0)
    return result


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    azimuth, elevation = (float(sys.argv[3]), float(sys.argv[4])) if len(sys.argv) > 4 else (35.0, 25.0)
    points, faces, lines = tessellate(sys.argv[1])
    # A mirror image has the colour of its original.
    colours, actors = {}, []
    shown = []
    for name, rows in faces:
        colour = colours.setdefault(name.removesuffix("Left"), COLOURS[len(colours) % len(COLOURS)])
        is_wall = name.startswith(SEE_THROUGH)
        actors.append(actor(points, rows, colour, False, 0.12 if is_wall else 1.0))
        shown.append(points[rows.ravel()])
    for rows in lines:
        actors.append(actor(points, rows, (0.15, 0.15, 0.18), True))
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    for item in actors:
        renderer.AddActor(item)
    everything = np.vstack(shown)
    middle = 0.5 * (everything.min(axis=0) + everything.max(axis=0))
    a, e = math.radians(azimuth), math.radians(elevation)
    # From ahead (-x) and starboard, above.
    towards = np.array([-math.cos(a) * math.cos(e), math.sin(a) * math.cos(e), math.sin(e)])
    right = np.cross([0.0, 0.0, 1.0], towards)
    right /= np.linalg.norm(right)
    up = np.cross(towards, right)
    across, high = (everything - middle) @ right, (everything - middle) @ up
    focus = middle + 0.5 * (across.max() + across.min()) * right + 0.5 * (high.max() + high.min()) * up
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(focus)
    camera.SetPosition(focus + 1000.0 * towards)
    camera.SetViewUp(0, 0, 1)
    camera.SetParallelScale(0.53 * max(high.max() - high.min(), (across.max() - across.min()) * SIZE[1] / SIZE[0]))
    renderer.ResetCameraClippingRange()
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(*SIZE)
    window.AddRenderer(renderer)
    window.Render()
    shot = vtk.vtkWindowToImageFilter()
    shot.SetInput(window)
    shot.ReadFrontBufferOff()
    shot.Update()
    image = shot.GetOutput()
    pixels = vtk_to_numpy(image.GetPointData().GetScalars())
    image.GetPointData().SetScalars(numpy_to_vtk(np.where(pixels >= 252, 255, pixels // COLOUR_STEP * COLOUR_STEP).astype(np.uint8), deep=True))
    writer = vtk.vtkPNGWriter()
    writer.SetInputData(image)
    writer.SetFileName(sys.argv[2])
    writer.SetCompressionLevel(9)
    writer.Write()
    print(", ".join(f"{name}" for name in colours))


main()
