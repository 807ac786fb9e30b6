#!/usr/bin/python3
"""Draws the surface mesh of a model that a script wrote: coloured by patch, edges between patches and sharp edges in black.

usage: build/release/tests/surface_models -out . airliner.step && xvfb-run -a docs/draw_model.py airliner.vtu docs/airliner.png [azimuth elevation]
(Debian packages: python3-vtk9, xvfb)

Patches that begin with "tunnel", "inflow" or "outflow" are drawn transparent; a mirror image ("...Left") has the colour of its original.
"""
import math
import sys

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

SIZE = (1200, 700)
COLOUR_STEP = 8             # of 256: coarse colours shrink the file and do not show
SHARP = 25.0                # degrees: edges of the surface itself
SEE_THROUGH = ("tunnel", "inflow", "outflow")
COLOURS = [(0.80, 0.82, 0.86), (0.55, 0.70, 0.88), (0.93, 0.69, 0.38), (0.60, 0.78, 0.55), (0.85, 0.55, 0.52), (0.72, 0.62, 0.82), (0.50, 0.75, 0.76), (0.88, 0.80, 0.50), (0.62, 0.62, 0.66)]


def read_patches(path):
    """The triangles of each patch: [(name, vtkPolyData)]."""
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    names = {}
    fields = grid.GetFieldData()
    for i in range(fields.GetNumberOfArrays()):
        parts = fields.GetArrayName(i).split(":")
        if parts[0] == "patch":
            names[int(fields.GetArray(i).GetTuple1(0))] = parts[-1]
    if not names:
        sys.exit(f"{path}: no patches")
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputData(grid)
    surface.Update()
    patches = []
    for number, name in sorted(names.items()):
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


main()
